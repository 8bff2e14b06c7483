"""Figures of the plane and its operators: the points, states and curves of the definition."""

import re

import numpy as np
import pytest
from common import lines

import pyhysteron

plt = pytest.importorskip("matplotlib.pyplot")
from pyhysteron import plot  # noqa: E402

pytestmark = pytest.mark.usefixtures("drawn")


def test_excitation(model, recording):
    ax = plot.excitation(model, recording)
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert sum(int(label.split("(")[1][:-1]) for label in labels) == 78


def test_grid(model):
    ax = plot.grid(model)
    points = {tuple(point) for point in ax.get_lines()[0].get_xydata()}
    levels = model.plane
    assert points == {(levels[i], levels[j]) for j in range(12) for i in range(j + 1)}
    low, high = model.range
    named = {text.get_text().split("\n")[0]: tick for tick, text in zip(ax.get_xticks(), ax.get_xticklabels())}
    assert named["$\\alpha_{1}$"] == low and named["$\\alpha_{12}$"] == high
    for name, tick in named.items():
        k = int(name[len("$\\alpha_{") : -len("}$")])
        assert tick == pytest.approx(low + (k - 1) * (high - low) / 11)  # equation (3)
    assert any(text.get_text().startswith("$K$ = 12\n$N$ = 78\n$\\Delta T$ = ") for text in ax.texts)


@pytest.mark.parametrize("levels", [2, 3, 60])
def test_grid_points_at_an_operator_by_its_name(levels):
    model = pyhysteron.Model(np.zeros(levels * (levels + 1) // 2), (0, 1))
    note = plot.grid(model).texts[0]
    i, j = map(int, re.match(r"\$s_{(\d+),(\d+)}", note.get_text()).groups())
    assert note.xy == (model.plane[i - 1], model.plane[j - 1])


def test_operators_are_those_of_the_definition():
    relay, kp, mkp = plot.operators()
    for ax, low in ((kp, -1), (mkp, 0)):
        for text, foot in (("rising", 2), ("falling", 0)):  # β_{j-1} and α_{i-1} with ΔT = 1: equation (4)
            input, output = lines(ax)[text].get_data()
            np.testing.assert_allclose(output, low + (1 - low) * np.clip(input - foot, 0, 1), atol=1e-9)
        input, output = lines(ax)["turned back"].get_data()
        assert (input[0], input[-1]) == (2.5, 0.5), "from one bounding curve to the other"
        np.testing.assert_allclose(output, (low + 1) / 2, atol=1e-9)
    for text, jump in (("rising", 3), ("falling", 1)):  # β_j and α_i
        input, output = lines(relay)[text].get_data()
        far = abs(input - jump) > 0.02
        np.testing.assert_array_equal(output[far], np.where(input > jump, 1, -1)[far])
    assert list(lines(relay)) == ["rising", "falling"]


def test_arrows_at_an_operator_show_where_it_goes():
    for ax in plot.operators():
        rising, falling = ax.texts
        assert rising.xy[1] > rising.xyann[1] and rising.xy[0] > 2
        assert falling.xy[1] < falling.xyann[1] and falling.xy[0] < 1.01


def test_structure(model):
    texts = [text.get_text() for text in plot.structure(model).texts]
    for i, j in ((1, 1), (1, 2), (12, 12)):
        assert f"$\\gamma_{{{i},{j}}}$" in texts
        assert f"$\\mu_{{{i},{j}}}$ = {model.weights[i - 1, j - 1]:.3g}" in texts
    assert {"temperature [°C]", "lift [mm]", "Σ", "⋮", f"= {model.offset:.3g} + Σ"} <= set(texts)
    small = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1), sign=-1, offset=5)
    texts = [text.get_text() for text in plot.structure(small).texts]
    assert "⋮" not in texts and "= 5 − Σ" in texts


def by_definition(model, history, on):
    """The states by equation (5), one operator and sample after the other, shape (K, K)."""
    gamma = np.full((model.levels, model.levels), np.nan)
    step = model.plane[1] - model.plane[0]
    for i, j in zip(*np.triu_indices(model.levels)):
        alpha, beta, state = model.plane[i], model.plane[j], float(on)
        for input in history:
            if model.operator == "relay":
                state = 1 if input >= beta else 0 if input <= alpha else state
            else:
                left, right = (np.clip((input - level) / step + 1, 0, 1) for level in (alpha, beta))
                state = max(right, min(state, left))
        gamma[i, j] = state
    return gamma


@pytest.mark.parametrize("operator", ["mkp", "kp", "relay"])
@pytest.mark.parametrize("start", ["off", "on"])
def test_states_are_those_of_the_definition(operator, start):
    random = np.random.default_rng(5)
    model = pyhysteron.Model(random.uniform(size=21), (20, 80), operator=operator)
    input = random.uniform(0, 100, 40)
    at = [0, 3, 17, -1]
    for ax, sample in zip(plot.plane(model, input, at=at, start=start), at):
        gamma = by_definition(model, input[: sample % 40 + 1], start == "on")
        for text, chosen in (("γ = 0", gamma == 0), ("0 < γ < 1", (0 < gamma) & (gamma < 1)), ("γ = 1", gamma == 1)):
            drawn = {tuple(point) for point in lines(ax)[text].get_xydata()}
            assert drawn == {(model.plane[i], model.plane[j]) for i, j in np.argwhere(chosen)}


def test_an_input_on_a_level_leaves_no_operator_between():
    model = pyhysteron.Model(np.ones(210), (20, 80))
    for ax in plot.plane(model, np.append(90.0, model.plane[[15, 3]]), at=[1, 2]):
        assert not len(lines(ax)["0 < γ < 1"].get_xdata())


def test_plane(truth, swings):
    axes = plot.plane(truth, swings)
    assert len(axes) == 6
    first = lines(axes[0])
    marks = [first[label] for label in ("γ = 0", "0 < γ < 1", "γ = 1")]
    assert sum(len(line.get_xdata()) for line in marks) == 78
    assert "°C at sample" in axes[0].get_title()
    assert len(plot.plane(truth, swings, at=[10, -1])) == 2
    given = plt.subplots(1, 3)[1]
    assert list(plot.plane(truth, swings, at=np.array([10, 20]), axes=given)) == list(given[:2])
    assert given[1].get_ylabel() == "β [°C]" and not given[2].lines


def test_the_present_input_crosses_the_plane_where_it_goes(truth):
    rising, falling = plot.plane(truth, [30.0, 70.0, 40.0], at=[1, 2])
    assert set(lines(rising)["present input"].get_ydata()) == {70.0}
    assert set(lines(falling)["present input"].get_xdata()) == {40.0}


def test_the_plane_of_a_model_that_depends_on_a_load(truth, swings):
    load = np.repeat([1.0, 2.0, 3.0], len(swings) // 3)
    model = pyhysteron.fit(swings, load * truth.simulate(swings), load=load, levels=8, bootstrap=0)
    axes = plot.plane(model, swings, at=[400])
    middle = model.at_load(2.0)
    steady = middle.start()
    steady.run(swings[:401])
    on = {tuple(point) for line in axes[0].get_lines() if line.get_label() == "γ = 1" for point in line.get_xydata()}
    i, j = np.nonzero(steady.operators == 1)
    assert on == set(zip(middle.plane[i], middle.plane[j]))

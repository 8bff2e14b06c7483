"""The figures hold what they say: the right curves, labels with units, and the states of the definition."""

import doctest
import re
import subprocess
import sys

import numpy as np
import pytest

import hysteron

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")
plt = pytest.importorskip("matplotlib.pyplot")
plot = pytest.importorskip("hysteron.plot")
Axes3D = pytest.importorskip("mpl_toolkits.mplot3d").Axes3D


@pytest.fixture(autouse=True)
def closed():
    """Draws what the test has made, and closes it."""
    yield
    for number in plt.get_fignums():
        plt.figure(number).canvas.draw()
    plt.close("all")


@pytest.fixture(scope="module")
def model(recording):
    return hysteron.fit(recording, levels=12, bootstrap=30)


def lines(ax):
    return {line.get_label(): line for line in ax.get_lines()}


def test_loops(recording, model):
    ax = plot.loops(recording, model)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("temperature [°C]", "lift [mm]")
    np.testing.assert_array_equal(lines(ax)["measured"].get_ydata(), recording.output)
    np.testing.assert_array_equal(lines(ax)["modelled"].get_ydata(), model.simulate(recording.input))
    assert list(lines(plot.loops(recording))) == ["measured"]


def test_what_is_simulated_says_so(recording, model):
    simulated = hysteron.Recording(recording.input, recording.output, simulated=True)
    assert "simulated" in lines(plot.loops(simulated))
    assert "simulated" in lines(plot.over_time(simulated, model)[0])
    assert "simulated" in plot.over_time(simulated, model)[1].get_ylabel()
    assert "simulated" in lines(plot.dead_band(simulated, model)[1])
    assert any("simulated" in label for label in lines(plot.band(simulated, model)))


def test_it_draws_where_it_is_told(recording, model):
    figure, (first, second) = plt.subplots(2)
    assert plot.loops(recording, ax=first) is first
    assert list(plot.over_time(recording, model, axes=(first, second))) == [first, second]
    assert plt.get_fignums() == [figure.number]


def test_over_time(recording, model):
    upper, lower = plot.over_time(recording, model)
    error = model.simulate(recording.input) - recording.output
    np.testing.assert_array_equal(lower.get_lines()[1].get_ydata(), error)
    np.testing.assert_array_equal(lines(upper)["measured"].get_xdata(), recording.time)
    assert lower.get_xlabel() == "time [s]" and "[mm]" in lower.get_ylabel()
    untimed = hysteron.Recording(recording.input, recording.output)
    assert plot.over_time(untimed, model)[1].get_xlabel() == "sample"


def test_the_inverse_over_time(recording, model):
    upper, lower = plot.over_time(recording, model, of="input")
    hold = model.evaluate(recording)["inverse"]["hold"]["input_model"]
    np.testing.assert_array_equal(lines(upper)["inverse, hold"].get_ydata(), hold)
    assert upper.patches, "dead bands are shaded"
    with pytest.raises(ValueError, match="'output' or 'input'"):
        plot.over_time(recording, model, of="both")
    no_inverse = hysteron.Model([1.0, -2.0, 4.0], (30, 80))
    for draw in (lambda: plot.over_time(recording, no_inverse, of="input"), lambda: plot.dead_band(recording, no_inverse)):
        with pytest.raises(ValueError, match="no inverse"):
            draw()
    assert plt.get_fignums() == [1], "nothing is left of a figure that was refused"


@pytest.mark.parametrize("kind", ["marks", "map"])
def test_weights(model, kind):
    ax = plot.weights(model, kind=kind)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("α [°C]", "β [°C]")
    if kind == "marks":
        zero, some = ax.get_lines()
        assert len(zero.get_xdata()) + len(some.get_xdata()) == 78
        assert (some.get_ydata() >= some.get_xdata()).all(), "β is upright"
        assert len(some.get_xdata()) == model.fit["weights_not_zero"]
    else:
        drawn = ax.collections[0].get_array().reshape(12, 12)
        np.testing.assert_array_equal(np.ma.filled(drawn, np.nan), model.weights.T)


def test_negative_weights_bear_a_dash():
    ax = plot.weights(hysteron.Model([1.0, -2.0, 4.0], (0, 1)), kind="map")
    dashes = ax.get_lines()[0]
    assert (dashes.get_xdata(), dashes.get_ydata()) == ([0], [1])
    plot.weights(hysteron.Model([0.0, 0.0, 0.0], (0, 1)), kind="map")
    with pytest.raises(ValueError, match="`kind` is 'surface': it must be 'marks', 'map' or 'bars'"):
        plot.weights(hysteron.Model([1.0, 2.0, 4.0], (0, 1)), kind="surface")


def test_bars_stand_on_their_operators_as_high_as_the_weights(model, monkeypatch):
    drawn = []
    bar3d = Axes3D.bar3d
    monkeypatch.setattr(Axes3D, "bar3d", lambda ax, *bars, **style: drawn.append(bars) or bar3d(ax, *bars, **style))
    ax = plot.weights(model, kind="bars")
    x, y, bottom, width, depth, height = drawn[0]
    assert width == depth < model.plane[1] - model.plane[0] and bottom == 0
    on_plane = ~np.isnan(model.weights)
    found = np.full_like(model.weights, np.nan)
    for alpha, beta, weight in zip(x + width / 2, y + depth / 2, height):
        found[np.argmin(abs(model.plane - alpha)), np.argmin(abs(model.plane - beta))] = weight
    np.testing.assert_array_equal(found, model.weights)
    assert len(height) == on_plane.sum()
    assert (ax.get_xlabel(), ax.get_ylabel(), ax.get_zlabel()) == ("α [°C]", "β [°C]", "weight [mm]")
    assert ax.get_zlim()[1] >= np.nanmax(model.weights)


@pytest.mark.parametrize("weights, low, high", [([1.0, -2.0, 4.0], -2, 4), ([0.0, 0.0, 0.0], 0, 1), ([-1.0, -2.0, -1.0], -2, 0)])
def test_bars_of_any_sign_are_within_the_axes(weights, low, high):
    bottom, top = plot.weights(hysteron.Model(weights, (0, 1)), kind="bars").get_zlim()
    assert bottom <= low and top >= high


def test_bars_in_axes_that_are_given(model):
    ax = plt.figure().add_subplot(projection="3d")
    assert plot.weights(model, kind="bars", ax=ax) is ax
    with pytest.raises(ValueError, match="`ax` has the projection 'rectilinear'"):
        plot.weights(model, kind="bars", ax=plt.figure().add_subplot())


def test_major_loops(model):
    rising, falling = np.split(plot.major_loops(model).get_lines()[0].get_ydata(), 2)
    np.testing.assert_allclose((rising[0], rising[-1]), model.output_range)
    assert (falling[::-1] >= rising - 1e-9).all()


def test_major_loops_at_loads(truth, swings):
    load = np.repeat([1.0, 2.0, 3.0], 1000)
    path = np.tile(swings[::3], 3)
    model = hysteron.fit(path, load * truth.simulate(path), load=load, levels=8, bootstrap=0)
    ax = plot.major_loops(model)
    assert list(lines(ax)) == ["1", "2", "3"]
    assert ax.get_legend().get_title().get_text() == "load"
    assert list(lines(plot.major_loops(model, 1.5))) == ["1.5"]


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
    model = hysteron.Model(np.zeros(levels * (levels + 1) // 2), (0, 1))
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
    small = hysteron.Model([1.0, 2.0, 4.0], (0, 1), sign=-1, offset=5)
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
    model = hysteron.Model(random.uniform(size=21), (20, 80), operator=operator)
    input = random.uniform(0, 100, 40)
    at = [0, 3, 17, -1]
    for ax, sample in zip(plot.plane(model, input, at=at, start=start), at):
        gamma = by_definition(model, input[: sample % 40 + 1], start == "on")
        for text, chosen in (("γ = 0", gamma == 0), ("0 < γ < 1", (0 < gamma) & (gamma < 1)), ("γ = 1", gamma == 1)):
            drawn = {tuple(point) for point in lines(ax)[text].get_xydata()}
            assert drawn == {(model.plane[i], model.plane[j]) for i, j in np.argwhere(chosen)}


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


def test_a_thermal_body_is_refused_where_it_would_be_left_out(truth, swings):
    time = 0.5 * np.arange(len(swings))
    thermal = hysteron.fit(swings, truth.simulate(swings), time=time, thermal="first-order", levels=5, bootstrap=0)
    for draw in (lambda: plot.plane(thermal, swings), lambda: plot.major_loops(thermal), lambda: plot.structure(thermal)):
        with pytest.raises(ValueError, match="thermal body"):
            draw()


def test_band(recording, model):
    ax = plot.band(recording, model)
    coverage = model.evaluate(recording)["band"]["coverage_percent"]
    assert f"{coverage:.1f} % inside" in list(lines(ax))[0]
    with pytest.raises(hysteron.FitError, match="bootstrap"):
        plot.band(recording, hysteron.Model([1.0, 2.0, 4.0], (30, 80)))


def test_dead_band_shows_the_worst(recording, model):
    inverse = model.evaluate(recording)["inverse"]
    error = np.where(inverse["moving"], 0, np.abs(inverse["hold"]["input_model"] - recording.input))
    upper, lower = plot.dead_band(recording, model)
    low, high = lower.get_xlim()
    assert low < recording.time[np.argmax(error)] < high
    assert high - low < recording.time[-1]
    assert set(lines(lower)) >= {"measured", "inverse, hold", "inverse, anticipate"}


def test_without_matplotlib_it_says_what_to_install():
    code = "import sys; sys.modules['matplotlib'] = None\nimport hysteron\nimport hysteron.plot"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert "ImportError: hysteron.plot needs matplotlib: pip install 'hysteron[plot]'" in done.stderr


def test_the_example_runs_and_every_figure_is_documented(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert doctest.testmod(plot).failed == 0
    assert [path.name for path in tmp_path.iterdir()] == ["loops.png"]
    for name in plot.__all__:
        text = getattr(plot, name).__doc__
        assert all(f"{section}\n" in text for section in ("Parameters", "Returns", "Raises", "Examples")), name


def test_what_is_no_recording_or_model_is_named(recording, model):
    with pytest.raises(TypeError, match="`recording` is of type list: a hysteron.Recording"):
        plot.loops([1.0, 2.0])
    with pytest.raises(TypeError, match="`recording` is of type Model"):
        plot.over_time(model, recording)
    with pytest.raises(TypeError, match="`model` is of type NoneType: a hysteron.Model"):
        plot.weights(None)
    with pytest.raises(TypeError, match="`model` is of type str"):
        plot.loops(recording, model="spring.json")
    assert plot.loops(recording, None) is not None


@pytest.mark.parametrize(
    "error, told, draw",
    [
        (TypeError, r"`at` is \[1\.5\]: .* whole numbers", lambda m, r: plot.plane(m, r.input, at=[1.5])),
        (TypeError, r"`at` is 7: a sequence", lambda m, r: plot.plane(m, r.input, at=7)),
        (IndexError, r"`at` has 3000: .* 0 to 2999", lambda m, r: plot.plane(m, r.input, at=[0, 3000])),
        (IndexError, r"`at` has -3001", lambda m, r: plot.plane(m, r.input, at=[-3001])),
        (ValueError, r"`at` is \[\]", lambda m, r: plot.plane(m, r.input, at=[])),
        (ValueError, r"`input` has no samples", lambda m, r: plot.plane(m, [])),
        (ValueError, r"`start` is 'unknown': it must be 'off' or 'on'", lambda m, r: plot.plane(m, r.input, start="unknown")),
        (Exception, r"input\[1\]` is NaN", lambda m, r: plot.plane(m, [0.0, np.nan, 1.0])),
        (Exception, r"input\[1\]` is NaN", lambda m, r: plot.excitation(m, [0.0, np.nan, 1.0])),
        (TypeError, r"`input`", lambda m, r: plot.plane(m, "30 80 30")),
        (ValueError, r"`input`", lambda m, r: plot.plane(m, r)),
        (ValueError, r"`input`.*shape", lambda m, r: plot.plane(m, [[1.0, 2.0]])),
        (ValueError, r"`axes` has 2: 3 are needed", lambda m, r: plot.plane(m, r.input, at=[1, 2, 3], axes=plt.subplots(2)[1])),
        (ValueError, r"`axes` has 1: 2 are needed", lambda m, r: plot.over_time(r, m, axes=plt.subplots()[1])),
        (ValueError, r"`axes` has 1: 2 are needed", lambda m, r: plot.dead_band(r, m, axes=plt.subplots()[1])),
        (ValueError, r"`axes` has 2: 3 are needed", lambda m, r: plot.operators(axes=plt.subplots(2)[1])),
        (TypeError, r"`axes\[1\]` is of type int", lambda m, r: plot.over_time(r, m, axes=[plt.subplots()[1], 3])),
        (TypeError, r"`ax` is of type Figure: a matplotlib Axes", lambda m, r: plot.grid(m, ax=plt.figure())),
        (ValueError, r"`loads` is \[\]", lambda m, r: plot.major_loops(m, [])),
        (TypeError, r"`loads` is 'heavy'", lambda m, r: plot.major_loops(m, "heavy")),
        (hysteron.FitError, r"load", lambda m, r: plot.major_loops(m, [1.0])),
        (ValueError, r"start", lambda m, r: plot.loops(r, m, start="of")),
    ],
)
def test_bad_input_is_named(error, told, draw, model, recording):
    with pytest.raises(error, match=told):
        draw(model, recording)
    assert not any(ax.lines for number in plt.get_fignums() for ax in plt.figure(number).axes), "nothing is drawn"

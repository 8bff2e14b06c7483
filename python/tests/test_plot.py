"""The figures hold what they say: the right curves, labels with units, and the states of the definition."""

import doctest
import subprocess
import sys

import numpy as np
import pytest

import hysteron

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")
plt = pytest.importorskip("matplotlib.pyplot")
plot = pytest.importorskip("hysteron.plot")


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
        drawn = ax.collections[0].get_array()
        np.testing.assert_array_equal(np.ma.filled(drawn, np.nan), model.weights.T)


def test_negative_weights_bear_a_dash():
    ax = plot.weights(hysteron.Model([1.0, -2.0, 4.0], (0, 1)), kind="map")
    dashes = ax.get_lines()[0]
    assert (dashes.get_xdata(), dashes.get_ydata()) == ([0], [1])
    plot.weights(hysteron.Model([0.0, 0.0, 0.0], (0, 1)), kind="map")
    with pytest.raises(ValueError, match="'marks' or 'map'"):
        plot.weights(hysteron.Model([1.0, 2.0, 4.0], (0, 1)), kind="surface")


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


@pytest.mark.parametrize("operator, low", [("mkp", 0), ("kp", -1), ("relay", -1)])
@pytest.mark.parametrize("on", [False, True])
def test_states_are_those_of_the_definition(operator, low, on):
    random = np.random.default_rng(5)
    weights = random.uniform(size=21)
    model = hysteron.Model(weights, (20, 80), operator=operator)
    input = random.uniform(0, 100, 200)
    output = model.start(on=on).run(input)
    for k in range(0, 200, 7):
        gamma = plot._gamma(model, input[: k + 1], on=on)
        total = np.nansum(model.weights * (gamma if low == 0 else 2 * gamma - 1))
        assert total == pytest.approx(output[k], abs=1e-12)


def test_plane(truth, swings):
    axes = plot.plane(truth, swings)
    assert len(axes) == 6
    first = lines(axes[0])
    marks = [first[label] for label in ("γ = 0", "0 < γ < 1", "γ = 1")]
    assert sum(len(line.get_xdata()) for line in marks) == 78
    assert "°C at sample" in axes[0].get_title()
    assert len(plot.plane(truth, swings, at=[10, -1])) == 2
    with pytest.raises(IndexError):
        plot.plane(truth, swings, at=[3000])


def test_plane_refuses_what_the_operators_do_not_see(truth, swings):
    time = 0.5 * np.arange(len(swings))
    thermal = hysteron.fit(swings, truth.simulate(swings), time=time, thermal="first-order", levels=5, bootstrap=0)
    with pytest.raises(ValueError, match="thermal body"):
        plot.plane(thermal, swings)


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
        assert "Parameters\n" in text and "Returns\n" in text, name


def test_what_is_no_recording_or_model_is_named(recording):
    with pytest.raises(TypeError, match="`recording` is of type list: a hysteron.Recording"):
        plot.loops([1.0, 2.0])
    with pytest.raises(TypeError, match="`model` is of type NoneType: a hysteron.Model"):
        plot.weights(None)
    with pytest.raises(TypeError, match="`model` is of type str"):
        plot.loops(recording, model="spring.json")
    assert plot.loops(recording, None) is not None

"""The figures hold what they say: the right curves, and labels with units. What they cannot show they refuse by name."""

import inspect
import re
import subprocess
import sys

import numpy as np
import pytest
from common import lines

import pyhysteron

plt = pytest.importorskip("matplotlib.pyplot")
from pyhysteron import plot  # noqa: E402

pytestmark = pytest.mark.usefixtures("drawn")


def test_loops(recording, model):
    ax = plot.loops(recording, model)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("temperature [°C]", "lift [mm]")
    np.testing.assert_array_equal(lines(ax)["measured"].get_ydata(), recording.output)
    np.testing.assert_array_equal(lines(ax)["modelled"].get_ydata(), model.simulate(recording.input))
    assert list(lines(plot.loops(recording))) == ["measured"]


def test_what_is_simulated_says_so(recording, model):
    simulated = pyhysteron.Recording(recording.input, recording.output, simulated=True)
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
    untimed = pyhysteron.Recording(recording.input, recording.output)
    assert plot.over_time(untimed, model)[1].get_xlabel() == "sample"


def test_the_inverse_over_time(recording, model):
    upper, lower = plot.over_time(recording, model, of="input")
    hold = model.evaluate(recording).inverse.hold.input_model
    np.testing.assert_array_equal(lines(upper)["inverse, hold"].get_ydata(), hold)
    assert upper.patches, "dead bands are shaded"
    with pytest.raises(ValueError, match="`of` is 'both': one of 'output', 'input' is needed"):
        plot.over_time(recording, model, of="both")
    no_inverse = pyhysteron.Model([1.0, -2.0, 4.0], (30, 80))
    for draw in (lambda: plot.over_time(recording, no_inverse, of="input"), lambda: plot.dead_band(recording, no_inverse)):
        with pytest.raises(ValueError, match="no inverse"):
            draw()
    assert plt.get_fignums() == [1], "nothing is left of a figure that was refused"


def test_major_loops(model):
    rising, falling = np.split(plot.major_loops(model).get_lines()[0].get_ydata(), 2)
    np.testing.assert_allclose((rising[0], rising[-1]), model.output_range)
    assert (falling[::-1] >= rising - 1e-9).all()


def test_major_loops_at_loads(truth, swings):
    load = np.repeat([1.0, 2.0, 3.0], 1000)
    path = np.tile(swings[::3], 3)
    model = pyhysteron.fit(path, load * truth.simulate(path), load=load, levels=8, bootstrap=0)
    ax = plot.major_loops(model)
    assert list(lines(ax)) == ["1", "2", "3"]
    assert ax.get_legend().get_title().get_text() == "load"
    assert list(lines(plot.major_loops(model, 1.5))) == ["1.5"]
    named = pyhysteron.Recording(path, load * truth.simulate(path), load=load, load_name="room [degC]")
    ax = plot.major_loops(pyhysteron.fit(named, levels=8, bootstrap=0))
    assert ax.get_legend().get_title().get_text() == "room [°C]"


def test_a_thermal_body_is_refused_where_it_would_be_left_out(truth, swings):
    time = 0.5 * np.arange(len(swings))
    thermal = pyhysteron.fit(swings, truth.simulate(swings), time=time, thermal="first-order", levels=5, bootstrap=0)
    for draw in (lambda: plot.plane(thermal, swings), lambda: plot.major_loops(thermal), lambda: plot.structure(thermal)):
        with pytest.raises(ValueError, match="thermal body"):
            draw()


def test_band(recording, model):
    ax = plot.band(recording, model)
    coverage = model.evaluate(recording).band.coverage_percent
    assert f"{coverage:.1f} % inside" in list(lines(ax))[0]
    with pytest.raises(pyhysteron.FitError, match="bootstrap"):
        plot.band(recording, pyhysteron.Model([1.0, 2.0, 4.0], (30, 80)))


def test_dead_band_shows_the_worst(recording, model):
    inverse = model.evaluate(recording).inverse
    error = np.where(inverse.moving, 0, np.abs(inverse.hold.input_model - recording.input))
    upper, lower = plot.dead_band(recording, model)
    low, high = lower.get_xlim()
    assert low < recording.time[np.argmax(error)] < high
    assert high - low < recording.time[-1]
    assert set(lines(lower)) >= {"measured", "inverse, hold", "inverse, anticipate"}


@pytest.mark.parametrize("module, package, extra", [("plot", "matplotlib", "plot"), ("sklearn", "sklearn", "sklearn"), ("blocks", "control", "control")])
def test_without_its_package_it_says_what_to_install(module, package, extra):
    code = f"import sys; sys.modules[{package!r}] = None\nimport pyhysteron\nimport pyhysteron.{module}"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert f"ImportError: pyhysteron.{module} needs " in done.stderr and f"pip install 'pyhysteron[{extra}]'" in done.stderr


@pytest.mark.parametrize("name", plot.__all__)
def test_every_figure_says_what_it_refuses(name):
    assert "\nRaises\n------\n" in inspect.getdoc(getattr(plot, name))


def test_what_is_no_recording_or_model_is_named(recording, model):
    with pytest.raises(TypeError, match="`recording` is of type list: a pyhysteron.Recording"):
        plot.loops([1.0, 2.0])
    with pytest.raises(TypeError, match="`recording` is of type Model"):
        plot.over_time(model, recording)
    with pytest.raises(TypeError, match="`model` is of type NoneType: a pyhysteron.Model"):
        plot.weights(None)
    with pytest.raises(TypeError, match="`model` is of type str"):
        plot.loops(recording, model="spring.json")
    assert plot.loops(recording, None) is not None


@pytest.mark.parametrize(
    "error, message, draw",
    [
        (TypeError, r"`at` is \[1\.5\]: .* whole numbers", lambda m, r: plot.plane(m, r.input, at=[1.5])),
        (TypeError, r"`at` is 7: a sequence", lambda m, r: plot.plane(m, r.input, at=7)),
        (IndexError, r"`at` has 3000: .* 0 to 2999", lambda m, r: plot.plane(m, r.input, at=[0, 3000])),
        (IndexError, r"`at` has -3001", lambda m, r: plot.plane(m, r.input, at=[-3001])),
        (ValueError, r"`at` is \[\]", lambda m, r: plot.plane(m, r.input, at=[])),
        (ValueError, r"`input` has no samples", lambda m, r: plot.plane(m, [])),
        (ValueError, r"`start` is 'unknown': one of 'off', 'on' is needed", lambda m, r: plot.plane(m, r.input, start="unknown")),
        (pyhysteron.CoreError, r"input\[1\]` is NaN", lambda m, r: plot.plane(m, [0.0, np.nan, 1.0])),
        (pyhysteron.CoreError, r"input\[1\]` is NaN", lambda m, r: plot.excitation(m, [0.0, np.nan, 1.0])),
        (TypeError, r"`input`", lambda m, r: plot.plane(m, "30 80 30")),
        (TypeError, r"`input` is a Recording", lambda m, r: plot.plane(m, r)),
        (ValueError, r"`input`.*shape", lambda m, r: plot.plane(m, [[1.0, 2.0]])),
        (ValueError, r"`axes` has 2: 3 are needed", lambda m, r: plot.plane(m, r.input, at=[1, 2, 3], axes=plt.subplots(2)[1])),
        (ValueError, r"`axes` has 1: 2 are needed", lambda m, r: plot.over_time(r, m, axes=plt.subplots()[1])),
        (ValueError, r"`axes` has 1: 2 are needed", lambda m, r: plot.dead_band(r, m, axes=plt.subplots()[1])),
        (ValueError, r"`axes` has 2: 3 are needed", lambda m, r: plot.operators(axes=plt.subplots(2)[1])),
        (TypeError, r"`axes\[1\]` is of type int", lambda m, r: plot.over_time(r, m, axes=[plt.subplots()[1], 3])),
        (TypeError, r"`ax` is of type Figure: a matplotlib Axes", lambda m, r: plot.grid(m, ax=plt.figure())),
        (ValueError, r"`loads` is \[\]", lambda m, r: plot.major_loops(m, [])),
        (TypeError, r"`loads` is 'heavy'", lambda m, r: plot.major_loops(m, "heavy")),
        (pyhysteron.FitError, r"load", lambda m, r: plot.major_loops(m, [1.0])),
        (ValueError, r"start", lambda m, r: plot.loops(r, m, start="of")),
    ],
)
def test_bad_input_is_named(error, message, draw, model, recording):
    with pytest.raises(error, match=message):
        draw(model, recording)
    assert not any(ax.lines for number in plt.get_fignums() for ax in plt.figure(number).axes), "nothing is drawn"


def test_a_notebook_shows_one_figure_at_its_width():
    input = 50 - 30 * np.cos(np.linspace(0, 20, 300))
    model = pyhysteron.Model(np.full(15, 0.2), (20, 80), input="temperature [degC]", output="lift [mm]")
    recording = pyhysteron.Recording(input, model.simulate(input), input_name="temperature [degC]", output_name="lift [mm]")
    for picture, axes in [(model.plot(), 2), (recording.plot(), 3), (model.plot(recording), 3), (recording.plot(model), 3)]:
        assert len(picture.figure.axes) >= axes
        head = picture._repr_html_().split(">")[0]
        assert "width: 100%" in head and "viewBox" in head and not re.search(r'\s(width|height)="', head)
    # Measured and modelled, over time.
    assert len(recording.plot(model).figure.axes[1].get_lines()) == 2
    with pytest.raises(TypeError, match="model"):
        recording.plot(3)

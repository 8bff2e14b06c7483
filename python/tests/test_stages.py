"""Models with stages around the operators: thermal body, load, spacing, creep, lag and a start."""

import json
import pickle

import numpy as np
import pytest

import pyhysteron

LEVELS = 8
WEIGHTS = np.exp(-np.arange(36.0) / 12)
CURVES = {
    "loads": [100.0, 150.0, 200.0],
    "shifts": [10.0, 14.0, 20.0],
    "scales": [1.0, 1.02, 1.05],
    "gains": [1.0, 1.1, 1.3],
    "offsets": [0.0, 0.2, 0.3],
}
PARTS = [{"offset": 2.0, "weights": list(WEIGHTS)}, {"offset": 1.5, "weights": list(1.5 * WEIGHTS[::-1])}]
STAGES = {
    "body": {
        "thermal": {"kind": "first-order", "ambient": 20.0, "gain": 60.0, "tau_heating": 0.4, "tau_cooling": 0.9},
        "drive": {"min": 0.0, "max": 1.0},
    },
    "load": {"load": {"name": "stress", "unit": "MPa", "min": 100.0, "max": 200.0, "parts": PARTS[:1], "curves": CURVES}},
    "weights": {"load": {"name": "stress", "unit": "MPa", "min": 100.0, "max": 200.0, "parts": PARTS}},
    "spacing": {"spacing": [18.0, 30.0, 33.0, 36.0, 40.0, 50.0, 52.0, 60.0, 75.0]},
    "creep": {"creep": [{"coefficient": 0.05, "tau": 0.3}, {"coefficient": 0.02, "tau": 5.0}]},
    "lag": {"lag": 0.05},
}
#: Names of stages that a model has together.
COMBINED = [[name] for name in STAGES] + [["body", "load", "spacing", "creep", "lag"], ["body", "weights", "creep"]]
START = {"start": {"turning_points": [6.5, 2.0, 4.0], "input": 40.0}}

TIME = np.cumsum(0.02 + 0.01 * np.random.default_rng(0).random(1500))
WAVE = 0.5 - 0.5 * np.cos(TIME / 2) * np.exp(-TIME / 60)
LOAD = 150 + 50 * np.sin(TIME / 3)


def made(*names, **more):
    """A model with these stages."""
    plain = pyhysteron.Model(WEIGHTS, (25, 75), offset=2.0, sign=-1 if "lag" in names else 1, input="drive")
    text = json.loads(plain.to_json()) | {"version": 2}
    for name in names:
        text |= STAGES[name]
    text |= more
    if "weights" in names:
        text["weights"] = list(np.mean([part["weights"] for part in PARTS], axis=0))
        text["output"]["offset"] = 1.75
    return pyhysteron.Model.from_json(json.dumps(text))


def driven(model):
    """An input for the model, and what goes with it."""
    input = WAVE if model.thermal else 18 + 60 * WAVE
    around = {"time": TIME} if model.is_timed else {}
    return input, around | ({} if model.load_range is None else {"load": LOAD})


@pytest.fixture(params=COMBINED, ids="+".join)
def staged(request):
    return made(*request.param)


def test_a_run_is_the_same_as_its_steps(staged):
    input, around = driven(staged)
    whole = staged.simulate(input, **around)
    state = staged.start()
    for n, value in enumerate(input):
        sample = {"load": LOAD[n]} if "load" in around else {}
        if n and "time" in around:
            sample["dt"] = TIME[n] - TIME[n - 1]
        assert state.step(value, **sample) == whole[n]
    assert np.ptp(whole) > 1


def test_a_run_goes_on_from_another(staged):
    input, around = driven(staged)
    whole = staged.simulate(input, **around)
    state = staged.start()
    first = {name: series[:700] for name, series in around.items()}
    rest = {name: series[699 if name == "time" else 700 :] for name, series in around.items()}
    pieces = [state.run(input[:700], **first), state.run(input[700:], **rest)]
    np.testing.assert_array_equal(np.concatenate(pieces), whole)


def test_a_state_is_saved_whole(staged):
    input, around = driven(staged)
    state = staged.start()
    state.run(input[:900], **{name: series[:900] for name, series in around.items()})
    rest = {name: series[899 if name == "time" else 900 :] for name, series in around.items()}
    whole = state.copy().run(input[900:], **rest)
    saved = state.save()
    assert saved["stages"].shape == (10,) and saved["stages"][0] == 1
    as_text = json.loads(json.dumps({name: np.asarray(value).tolist() for name, value in saved.items()}))
    for again in (pickle.loads(pickle.dumps(state)), staged.restore(saved), staged.restore(as_text)):
        assert again.temperature == state.temperature
        np.testing.assert_array_equal(again.run(input[900:], **rest), whole)


def test_the_inverse_and_back(staged):
    input, around = driven(staged)
    span = np.ptp(staged.output_range)
    wanted = staged.simulate(input, **around)
    inverse = staged.inverse()
    inputs, status = inverse.run(wanted, **around)
    reached = staged.simulate(inputs, **around)
    assert set(status) <= {0, 3} and np.mean(status == 0) > 0.9
    # Where a drive was at its end, the next samples go on from where it led: the model knows.
    assert np.abs(reached - wanted)[status == 0].max() < 1e-9 * span
    low, high = inverse.drive_range
    assert (inputs >= low).all() and (inputs <= high).all()
    state = staged.start()
    for n in range(200):
        sample = {"load": LOAD[n]} if "load" in around else {}
        if n and "time" in around:
            sample["dt"] = TIME[n] - TIME[n - 1]
        assert inverse.step(state, wanted[n], **sample) == (inputs[n], status[n])


def test_headings_go_with_time_and_load(staged):
    input, around = driven(staged)
    wanted = staged.simulate(input, **around)
    headings = pyhysteron.control.headings(wanted, 0.1)
    told = staged.inverse().run(wanted, **around, heading=headings, tolerance=0.1)
    found = staged.inverse().run(wanted, **around, policy="anticipate", tolerance=0.1)
    np.testing.assert_array_equal(told, found)


def test_limits_of_the_drive():
    model = made("body")
    free = made("body", drive=None)
    assert free.drive is None and free.inverse().drive_range == pytest.approx((np.array(free.active_range) - 20) / 60)
    inverse = model.inverse(drive_range=(0.1, 0.6))
    wanted = model.simulate(WAVE, time=TIME)
    drive, status = inverse.run(wanted, time=TIME)
    assert set(status) == {0, 3}
    assert (drive >= 0.1).all() and (drive <= 0.6).all()
    assert set(drive[status == 3]) <= {0.1, 0.6}
    reached = model.simulate(drive, time=TIME)
    assert np.abs(reached - wanted)[status == 0].max() < 1e-9 * np.ptp(model.output_range)
    noisy = wanted + 0.01 * np.random.default_rng(1).normal(size=len(wanted))
    calm = model.inverse((0, 1), horizon=0.5)
    assert calm.horizon == 0.5
    hard, soft = (of.run(noisy, time=TIME)[0] for of in (model.inverse((0, 1)), calm))
    assert np.abs(np.diff(soft)).mean() < 0.5 * np.abs(np.diff(hard)).mean()
    again = pickle.loads(pickle.dumps(calm))
    assert (again.drive_range, again.horizon, again.model) == ((0.0, 1.0), 0.5, model)
    held = made("body", drive={"min": 0.05, "max": 0.8})
    assert held.drive == (0.05, 0.8) == held.inverse().drive_range
    assert made("lag").inverse().drive_range == (-np.inf, np.inf)


def test_one_number_is_the_load_of_all_samples():
    model = made("load")
    input, _ = driven(model)
    expected = model.simulate(input, load=np.full(len(input), 120.0))
    np.testing.assert_array_equal(model.simulate(input, load=120.0), expected)
    np.testing.assert_array_equal(model.simulate(input, load=np.float64(120)), expected)
    np.testing.assert_allclose(model.at_load(120.0).simulate(input), expected, atol=1e-12)
    wanted = model.inverse().run(expected, load=120)[0]
    np.testing.assert_allclose(model.simulate(wanted, load=120), expected, atol=1e-12)


def test_the_temperature():
    model = made("body")
    state = model.start()
    state.step(0.5)
    assert state.temperature == 50.0
    state.step(0.0, dt=0.9)
    assert state.temperature == pytest.approx(20 + 30 * np.exp(-1), rel=1e-14)
    plain = pyhysteron.Model(WEIGHTS, (25, 75)).start()
    plain.step(33.0)
    assert plain.temperature == 33.0


def test_what_a_model_has():
    model = made("body", "load", "spacing", "creep", "lag", **START)
    assert model.thermal.ambient == 20.0 and model.thermal.gain == 60.0
    assert model.load_curves.to_dict().keys() == CURVES.keys()
    for name, values in CURVES.items():
        np.testing.assert_array_equal(getattr(model.load_curves, name), values)
    assert (model.load_degree, made("weights").load_degree, made("weights").load_curves) == (0, 1, None)
    np.testing.assert_array_equal(model.spacing, STAGES["spacing"]["spacing"])
    assert [term.to_dict() for term in model.creep] == STAGES["creep"]["creep"]
    assert (model.lag, model.drive, model.is_timed) == (0.05, (0.0, 1.0), True)
    assert pickle.loads(pickle.dumps(model)) == model
    np.testing.assert_array_equal(model.fitted_start["turning_points"], [6.5, 2.0, 4.0])
    plain = pyhysteron.Model(WEIGHTS, (25, 75))
    assert (plain.load_curves, plain.load_degree, plain.spacing, plain.creep) == (None, None, None, ())
    assert (plain.lag, plain.drive, plain.is_timed, plain.fitted_start) == (0.0, None, False, None)
    assert plain.active_range == pytest.approx((25 - 50 / 7, 75))
    assert made("spacing").active_range == (18.0, 75.0)


def test_the_start():
    model = made(**START)
    input = 40 + 15 * np.sin(TIME)
    for start, on in [("fitted", None), ("off", False), ("on", True)]:
        state = model.start(on=on)
        expected = model.simulate(input, start=start)
        np.testing.assert_array_equal(state.run(input), expected)
        state.reset(on=on)
        np.testing.assert_array_equal(state.run(input), expected)
        assert model.evaluate(input, expected, start=start).forward.rmse == 0
    np.testing.assert_array_equal(model.simulate(input), model.simulate(input, start="fitted"))
    assert not np.array_equal(model.simulate(input), model.simulate(input, start="off"))
    begun = model.start()
    np.testing.assert_array_equal(begun.turning_points, [6.5, 2.0, 4.0])
    np.testing.assert_array_equal(model.restore(model.fitted_start).run(input), begun.run(input))
    found = model.evaluate(input, model.simulate(input))
    assert found.forward.rmse == 0 and found.estimated_from is None
    assert 0 < model.evaluate(input, model.simulate(input), start="unknown").estimated_from <= len(input)
    wanted = model.simulate(input)
    assert np.abs(model.simulate(model.inverse().run(wanted)[0]) - wanted).max() < 1e-12


@pytest.mark.parametrize(
    "names, arguments, error, message",
    [
        (["body"], {}, pyhysteron.ThermalError, "`time`"),
        (["lag"], {}, pyhysteron.ThermalError, "`time`"),
        (["body"], {"time": TIME[::-1]}, pyhysteron.ThermalError, "back"),
        (["body"], {"time": TIME[:5]}, pyhysteron.FitError, "5 times for 1500 samples"),
        (["body"], {"time": np.where(TIME == TIME[7], np.nan, TIME)}, pyhysteron.CoreError, r"`time\[7\]` is NaN"),
        (["body"], {"time": TIME, "load": LOAD}, pyhysteron.FitError, "does not depend on a load"),
        (["load"], {}, pyhysteron.FitError, "`load`"),
        (["weights"], {}, pyhysteron.FitError, "`load`"),
        (["load"], {"load": LOAD[:5]}, pyhysteron.FitError, "5 loads for 1500 samples"),
        (["load"], {"load": np.nan}, pyhysteron.CoreError, "`load` is NaN"),
        (["load"], {"load": np.where(LOAD == LOAD[3], np.inf, LOAD)}, pyhysteron.CoreError, r"`load\[3\]` is inf"),
        (["weights"], {"load": LOAD + 100}, pyhysteron.FitError, "outside the range 100 to 200"),
        (["lag"], {"time": TIME, "start": "unknown"}, ValueError, "'fitted', 'off', 'on'"),
    ],
)
def test_what_is_refused(names, arguments, error, message):
    model = made(*names)
    input, _ = driven(model)
    with pytest.raises(error, match=message):
        model.simulate(input, **arguments)
    if "start" in arguments:
        return
    with pytest.raises(error, match=message):
        model.inverse().run(model.offset + 0 * input, **arguments)
    state = model.start()
    state.step(input[0], **({} if model.load_range is None else {"load": 150.0}))
    before = state.save()
    with pytest.raises(error, match=message):
        state.run(input, **arguments)
    with pytest.raises(error, match=message):
        model.inverse().run(model.offset + 0 * input, **arguments, state=state)
    np.testing.assert_equal(state.save(), before)


def test_what_a_step_refuses():
    state = made("body").start()
    state.step(0.3)
    for step in (state.step, lambda *a, **k: made("body").inverse().step(state, *a, **k)):
        for sample, error, message in [
            ({}, pyhysteron.ThermalError, "time"),
            ({"dt": -1.0}, pyhysteron.ThermalError, "time"),
            ({"dt": np.nan}, pyhysteron.CoreError, "`dt` is NaN"),
            ({"dt": 0.1, "load": 1.0}, pyhysteron.FitError, "load"),
            ({"dt": 0.1, "load": np.inf}, pyhysteron.CoreError, "`load` is inf"),
        ]:
            with pytest.raises(error, match=message):
                step(0.5, **sample)
    for drive_range, message in [((1, 0), "order"), ((np.nan, 1), "order")]:
        with pytest.raises(pyhysteron.FitError, match=message):
            made("body").inverse(drive_range)
    with pytest.raises(pyhysteron.FitError, match="horizon"):
        made("body").inverse(horizon=-1)
    with pytest.raises(ValueError, match="10 are needed"):
        made("body").restore({"turning_points": [0.0], "input": 0.0, "stages": [0.0]})
    with pytest.raises(pyhysteron.CoreError, match=r"`stages\[1\]` is NaN"):
        made("body").restore({"turning_points": [0.0], "input": 0.0, "stages": [1.0] + 9 * [np.nan]})


@pytest.mark.filterwarnings("ignore::pyhysteron.HysteronWarning")
def test_stages_are_identified():
    truth, steps = made("body"), np.repeat(np.random.default_rng(2).random(60), 25)
    recording = pyhysteron.Recording(steps, truth.simulate(steps, time=TIME), time=TIME)
    model = pyhysteron.fit(recording, levels=8, thermal=True, bootstrap=0)
    assert model.thermal.tau_heating == pytest.approx(0.4, rel=0.3)
    assert model.drive == (steps.min(), steps.max())
    for name in ("first-order", True):
        assert pyhysteron.fit(recording, levels=4, thermal=name, bootstrap=0).thermal is not None
    assert pyhysteron.fit(recording, levels=4, thermal=False, bootstrap=0).thermal is None
    input = 18 + 60 * WAVE
    lagged = pyhysteron.Recording(input, made("lag").simulate(input, time=TIME), time=TIME)
    assert pyhysteron.fit(lagged, levels=6, bootstrap=0, lag=0.05).lag == 0.05
    assert pyhysteron.fit(lagged, levels=6, bootstrap=0, lag="auto").lag >= 0
    assert pyhysteron.fit(lagged, levels=6, bootstrap=0, lag="off").lag == 0
    assert len(pyhysteron.fit(lagged, levels=6, bootstrap=0, creep=2).creep) == 2
    spaced = pyhysteron.fit(input, np.tanh((input - 50) / 2), levels=6, bootstrap=0, spacing="auto")
    assert spaced.spacing.shape == (7,)
    with pytest.raises(pyhysteron.FitError, match="`time`"):
        pyhysteron.fit(input, lagged.output, levels=6, lag=0.05)


@pytest.mark.filterwarnings("ignore::pyhysteron.HysteronWarning")
def test_laws_of_the_load():
    truth = made("load")
    input = 18 + 60 * WAVE
    runs = [
        pyhysteron.Recording(input, truth.simulate(input, load=load), load=np.full(len(input), load)) for load in (100.0, 150.0, 200.0)
    ]
    shifted = pyhysteron.fit(runs, levels=8, bootstrap=0)
    weighted = pyhysteron.fit(runs, levels=8, bootstrap=0, load_law="weights", load_degree=2)
    assert len(shifted.load_curves.shifts) and weighted.load_curves is None and weighted.load_degree == 2
    for model in (shifted, weighted):
        assert model.evaluate(runs[1]).forward.nrmse_percent < 2


@pytest.mark.parametrize(
    "options, error, message",
    [
        ({"load_law": "shfit"}, ValueError, "'auto', 'shift', 'weights' is needed. Did you mean 'shift'"),
        ({"spacing": "even"}, ValueError, "`spacing` is 'even'"),
        ({"creep": "on"}, ValueError, "'off', 'auto'"),
        ({"creep": 2.5}, TypeError, "a whole number"),
        ({"creep": 5}, pyhysteron.FitError, "creep"),
        ({"lag": "on"}, ValueError, "'off', 'auto'"),
        ({"lag": -1.0}, pyhysteron.FitError, "lag"),
        ({"lag": ()}, TypeError, "`lag` is"),
        ({"load_degree": "two"}, TypeError, "'auto' is needed"),
        ({"thermal": "second-order"}, ValueError, "'first-order'"),
        ({"start": "fitted"}, ValueError, "'off', 'on', 'rest', 'unknown'"),
    ],
)
def test_options_that_are_refused(options, error, message):
    with pytest.raises(error, match=message):
        pyhysteron.fit(18 + 60 * WAVE, WAVE**2, time=TIME, **{"levels": 4, "bootstrap": 0, **options})


def test_left_out_has_no_stages():
    with pytest.raises(TypeError, match="left_out: there is no argument `spacing`"):
        pyhysteron.left_out(18 + 60 * WAVE, WAVE**2, spacing="auto")


@pytest.mark.parametrize("names", [["body"], ["spacing"], ["body", "spacing", "creep"]], ids="+".join)
def test_adaptation_keeps_the_stages(names):
    model = made(*names)
    changed = json.loads(model.to_json())
    changed["weights"] = list(1.3 * np.array(changed["weights"]))
    plant = pyhysteron.Model.from_json(json.dumps(changed))
    input, around = driven(model)
    adapted = pyhysteron.adapt(model, input, plant.simulate(input, **around), time=TIME)
    assert adapted.model.thermal == model.thermal and adapted.model.creep == model.creep
    np.testing.assert_array_equal(adapted.model.spacing, model.spacing)
    last = adapted.comparison.thirds[-1]
    assert last.adapting.rmse < 0.2 * last.fixed.rmse


def test_an_input_says_what_it_says_behind_the_stages():
    model = made("body", "load")
    input, around = driven(model)
    recording = pyhysteron.Recording(input, input, **around)
    assert np.nanmax(model.excitation(recording)) == 3
    with pytest.raises(pyhysteron.HysteronError):
        model.excitation(input)


def test_blocks_step_with_their_sample_time(staged):
    control = pytest.importorskip("control")
    blocks = pyhysteron.blocks
    time = 0.03 * np.arange(120)
    input = (WAVE if staged.thermal else 18 + 60 * WAVE)[:360:3]
    around = {"time": time} if staged.is_timed else {}
    signals = [input]
    if staged.load_range is not None:
        around["load"] = LOAD[:120]
        signals.append(LOAD[:120])
    expected = staged.simulate(input, **around)
    block = blocks.model_block(staged, 0.03)
    assert block.input_labels == ["input", "load"][: len(signals)]
    found = control.input_output_response(block, time, np.array(signals)).y[0]
    # The samples of the block are steps of 0.03 s, not differences of times.
    np.testing.assert_allclose(found, expected, atol=1e-12)
    wanted = control.input_output_response(blocks.inverse_block(staged, 0.03), time, np.array([expected, *signals[1:]])).y[0]
    np.testing.assert_allclose(wanted, staged.inverse().run(expected, **around)[0], atol=1e-6)
    state = staged.start()
    state.run(input, **around)
    vector = blocks.memory(staged, state)
    np.testing.assert_array_equal(vector[-10:], state.save()["stages"])
    if staged.is_timed:
        with pytest.raises(ValueError, match="depends on time"):
            blocks.model_block(staged, True)


@pytest.mark.filterwarnings("ignore::pyhysteron.HysteronWarning")
def test_a_regressor_with_columns_for_time_and_load():
    pytest.importorskip("sklearn")
    from sklearn.base import clone

    from pyhysteron.sklearn import HysteresisRegressor

    input, load = 18 + 60 * WAVE, 150 + 50 * np.sign(np.sin(TIME))
    output = made("load", "lag").simulate(input, time=TIME, load=load)
    X = np.column_stack([TIME, load, input])
    options = dict(levels=6, bootstrap=0, lag=0.05, load_law="shift", load_degree=1)
    regressor = clone(HysteresisRegressor(**options, column=2, time_column=0, load_column=1)).fit(X, output)
    direct = pyhysteron.fit(input, output, time=TIME, load=load, **options)
    np.testing.assert_array_equal(regressor.predict(X), direct.simulate(input, time=TIME, load=load))
    assert regressor.score(X, output) > 0.99
    with pytest.raises(ValueError, match="`load_column` is 7"):
        clone(regressor).set_params(load_column=7).fit(X, output)
    with pytest.raises(pyhysteron.FitError, match="`time`"):
        clone(regressor).set_params(time_column=None).fit(X, output)


def test_pages_and_figures_of_stages():
    page = made("body", "load", "spacing", "creep", "lag")._repr_html_()
    for message in ("thermal body", "stress [MPa]", "levels", "creep", "lag"):
        assert message in page
    text = repr(made("body", "load"))
    assert "behind a thermal body" in text and "under stress [MPa]" in text
    plot = pytest.importorskip("pyhysteron.plot")
    from matplotlib import pyplot as plt

    for name in ("spacing", "load", "weights"):
        model = made(name)
        input = driven(model)[0]
        plot.major_loops(model)
        plot.weights(model, kind="map")
        plot.grid(model)
        plot.plane(model, input[:200])
        plt.close("all")
    recording = pyhysteron.Recording(18 + 60 * WAVE, WAVE, time=TIME)
    plot.loops(recording, made("lag"))
    plt.close("all")
    with pytest.raises(ValueError, match="creep or a lag"):
        plot.major_loops(made("lag"))


def test_errors_of_an_adaptation_are_before_creep():
    model = made("creep", "lag")
    input, around = driven(model)
    measured = model.simulate(input, **around)
    adapted = pyhysteron.adapt(model, input, measured, **around)
    assert np.abs(adapted.table["error"]).max() < 1e-9
    np.testing.assert_allclose(adapted.table["output_model"], measured, atol=1e-9)


def test_a_model_with_a_body_is_exported_at_a_sample_time(tmp_path):
    body = {"kind": "first-order", "gain": 1.0, "tau_heating": 1.0, "tau_cooling": 2.0}
    text = json.loads(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)).to_json())
    model = pyhysteron.Model.from_json(json.dumps({**text, "thermal": body}))
    export = model.export_c(tmp_path / "c", dt=0.01, drive_range=(0.0, 1.0))
    assert any(str(file).endswith("hysteron_mcu_stages.c") for file in export.files)
    with pytest.raises(pyhysteron.ExportError, match="dt"):
        model.export_c(tmp_path / "no")

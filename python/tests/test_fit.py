import threading
import time

import numpy as np
import pytest

import pyhysteron


def nrmse(model):
    return model.fit.nrmse_percent


def test_recording_arrays_and_lists_are_the_same_experiment(recording):
    one = pyhysteron.fit(recording, levels=8, bootstrap=0)
    other = pyhysteron.fit(recording.input, recording.output, levels=8, bootstrap=0)
    np.testing.assert_array_equal(one.weights, other.weights)
    assert one == pyhysteron.fit([recording], levels=8, bootstrap=0)
    assert one.input == "temperature [degC]" and other.input == "input"
    several = pyhysteron.fit([recording, recording], levels=8, bootstrap=0)
    assert several.fit.samples == 2 * len(recording)


def test_the_weights_are_those_behind_the_data(truth, swings):
    exact = dict(smooth=0.0, ridge=0.0, spacing="uniform", robust=False, bootstrap=0)
    model = pyhysteron.fit(swings, truth.simulate(swings), levels=12, range=(25, 80), **exact)
    # Without noise all that is left is rounding.
    assert nrmse(model) < 1e-6
    assert abs(model.offset - 3) < 1e-6


@pytest.mark.parametrize(
    "options",
    [
        {"operator": "kp"},
        {"operator": "relay"},
        {"solver": "ols"},
        {"smooth": 1e-7},
        {"smooth": "auto", "levels": 8},
        {"levels": "auto"},
        {"start": "on"},
        {"start": "unknown"},
        {"sign": 1},
        {"offset": 3.0},
        {"range": (20, 85)},
        {"bootstrap": 5},
    ],
)
def test_options_reach_the_fit(recording, options):
    model = pyhysteron.fit(recording, **{"levels": 10, "bootstrap": 0, **options})
    told = model.fit
    for name in ("solver", "start"):
        assert getattr(told, name) == options.get(name, getattr(told, name))
    assert model.operator == options.get("operator", "mkp")
    assert model.offset == options.get("offset", model.offset)
    assert model.range == options.get("range", model.range)
    chosen = "auto" in (options.get("smooth", "auto"), options.get("levels"))
    assert chosen == (told.validation is not None)
    assert (model.confidence is None) == ("bootstrap" not in options)
    assert nrmse(model) < 5


def test_levels_are_chosen_and_replicates_follow(recording):
    model = pyhysteron.fit(recording)
    assert model.fit.validation.criterion == "left_out"
    assert model.levels in {score.levels for score in model.fit.validation.scores}
    assert model.confidence.replicates == (200 if model.levels < 25 else 60)
    assert pyhysteron.fit(recording, levels=20).confidence.replicates == 200


def test_load(recording, swings):
    load = np.repeat([0.0, 1.0, 2.0], 1000)
    output = recording.output * (1 + 0.1 * load)
    model = pyhysteron.fit(swings, output, load=load, levels=10, bootstrap=5)
    assert model.load_range == (0, 2)
    modelled = model.simulate(swings, load=load)
    assert np.std(modelled - output) < 0.02 * np.ptp(output)
    low, high = model.band(swings, load=load)
    assert (low < modelled).all() and (modelled < high).all()
    assert model.at_load(2).load_range is None
    for bad in ({}, {"load": load[:3]}, {"load": load + 5}):
        with pytest.raises(pyhysteron.FitError, match="load"):
            model.simulate(swings, **bad)
    with pytest.raises(pyhysteron.FitError, match="load"):
        model.at_load(1).simulate(swings, load=load)
    with pytest.raises(pyhysteron.FitError, match="take `load_degree=1` at most"):
        pyhysteron.fit(swings, output, load=np.repeat([0.0, 1.0], 1500), load_degree=2, levels=5)


def test_thermal(truth):
    time = 0.1 * np.arange(2000)
    duty = 50 + 40 * np.sign(np.sin(time / 9)) * (0.5 + 0.5 * np.cos(time / 31)) + 0.3 * time / 20
    temperature = np.empty_like(duty)
    temperature[0] = duty[0]
    for n in range(1, len(duty)):
        temperature[n] = duty[n] + (temperature[n - 1] - duty[n]) * np.exp(-0.1 / 2)
    output = truth.simulate(temperature)
    model = pyhysteron.fit(duty, output, time=time, levels=8, thermal="first-order", bootstrap=0)
    # Eight levels for a material of twelve.
    assert model.thermal.tau_heating == pytest.approx(2, rel=0.2)
    modelled = model.simulate(duty, time=time)
    assert np.std(modelled - output) < 0.03 * np.ptp(output)
    # The inverse is tested behind the body: it gives temperatures.
    behind = model.evaluate(duty, output, time=time).inverse
    assert behind.anticipate.moving.rmse < 0.05 * np.ptp(temperature)
    with pytest.raises(pyhysteron.ThermalError, match="time"):
        model.simulate(duty)
    with pytest.raises(pyhysteron.ThermalError, match="which does not go back"):
        model.simulate(duty, time=time[::-1])
    chosen = pyhysteron.fit(duty, output, time=time, levels=5, smooth="auto", thermal="first-order", bootstrap=0)
    assert chosen.thermal is not None and chosen.fit.validation is not None


@pytest.mark.parametrize(
    "options, error, message",
    [
        ({"levels": 1}, ValueError, "2 to"),
        ({"levels": "many"}, TypeError, "'many'.*'auto'"),
        ({"levels": 10_000}, ValueError, "take fewer levels"),
        ({"range": (80, 20)}, ValueError, "range"),
        ({"range": (np.nan, 20)}, ValueError, "range"),
        ({"range": (500, 600)}, pyhysteron.FitError, "moves no operator"),
        ({"operator": "preisach"}, ValueError, "`operator` is 'preisach'.*'mkp', 'kp', 'relay'"),
        ({"solver": "lasso"}, ValueError, "`solver` is 'lasso'"),
        ({"smooth": -1.0}, pyhysteron.FitError, "smoothness -1"),
        ({"smooth": np.nan}, pyhysteron.FitError, "smoothness NaN"),
        ({"start": "warm"}, ValueError, "`start` is 'warm'"),
        ({"sign": 2}, ValueError, "`sign` is 2"),
        ({"offset": np.inf}, pyhysteron.FitError, "offset"),
        ({"bootstrap": 20_000}, pyhysteron.FitError, "10000"),
        ({"thermal": "second-order"}, ValueError, "`thermal` is 'second-order'"),
        ({"time": [0.0]}, TypeError, "own"),
    ],
)
def test_bad_options_are_named(recording, options, error, message):
    with pytest.raises(error, match=message):
        pyhysteron.fit(recording, **options)


def test_doubts_are_warnings(recording):
    with pytest.warns(pyhysteron.HysteronWarning, match="outside the active range.*widen `range`"):
        pyhysteron.fit(recording, levels=5, range=(40, 60), bootstrap=0)


def test_progress_is_told(recording):
    told = []
    pyhysteron.fit(recording, levels=20, bootstrap=1000, progress=lambda what, share: told.append((what, share)))
    assert told and all(isinstance(what, str) for what, _ in told)
    assert all(share is None or 0 <= share <= 1 for _, share in told)


def test_a_bar_from_tqdm(recording, capsys):
    pytest.importorskip("tqdm")
    pyhysteron.fit(recording, levels=20, bootstrap=1000, progress=True)
    assert "confidence" in capsys.readouterr().err
    assert pyhysteron.fit(recording, levels=5, bootstrap=0, progress=False).levels == 5


def test_an_error_in_the_callback_ends_the_fit(recording):
    def fail(what, share):
        raise LookupError(what)

    began = time.perf_counter()
    with pytest.raises(LookupError):
        pyhysteron.fit(recording, levels=40, bootstrap=10_000, progress=fail)
    assert time.perf_counter() - began < 10  # it would take minutes


def test_other_threads_go_on_during_a_fit(recording):
    counted = []
    done = threading.Event()

    def count():
        while not done.wait(0.002):
            counted.append(1)

    thread = threading.Thread(target=count)
    thread.start()
    pyhysteron.fit(recording, levels=20, bootstrap=2000)
    done.set()
    thread.join()
    assert len(counted) > 10


def test_left_out(recording):
    found = pyhysteron.left_out(recording, levels=10)
    assert found.predicted.shape == found.fold.shape == (len(recording),)
    assert set(found.fold) == set(range(5))
    error = found.predicted - recording.output
    rmse = 100 * np.sqrt(np.mean(error**2)) / np.ptp(recording.output)
    assert rmse == pytest.approx(found.nrmse_percent)
    assert found.nrmse_percent > found.training_nrmse_percent
    chosen = pyhysteron.left_out(recording, levels="auto", smooth=1e-6).chosen
    assert len(chosen) == 5 and all(smooth == (1e-6, 0) for _, smooth in chosen)


def test_what_does_not_run_by_its_input_alone(recording, swings):
    load = np.repeat([1.0, 2.0, 3.0], 1000)
    model = pyhysteron.fit(swings, load * recording.output, load=load, levels=5, bootstrap=0)
    for state in (model.start(), model.restore({"turning_points": [0.0], "input": 20.0})):
        with pytest.raises(pyhysteron.FitError, match="depends on the load `load`, from 1 to 3"):
            state.step(50.0)
    assert model.start().step(50.0, load=2.0) == model.simulate([50.0], load=2.0)[0]
    assert model.at_load(2.0).start().step(50.0) == model.at_load(2.0).simulate([50.0])[0]
    assert "under load" in repr(model)
    time = np.arange(len(swings)) * 0.1
    body = pyhysteron.fit((swings / 100) ** 2, recording.output, time=time, levels=5, thermal="first-order", bootstrap=0)
    state = body.start()
    state.step(0.3)  # at rest
    with pytest.raises(pyhysteron.ThermalError, match="needs the time of each sample"):
        state.step(0.3)


def session(truth, shrink, seed):
    t = np.linspace(0, 40, 1500)
    input = 50 - 30 * np.cos(t) * np.exp(-t / shrink)
    noise = 0.01 * np.random.default_rng(seed).normal(size=len(t))
    return pyhysteron.Recording(input, truth.simulate(input) + noise)


def test_repeats_widen_the_band_and_leave_the_weights(recording, truth):
    options = dict(levels=10, smooth=1e-8, start="off", bootstrap=20)
    one = pyhysteron.fit(recording, **options)
    other = session(truth, 30, 1)
    shifted = pyhysteron.Recording(other.input, other.output + 0.5)
    for repeats in (shifted, [shifted], [other, shifted]):
        wide = pyhysteron.fit(recording, repeats=repeats, **options)
        np.testing.assert_array_equal(one.weights, wide.weights)
        assert wide.confidence.noise > 5 * one.confidence.noise
        assert wide.evaluate(shifted, start="unknown").band.coverage_percent > 90
    assert one.evaluate(shifted, start="unknown").band.coverage_percent < 50
    for bad in (recording.input, 3, [recording, 3]):
        with pytest.raises(TypeError, match="(?s)`repeats` is .*Recording is needed"):
            pyhysteron.fit(recording, repeats=bad, **options)


def test_what_is_held_out_takes_no_part(recording, truth):
    options = dict(levels=8, bootstrap=0)
    assert pyhysteron.fit(recording, **options).fit.hold_out is None
    rows = len(recording)
    for what, samples in [
        ("branches:20%", range(100, rows // 2)),
        (f"rows:{rows - 499}-{rows}", [500]),
        (session(truth, 30, 1), [1500]),
        ([session(truth, 30, 1), session(truth, 20, 2)], [3000]),
        ([f"rows:{rows - 499}-{rows}", session(truth, 30, 1)], [2000]),
    ]:
        tested = pyhysteron.fit(recording, hold_out=what, **options).fit.hold_out
        assert tested.model.samples in samples
        assert [rival.name for rival in tested.rivals] == ["straight line", "interpolation"]
        assert all(rival.samples == tested.model.samples for rival in tested.rivals)
        assert tested.rivals[0].rmse > 3 * tested.model.rmse
    changed = recording.output.copy()
    changed[-500:] += 100
    what = f"rows:{rows - 499}-{rows}"
    one, other = (pyhysteron.fit(recording.input, output, hold_out=what, **options) for output in (recording.output, changed))
    np.testing.assert_array_equal(one.weights, other.weights)
    again = pyhysteron.Model.from_json(one.to_json())
    assert again.fit.hold_out == one.fit.hold_out


def test_a_rival_that_wins_where_data_were_held_out_is_a_warning():
    input = 50 - 30 * np.cos(np.linspace(0, 30, 600))
    line = input + 5 * np.random.default_rng(0).normal(size=600)
    with pytest.warns(pyhysteron.HysteronWarning, match="straight line errs"):
        pyhysteron.fit(input, line, levels=40, smooth=0.0, ridge=0.0, robust=False, bootstrap=0, hold_out="rows:401-600")


@pytest.mark.parametrize(
    "what, error, message",
    [
        ("branches:80%", pyhysteron.FitError, "up to 33 %"),
        ("branches:many", pyhysteron.FitError, "`branches:many`.*such as `branches:20%`"),
        ("rows:5", pyhysteron.FitError, "two row numbers"),
        ("rows:0-9", pyhysteron.FitError, "rows 0 to 9"),
        ("half", pyhysteron.FitError, "`half` cannot be held out"),
        (0.2, TypeError, "`hold_out` is 0.2"),
        ([], pyhysteron.FitError, "nothing was held out"),
        (["20%", "rows:1-9"], ValueError, "two parts"),
    ],
)
def test_what_cannot_be_held_out(recording, what, error, message):
    with pytest.raises(error, match=message):
        pyhysteron.fit(recording, levels=5, bootstrap=0, hold_out=what)

"""`Adaptive` and `adapt`."""

import copy
import pickle

import numpy as np
import pytest
from common import together

import pyhysteron

LEVELS = 8
METHODS = ["refit", "increments", "least-squares", "drift"]
TEMPERATURE = 50 - 40 * np.cos(0.05 * np.arange(2000)) * np.cos(0.003 * np.arange(2000))


def model(factor=1.0, sign=1, **names):
    weights = np.random.default_rng(1).uniform(0.2, 1.0, LEVELS * (LEVELS + 1) // 2)
    return pyhysteron.Model(factor * weights, (20, 80), offset=3.0, sign=sign, **names)


@pytest.fixture(params=[1, -1])
def sign(request):
    return request.param


@pytest.mark.parametrize("method", METHODS)
def test_the_prediction_gets_better(method, sign):
    measured = model(1.4, sign).simulate(TEMPERATURE)
    adaptive = pyhysteron.Adaptive(model(1.0, sign), method=method)
    errors = np.abs(adaptive.run(TEMPERATURE, measured)["error"])
    assert errors[1500:].mean() < 0.3 * errors[:200].mean()


@pytest.mark.parametrize("method", METHODS)
def test_run_is_step_after_step(method):
    measured = model(1.4).simulate(TEMPERATURE)
    one, other = (pyhysteron.Adaptive(model(), method=method) for _ in range(2))
    table = one.run(TEMPERATURE, measured)
    steps = [other.step(x, y) for x, y in zip(TEMPERATURE, measured, strict=True)]
    for name in ["output", "error", "outcome", "clipped"]:
        assert np.array_equal(table[name], [getattr(step, name) for step in steps])
    assert np.array_equal(one.weights, other.weights, equal_nan=True) and one.offset == other.offset
    assert set(table["outcome"]) >= {"learned"}


def test_a_step_says_what_it_did():
    adaptive = pyhysteron.Adaptive(model(), gate=0)  # which would wait for a second such reading
    learning = adaptive.step(100.0, 50.0)
    assert learning.output == model().output_range[1]
    assert learning.error == 50.0 - learning.output
    assert (learning.outcome, learning.clipped) == ("learned", 1)
    assert adaptive.step(100.0, 50.0).outcome == "at-rest"
    assert repr(learning).startswith("Learning(output=")
    with pytest.raises(AttributeError):
        learning.output = 1.0


def test_it_begins_as_its_model_is(sign):
    offline = model(1.0, sign, input="temperature [degC]", output="displacement [mm]")
    adaptive = pyhysteron.Adaptive(offline)
    assert np.array_equal(adaptive.weights, offline.weights, equal_nan=True)
    assert np.isnan(adaptive.weights[np.tril_indices(LEVELS, -1)]).all()
    assert adaptive.offset == offline.offset and adaptive.offline == offline
    assert adaptive.model().input == "temperature [degC]"
    expected = offline.simulate(TEMPERATURE)
    # The estimator's offset is added in another order.
    assert np.allclose([adaptive.simulate(x) for x in TEMPERATURE], expected, rtol=0, atol=1e-12)
    assert adaptive.output == pytest.approx(expected[-1], abs=1e-12)
    assert adaptive.input == TEMPERATURE[-1]
    state = offline.start()
    state.run(TEMPERATURE)
    assert np.array_equal(adaptive.turning_points, state.turning_points)
    started = pyhysteron.Adaptive(offline, start="on")
    assert started.output == pytest.approx(offline.output_range[1], abs=1e-12)


def test_the_inverse_is_that_of_the_weights_as_they_are(sign):
    adaptive = pyhysteron.Adaptive(model(1.0, sign), method="least-squares")
    adaptive.run(TEMPERATURE, model(1.4, sign).simulate(TEMPERATURE))
    now = adaptive.model()
    adaptive.reset()
    low, high = sorted(now.output_range)
    targets = np.linspace(low, high, 30)[1:-1]
    targets = np.concatenate([targets, targets[::-1]])
    headings = pyhysteron.control.headings(targets)
    inputs, status = zip(*(adaptive.solve(y, heading=h) for y, h in zip(targets, headings, strict=True)), strict=True)
    assert set(status) == {0}
    assert np.abs(now.simulate(inputs) - targets).max() < 1e-9
    assert adaptive.solve(high + 1)[1] == 1 and adaptive.solve(low - 1)[1] == -1


def test_solve_has_a_memory_of_its_own():
    adaptive = pyhysteron.Adaptive(model())
    adaptive.simulate(75.0)
    first, _ = adaptive.solve(8.0)
    assert adaptive.input == 75.0, "the measured input has moved"
    inverse, state = model().inverse(), model().start()
    assert first == pytest.approx(inverse.step(state, 8.0)[0], abs=1e-9)
    adaptive.align()
    heated = model().start()
    heated.step(75.0)
    assert adaptive.solve(8.0)[0] == pytest.approx(inverse.step(heated, 8.0)[0], abs=1e-9)


def test_guards():
    adaptive = pyhysteron.Adaptive(model())
    adaptive.freeze()
    measured = model(2.0).simulate(TEMPERATURE)
    assert set(adaptive.run(TEMPERATURE, measured)["outcome"]) <= {"frozen", "at-rest"}
    assert np.array_equal(adaptive.weights, model().weights, equal_nan=True)
    adaptive.freeze(False)
    adaptive.run(TEMPERATURE[:100], measured[:100])
    adaptive.keep()
    kept = adaptive.weights
    adaptive.run(TEMPERATURE[100:200], 0 * measured[100:200])
    assert not np.array_equal(adaptive.weights, kept, equal_nan=True)
    adaptive.roll_back()
    assert np.array_equal(adaptive.weights, kept, equal_nan=True)
    before = adaptive.offset
    adaptive.reset(on=True)
    assert adaptive.offset == before and adaptive.output == pytest.approx(adaptive.model().output_range[1])


def test_a_refit_has_the_last_samples(sign):
    measured = model(1.4, sign).simulate(TEMPERATURE)
    for window in ["cycles:2", "samples:300"]:
        adaptive = pyhysteron.Adaptive(model(1.0, sign), method="refit", window=window, every=10**6, ridge=1e-6)
        errors = adaptive.run(TEMPERATURE, measured)["error"]
        # Nothing is learned on the way; the offset is added in another order.
        left = measured - model(1.0, sign).simulate(TEMPERATURE)
        assert np.allclose(errors, left, rtol=0, atol=1e-12)
        adaptive.refit()
        # The plant is in the class of the model; the ridge is small.
        assert abs(adaptive.output - measured[-1]) < 1e-3


def test_copies_go_their_own_ways():
    one = pyhysteron.Adaptive(model())
    for other in [one.copy(), copy.copy(one), copy.deepcopy(one)]:
        other.step(80.0, 24.0)  # the top, where it does not matter how the operators began
        assert other.offset != one.offset and one.input != 80.0


def test_it_cannot_be_pickled_but_its_model_can():
    adaptive = pyhysteron.Adaptive(model())
    adaptive.step(70.0, 20.0)
    with pytest.raises(TypeError, match="cannot pickle"):
        pickle.dumps(adaptive)
    assert pickle.loads(pickle.dumps(adaptive.model())) == adaptive.model()


@pytest.mark.parametrize(
    ("options", "error", "text"),
    [
        ({"method": "gradient"}, pyhysteron.FitError, "take `increments`"),
        ({"method": "increments", "gain": 2.0}, pyhysteron.CoreError, "`gain` must be above 0 and below 2"),
        ({"method": "increments", "gain": float("nan")}, pyhysteron.CoreError, "`gain` must be"),
        ({"method": "increments", "span": 9}, pyhysteron.CoreError, "`span` must be from 1/8 to 8"),
        ({"method": "least-squares", "forgetting": 1.5}, pyhysteron.CoreError, "`forgetting` must be above 0 and up to 1"),
        ({"method": "least-squares", "noise": 0}, pyhysteron.CoreError, "`noise` must be above 0"),
        ({"method": "least-squares", "spread": -1}, pyhysteron.CoreError, "`spread` must be above 0"),
        ({"method": "least-squares", "correlation": -1}, pyhysteron.CoreError, "`correlation` must be a finite number from 0 on"),
        ({"method": "increments", "offset_share": -1}, pyhysteron.CoreError, "`offset_share` must be a finite number from 0 on"),
        ({"method": "increments", "dead_zone": -1}, pyhysteron.CoreError, "`dead_zone` must be"),
        ({"method": "increments", "leakage": 1.1}, pyhysteron.CoreError, "`leakage` must be from 0 to 1"),
        ({"movement": float("inf")}, pyhysteron.CoreError, "`movement` must be"),
        ({"method": "increments", "trial": 0}, pyhysteron.CoreError, "`trial` must be 1 or more"),
        ({"gate": 1}, pyhysteron.CoreError, "`gate` must be a finite number from 2 on, or 0"),
        ({"burst": 0}, pyhysteron.CoreError, "`burst` must be 1 or more"),
        ({"burst": -1}, ValueError, "`burst` is -1: a whole number"),
        ({"method": "increments", "trial": -1}, ValueError, "`trial` is -1: a whole number"),
        ({"method": "refit", "ridge": 0}, pyhysteron.FitError, "`ridge` must be above 0 and up to 1"),
        ({"method": "refit", "every": 0}, pyhysteron.FitError, "`every` must be 1 or more"),
        ({"window": "days:3"}, pyhysteron.FitError, "`window` is `days:3`: it must be cycles:1 to"),
        ({"window": 3}, TypeError, "`window` is 3: a text is needed"),
        ({"trial": 3}, pyhysteron.FitError, "`trial` is an option of"),
        ({"noise": 1.0}, pyhysteron.FitError, "`noise` is an option of"),
        ({"method": "newton"}, ValueError, "`method` is 'newton': one of 'auto', 'fixed'"),
        ({"start": "unknown"}, ValueError, "`start` is 'unknown': one of 'off', 'on'"),
        ({"gian": 0.3}, TypeError, "there is no argument `gian`"),
        ({"method": "increments", "gain": "much"}, TypeError, "`gain` is 'much': a number is needed"),
    ],
)
def test_options_that_are_refused(options, error, text):
    with pytest.raises(error) as raised:
        pyhysteron.Adaptive(model(), **options)
    assert text in str(raised.value)


def test_samples_that_are_refused():
    adaptive = pyhysteron.Adaptive(model())
    before = adaptive.copy()
    for bad in [np.nan, np.inf]:
        with pytest.raises(pyhysteron.CoreError, match="`measured`"):
            adaptive.step(50.0, bad)
        with pytest.raises(pyhysteron.CoreError, match="`input`"):
            adaptive.simulate(bad)
        with pytest.raises(pyhysteron.CoreError, match=r"`measured\[1\]`"):
            adaptive.run([1.0, 2.0], [1.0, bad])
        with pytest.raises(pyhysteron.CoreError, match="`target`"):
            adaptive.solve(bad)
    with pytest.raises(ValueError, match="`measured` has 1 samples, `input` 2"):
        adaptive.run([1.0, 2.0], [1.0])
    with pytest.raises(pyhysteron.CoreError):
        pyhysteron.Adaptive(pyhysteron.Model([1.0, -1.0, 1.0], (0, 1)))
    assert adaptive.input == before.input and adaptive.offset == before.offset
    assert len(adaptive.run([], [])["error"]) == 0


def test_threads_may_share_one():
    adaptive = pyhysteron.Adaptive(model(), method="increments", gain=0.1)
    measured = model(1.4).simulate(TEMPERATURE)

    def work(kind):
        for n, (x, y) in enumerate(zip(TEMPERATURE, measured, strict=True)):
            match (kind + n) % 5:
                case 0:
                    adaptive.step(x, y)
                case 1:
                    adaptive.solve(y)
                case 2:
                    adaptive.run(TEMPERATURE[:50], measured[:50])
                case 3:
                    assert np.isfinite(adaptive.model().offset)
                case 4:
                    adaptive.copy().simulate(x)

    together(work)
    assert np.nanmin(adaptive.weights) >= 0.0


@pytest.mark.parametrize("method", METHODS)
def test_adapt(method, sign):
    measured = model(1.4, sign).simulate(TEMPERATURE)
    adapted = pyhysteron.adapt(model(1.0, sign), TEMPERATURE, measured, method=method, time=np.arange(2000.0))
    last = adapted.comparison.thirds[-1]
    assert last.adapting.rmse < 0.3 * last.fixed.rmse
    table = adapted.table
    assert np.array_equal(table["input"], TEMPERATURE) and np.array_equal(table["output"], measured)
    assert np.array_equal(table["error"], measured - table["output_model"])
    whole = adapted.comparison.whole.adapting
    assert whole.rmse == pytest.approx(np.sqrt(np.mean(table["error"] ** 2)))
    counts = adapted.comparison.counts
    assert counts.learned == (table["outcome"] == "learned").sum() > 0
    again = adapted.model.simulate(TEMPERATURE) - measured
    assert adapted.comparison.again.rmse == pytest.approx(np.sqrt(np.mean(again**2)))
    assert adapted.model.fit.other["adapted"]["method"] == method
    assert adapted.comparison.drift.weights[1] > adapted.comparison.drift.weights[0]
    assert repr(adapted).startswith("<Adapted: RMSE")


def test_adapt_takes_what_numpy_takes():
    pandas = pytest.importorskip("pandas")
    measured = model(1.4).simulate(TEMPERATURE)
    frame = pandas.DataFrame({"T": TEMPERATURE, "y": measured}, index=np.arange(2000) + 7)
    found = pyhysteron.adapt(model(), frame["T"], frame["y"]).model
    assert found == pyhysteron.adapt(model(), pyhysteron.Recording(TEMPERATURE, measured)).model
    assert found == pyhysteron.adapt(model(), TEMPERATURE.tolist(), measured).model


@pytest.mark.parametrize(
    ("arguments", "options", "error", "text"),
    [
        (([1.0, 2.0], [1.0]), {}, pyhysteron.RecordingError, "1 samples, but 2 of the input"),
        (([], []), {}, pyhysteron.RecordingError, "no samples"),
        (([1.0, np.nan], [1.0, 2.0]), {}, pyhysteron.RecordingError, "sample 1"),
        (([1.0, 2.0], [1.0, 2.0]), {"time": [1.0, 0.0]}, pyhysteron.RecordingError, "goes back after sample 0"),
        (([1.0, 2.0], [[1.0], [2.0]]), {}, ValueError, "`output`: one dimension"),
        (([1j, 2.0], [1.0, 2.0]), {}, TypeError, "`input`: real numbers"),
        (([1.0, 2.0], [1.0, 2.0]), {"method": "increments", "gain": 3}, pyhysteron.CoreError, "`gain` must be above 0 and below 2"),
        (([1.0, 2.0], [1.0, 2.0]), {"load": 3.0}, pyhysteron.FitError, "`load`: this model does not depend on a load"),
        (([1.0, 2.0], [1.0, 2.0]), {"start": "hot"}, ValueError, "`start` is 'hot'"),
    ],
)
def test_what_adapt_refuses(arguments, options, error, text):
    with pytest.raises(error) as raised:
        pyhysteron.adapt(model(), *arguments, **options)
    assert text in str(raised.value)


class TestLoad:
    """A load that nobody measures."""

    def model(self, low=20.0):
        return pyhysteron.Model(np.full(15, 1.0), (low, low + 60))

    def follow(self, adaptive, shift, count=500):
        plant = self.model(20.0 + shift).start()
        for n in range(count):
            temperature = 55 - 45 * np.cos(0.05 * n)
            adaptive.step(temperature, plant.step(temperature))

    @pytest.mark.parametrize("shift", [-9.0, 0.0, 8.0])
    def test_the_shift_is_found(self, shift):
        adaptive = pyhysteron.AdaptiveLoad(self.model())
        before = adaptive.deviation
        self.follow(adaptive, shift)
        assert adaptive.shift == pytest.approx(shift, abs=0.1)
        # Where the model was right already, nothing was learned.
        assert adaptive.deviation == before if shift == 0 else adaptive.deviation < 0.2 * before
        assert adaptive.load is None and adaptive.offline == self.model()
        low, high = adaptive.model().range
        assert (low, high) == pytest.approx((20 + adaptive.shift, 80 + adaptive.shift))

    def test_a_copy_goes_its_own_way(self):
        adaptive = pyhysteron.AdaptiveLoad(self.model())
        other = copy.deepcopy(adaptive)
        self.follow(adaptive, 8.0)
        assert other.shift == 0 and adaptive.copy().shift == adaptive.shift

    def test_frozen_it_learns_nothing(self):
        adaptive = pyhysteron.AdaptiveLoad(self.model())
        adaptive.freeze()
        self.follow(adaptive, 8.0, 100)
        assert adaptive.shift == 0
        adaptive.freeze(False)
        self.follow(adaptive, 8.0)
        assert adaptive.shift == pytest.approx(8, abs=0.1)

    def test_what_it_does_not_use_is_refused(self):
        with pytest.raises(pyhysteron.FitError):
            pyhysteron.AdaptiveLoad(self.model(), gain=0.3)
        with pytest.raises(pyhysteron.FitError):
            pyhysteron.AdaptiveLoad(self.model(), load=100.0)
        with pytest.raises(TypeError):
            pyhysteron.AdaptiveLoad(self.model(), lode=100.0)
        with pytest.raises(ValueError, match="unknown"):
            pyhysteron.AdaptiveLoad(self.model(), start="unknown")

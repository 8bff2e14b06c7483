import numpy as np
import pytest

import pyhysteron


@pytest.fixture(scope="module")
def noisy(swings, truth):
    random = np.random.default_rng(3)
    input = swings + 0.05 * random.normal(size=len(swings))
    input[700] = 500.0
    output = truth.simulate(swings) + 0.02 * random.normal(size=len(swings))
    return pyhysteron.Recording(input, output, time=0.1 * np.arange(len(swings)))


def test_noise_and_spikes_go(noisy, swings):
    prepared, report = pyhysteron.prepare(noisy)
    assert report.spikes.input.first == (701,)
    # The spike is gone. Noise of 0.1 % of the range stays: no model gains by a filter.
    assert np.max(np.abs(prepared.input - swings)) < 6 * 0.05
    assert report.samples == len(prepared) == len(noisy)
    assert report.rate_dependent is False
    assert report.input_noise == pytest.approx(0.05, rel=0.2)


def test_each_step_can_be_set(noisy):
    off = dict.fromkeys(["spikes", "resample", "low_pass", "lag", "dead_band"], "off")
    untouched, report = pyhysteron.prepare(noisy, **off)
    assert untouched == noisy
    assert all(getattr(report, name) is None for name in ("spikes", "resampled", "low_pass", "lag", "dead_band"))
    one = lambda **step: pyhysteron.prepare(noisy, **{**off, **step})[1]
    assert one(spikes=6).spikes.deviations == 6
    assert one(resample=0.05).resampled == 0.05
    assert one(low_pass=1).low_pass.input.cutoff == 1
    assert one(lag=0.2).lag.undone == 0.2
    assert one(dead_band=0.3).dead_band.size == 0.3


@pytest.mark.parametrize(
    "step, error, message",
    [
        ({"spikes": -1}, pyhysteron.PreparationError, "spike"),
        ({"dead_band": "on"}, TypeError, "`dead_band` is 'on': 'auto', 'off' or a number"),
        ({"lag": [1]}, TypeError, "`lag`"),
        ({"low_pass": 1e9}, ValueError, "the cut-off is 1000000000 Hz"),
        ({"low_pass": np.nan}, pyhysteron.PreparationError, "cut-off"),
    ],
)
def test_bad_steps_are_named(noisy, step, error, message):
    with pytest.raises(error, match=message):
        pyhysteron.prepare(noisy, **step)


def test_without_time(swings):
    prepared, report = pyhysteron.prepare(swings, 0.5 * swings)
    assert report.rate is None and report.rate_dependent is None
    np.testing.assert_allclose(prepared.input, swings, atol=0.02 * np.ptp(swings))

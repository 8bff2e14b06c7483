"""Confidence, band, evaluation, excitation, and what `remembered` promises."""

import pickle

import numpy as np
import pytest

import pyhysteron


def test_confidence(model):
    found = model.confidence
    below = np.tril(np.ones((12, 12), bool), -1)
    for name in ("standard_error", "excitation"):
        assert getattr(found, name).shape == (12, 12)
        np.testing.assert_array_equal(np.isnan(getattr(found, name)), below)
    np.testing.assert_array_equal(found.levels, model.plane)
    assert found.noise == pytest.approx(0.01, rel=0.3)
    assert 0 < found.rank <= found.unknowns == 78
    again = pickle.loads(pickle.dumps(model))
    np.testing.assert_array_equal(again.confidence.standard_error, found.standard_error)
    assert pyhysteron.Model([1, 2, 4], (0, 1)).confidence is None


def test_band_holds_95_percent(model, recording):
    low, high = model.band(recording.input)
    inside = (low < recording.output) & (recording.output < high)
    assert 0.93 < inside.mean() <= 1
    np.testing.assert_allclose((low + high) / 2, model.simulate(recording.input), rtol=1e-12)
    with pytest.raises(pyhysteron.FitError, match="fit it again with `bootstrap=200`"):
        pyhysteron.Model([1, 2, 4], (0, 1)).band([0.5])


def test_evaluate(model, recording):
    found = model.evaluate(recording)
    np.testing.assert_array_equal(found.output_model, model.simulate(recording.input))
    error = found.output_model - recording.output
    assert found.forward.rmse == pytest.approx(np.sqrt(np.mean(error**2)))
    assert found.band.coverage_percent > 90
    assert found.band.lower.shape == error.shape
    inverse = found.inverse
    assert inverse.moving.dtype == bool
    for policy in ("hold", "anticipate"):
        missed = getattr(inverse, policy).input_model - recording.input
        assert getattr(inverse, policy).all.rmse == pytest.approx(np.sqrt(np.mean(missed**2)))
    assert model.evaluate(recording, start="on").band.coverage_percent > 90


def test_evaluate_says_why_there_is_no_inverse(recording):
    model = pyhysteron.Model([1.0, -2.0, 4.0], (30, 80))
    found = model.evaluate(recording)
    assert found.inverse is None and "not negative" in found.inverse_refused


def test_excitation(model, recording):
    one = model.excitation(recording)
    np.testing.assert_array_equal(one, model.excitation(recording.input))
    np.testing.assert_array_equal(one, pyhysteron.excitation(recording, model.range, 12))
    none = model.excitation(np.full(3, 10.0))
    assert np.nanmax(none) == 0
    both = model.excitation([recording, recording.input[:500]])
    assert (both[~np.isnan(both)] >= one[~np.isnan(one)]).all()


def test_model_summary(model):
    summary = model.summary()
    assert summary.levels == 12
    assert sum(summary.confidence.excitation.values()) == 78


@pytest.mark.parametrize("on", [False, True])
def test_what_is_remembered_leaves_the_same_state(truth, on):
    random = np.random.default_rng(1)
    for _ in range(200):
        input = random.uniform(15, 90, random.integers(1, 100))
        whole, short = truth.start(on=on), truth.start(on=on)
        whole.run(input)
        short.run(input[pyhysteron.remembered(input)])
        # Output and all outputs to come.
        for probe in (input[-1], 60, 40, 70, 30, 90, 0):
            assert whole.step(probe) == pytest.approx(short.step(probe), abs=1e-12)


def test_branches_are_numbered_from_turn_to_turn(swings):
    branch = pyhysteron.branches(swings)
    ends = np.flatnonzero(np.diff(branch))
    assert branch[0] == 0 and set(np.diff(branch)) == {0, 1}
    turns = np.flatnonzero(np.diff(np.sign(np.diff(swings)))) + 1
    # The last turn is within the band of noise.
    np.testing.assert_array_equal(ends, turns[:-1])
    with pytest.raises(ValueError, match="dead_band"):
        pyhysteron.branches(swings, dead_band=-1)

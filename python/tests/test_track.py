"""`track`: controllers compared on a simulated plant."""

import numpy as np
import pytest
from common import SCENARIO, SLOW_SCENARIO

import pyhysteron


@pytest.fixture(scope="module")
def comparison():
    return pyhysteron.track(SCENARIO)


def test_scores_are_a_table(comparison):
    scores = comparison.scores
    assert {len(column) for column in scores.values()} == {3 * 2 * 2}
    assert scores["controller"][:4] == ["pid"] * 4 and set(scores["seed"]) == {1, 2}
    trace = comparison.traces["inverse-pid"]
    window = (trace.time >= scores["from_s"][4]) & (trace.time < scores["to_s"][4])
    rmse = np.sqrt(np.mean((trace.output - trace.reference)[window] ** 2))
    assert rmse == pytest.approx(scores["rmse"][4])
    assert np.isnan(scores["prediction_rmse"][:4]).all(), "a PID predicts nothing"


def test_medians_and_ratios(comparison):
    first = comparison.medians[0]
    assert (first.controller, first.window) == ("PID", "first half")
    assert first.rmse == pytest.approx(np.median(comparison.scores["rmse"][[0, 2]]))
    assert first.prediction_rmse is None
    assert comparison.ratios[0].rmse < 1.0


def test_what_else_there_is(comparison, tmp_path):
    assert comparison.simulated is True and "simulated" in repr(comparison)
    assert comparison.title.startswith("A sine")
    assert comparison.controllers == list(comparison.traces) == ["pid", "inverse-pid", "adaptive-pid"]
    assert comparison.model.levels == 10 and comparison.inner_pid is None
    assert len(comparison.traces["adaptive-pid"].snapshots) > 10
    comparison.to_csv(tmp_path / "scores.csv")
    assert len((tmp_path / "scores.csv").read_text().splitlines()) == 13
    pid, inner = pyhysteron.control.tune(SCENARIO)
    assert inner is None and repr(pid) == repr(comparison.pid)


def test_each_controller_has_the_gains_of_its_model(comparison):
    assert comparison.tuned == {}
    by_model = pyhysteron.track(SCENARIO.replace("loop = {", "loop = { tuning = 'model',"), seeds=1)
    assert list(by_model.tuned) == ["pid", "inverse-pid", "adaptive-pid"] and by_model.pid is None
    pid, margin = by_model.tuned["inverse-pid"]
    assert pid.gain > 0 and pid.integral_s > 0 and margin >= 2


def test_a_file_is_its_text(comparison, tmp_path):
    (tmp_path / "sine.toml").write_text(SCENARIO)
    for path in [tmp_path / "sine.toml", str(tmp_path / "sine.toml")]:
        found = pyhysteron.track(path, seeds=1)
        assert np.array_equal(found.scores["rmse"], comparison.scores["rmse"].reshape(3, 2, 2)[:, 0].ravel())


def test_progress_is_told():
    told = []
    # It is told every 50 ms: this takes longer.
    pyhysteron.track(SLOW_SCENARIO, seeds=30, progress=lambda what, share: told.append((what, share)))
    assert told and {what for what, _ in told} == {"runs"}
    assert [share for _, share in told] == sorted(share for _, share in told)


def test_what_progress_raises_ends_it():
    def refuse(what, share):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        pyhysteron.track(SCENARIO, seeds=50, progress=refuse)


def test_built_in_scenarios():
    assert {"load-step", "sine"} <= set(pyhysteron.scenarios())
    assert pyhysteron.scenarios()["sine"].startswith("# ")


@pytest.mark.parametrize(
    ("scenario", "error", "text"),
    [
        ("nowhere", pyhysteron.ScenarioError, "no such built-in scenario: load-step"),
        (SCENARIO.replace("0.01", "-1"), pyhysteron.ScenarioError, "interval_s"),
        (SCENARIO + "colour = 3\n", pyhysteron.ScenarioError, "colour"),
        (3, TypeError, "`scenario` is 3: a name, a path or a text"),
    ],
)
def test_what_is_refused(scenario, error, text):
    for call in [pyhysteron.track, pyhysteron.control.tune]:
        with pytest.raises(error) as raised:
            call(scenario)
        assert text in str(raised.value)
    with pytest.raises(pyhysteron.ScenarioError):
        pyhysteron.track(SCENARIO, seeds=0)

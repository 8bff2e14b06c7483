"""Every vector in `vectors/`, with the tolerance that it names."""

import json
from pathlib import Path

import numpy as np
import pytest

import pyhysteron

FOLDER = Path(__file__).parents[2] / "vectors"
HEADINGS = {0: None, 1: "rising", -1: "falling"}


def vectors(kind):
    files = sorted(FOLDER.glob(f"{kind}-*.json"))
    assert files, f"no vectors of the kind {kind} in {FOLDER}"
    cases = []
    for file in files:
        vector = json.loads(file.read_text())
        assert vector["kind"] == kind and vector["version"] in (1, 2)
        model = pyhysteron.Model.from_json(json.dumps(vector["model"]))
        cases += [pytest.param(model, vector["tolerance"], run, id=f"{file.stem}: {run['name']}") for run in vector["runs"]]
    return cases


def near(found, expected, tolerance):
    found, expected = np.asarray(found), np.asarray(expected)
    assert found.shape == expected.shape
    assert np.all(np.abs(found - expected) <= tolerance)


def series(run):
    """Time and load as arguments for a whole series."""
    keywords = {"load": run["load"]} if "load" in run else {}
    return keywords | ({"time": np.cumsum(run["dt"])} if "dt" in run else {})


def samples(run):
    """Time step and load as arguments for each sample."""
    names = [name for name in ("dt", "load") if name in run]
    return [{name: run[name][n] for name in names} for n in range(len(run["input"]))]


def inverse_of(model, run):
    limits = tuple(run["drive_range"]) if "drive_range" in run else None
    return model.inverse(drive_range=limits, horizon=run.get("horizon", 0.0))


def saved_and_restored(model, state):
    return model.restore(state.save())


@pytest.mark.parametrize(("model", "tolerance", "run"), vectors("forward"))
class TestForward:
    def test_simulate(self, model, tolerance, run):
        near(model.simulate(run["input"], **series(run)), run["output"], tolerance["output"])

    def test_step(self, model, tolerance, run):
        state = model.start()
        steps = zip(run["input"], samples(run), strict=True)
        near([state.step(x, **around) for x, around in steps], run["output"], tolerance["output"])

    def test_restored_half_way(self, model, tolerance, run):
        half = len(run["input"]) // 2
        state = model.start()
        steps = list(zip(run["input"], samples(run), strict=True))
        first = [state.step(x, **around) for x, around in steps[:half]]
        state = saved_and_restored(model, state)
        rest = [state.step(x, **around) for x, around in steps[half:]]
        near([*first, *rest], run["output"], tolerance["output"])


@pytest.mark.parametrize(("model", "tolerance", "run"), vectors("inverse"))
class TestInverse:
    def test_step(self, model, tolerance, run):
        self.step_through(model, tolerance, run, lambda state: state)

    def test_restored_at_each_sample(self, model, tolerance, run):
        self.step_through(model, tolerance, run, lambda state: saved_and_restored(model, state))

    def step_through(self, model, tolerance, run, between):
        inverse, state, found = inverse_of(model, run), model.start(), []
        for target, heading, around in zip(run["target"], run["heading"], samples(run), strict=True):
            state = between(state)
            wanted = {"heading": HEADINGS[heading], "tolerance": run["tolerance"]}
            found.append(inverse.step(state, target, **wanted, **around))
        self.judge(model, tolerance, run, *zip(*found, strict=True))

    def test_run(self, model, tolerance, run):
        headings = [HEADINGS[heading] for heading in run["heading"]]
        wanted = {"heading": headings, "tolerance": run["tolerance"]}
        inputs, status = inverse_of(model, run).run(run["target"], **wanted, **series(run))
        self.judge(model, tolerance, run, inputs, status)

    def judge(self, model, tolerance, run, inputs, status):
        near(inputs, run["input"], tolerance["input"])
        assert list(status) == run["status"]
        reached = np.array(status) == 0
        wanted = np.array(run["target"])[reached]
        near(model.simulate(inputs, **series(run))[reached], wanted, tolerance["output"] + run["tolerance"])


def test_a_run_that_anticipates_is_its_steps():
    for case in vectors("inverse"):
        model, _, run = case.values
        if run["tolerance"] or "dt" in run or "load" in run:
            continue
        inverse, state = model.inverse(), model.start()
        headings = pyhysteron.control.headings(run["target"], 0.01)
        steps = [inverse.step(state, y, heading=h, tolerance=0.01) for y, h in zip(run["target"], headings, strict=True)]
        inputs, status = inverse.run(run["target"], policy="anticipate", tolerance=0.01)
        assert steps == list(zip(inputs, status, strict=True))

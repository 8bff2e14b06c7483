"""Signatures that are written by hand, where arguments are taken as they come, name the real arguments."""

import inspect

import numpy as np
import pytest

import hysteron

MODEL = hysteron.Model(np.ones(15), (20, 80))
SERIES = 50 - 30 * np.cos(np.linspace(0, 20, 200))
METHODS = {
    "gain": "gradient",
    "span": "increments",
    "correlation": "least-squares",
    **dict.fromkeys(["forgetting", "noise", "spread"], "drift"),
}


@pytest.mark.parametrize("call", [hysteron.Adaptive, hysteron.adapt])
def test_of_the_options_of_an_estimator(call):
    arguments = [MODEL] if call is hysteron.Adaptive else [MODEL, SERIES, 0.1 * SERIES]
    names = [p.name for p in inspect.signature(call).parameters.values() if p.kind is p.KEYWORD_ONLY]
    assert len(names) == (16 if call is hysteron.adapt else 14)
    for name in set(names) - {"method", "start", "time", "progress"}:
        method = METHODS.get(name, "gradient")
        call(*arguments, method=method, **{name: None})
        if name != "load":
            call(*arguments, method=method, **{name: 1})


@pytest.mark.parametrize("plant", [hysteron.SpringPlant, hysteron.PreisachPlant])
def test_of_the_options_of_a_plant(plant):
    parameters = inspect.signature(plant).parameters.values()
    plain = {p.name: p.default for p in parameters if p.default is not ...}
    reading = plant(**plain).read()
    assert reading == plant().read(), "a default is not as it says"
    for name in {p.name for p in parameters} - set(plain):
        plant(**{name: {}})


def test_of_a_disturbance():
    names = list(inspect.signature(hysteron.SimulatedPlant.disturb).parameters)[1:]
    assert len(names) == 5
    for name in names:
        hysteron.SpringPlant().disturb(**{name: None})

"""Signatures that are written by hand: they name the real arguments, and the defaults that they show are the real ones."""

import inspect

import numpy as np
import pytest

import pyhysteron
from pyhysteron.control import Pid

MODEL = pyhysteron.Model(np.ones(15), (20, 80))
#: From within the plane, so that the start counts.
SERIES = 50 - 30 * np.cos(np.linspace(1, 21, 200))
#: Of two loads, so that the order of the weights in the load counts.
OUTPUT, LOAD = np.sqrt(SERIES) * np.repeat([1.0, 1.1], 100), np.repeat([0.0, 1.0], 100)
RECORDING = pyhysteron.Recording(SERIES, np.sqrt(SERIES), time=np.arange(200.0) ** 1.1)  # not even
METHODS = {
    "gain": "increments",
    "span": "increments",
    "correlation": "least-squares",
    **dict.fromkeys(["forgetting", "noise", "spread"], "drift"),
    **dict.fromkeys(["window", "every", "ridge"], "refit"),
}


def driven(plant):
    """While the quick plant moves, and when the slow one is warm."""
    plant.write(0.8 * plant.drives[1])
    readings = []
    for seconds in (0.1, 30.0):
        plant.advance(seconds)
        readings.append(plant.read())
    return readings


RATES = {"heating_rate": 2.0, "cooling_rate": 0.5}
#: Written by a test's fixture.
FILE = "run.csv"
COLUMNS = {"input": "input", "output": "output"}


def commanded(**shown):
    loop = pyhysteron.control.Controller(0.1, (0, 100), **shown)
    return [loop.step(target, 0.5 * target, heading="rising").drive for target in (2.0, 9.0, 8.5, 1.0, 1.0)]


def disturbed(**shown):
    plant = pyhysteron.SpringPlant()
    plant.disturb(**shown)
    return driven(plant)


#: What tells one call from another.
DEFAULTS = {
    pyhysteron.Model: lambda **shown: pyhysteron.Model(np.ones(15), (20, 80), **shown),
    pyhysteron.Model.export_fmu: lambda **shown: MODEL.export_fmu("model.fmu", **shown),
    pyhysteron.Recording: lambda **shown: repr(pyhysteron.Recording(SERIES, OUTPUT, **{**shown, "load": LOAD})),
    pyhysteron.Model.evaluate: lambda **shown: MODEL.evaluate(RECORDING, **shown),
    pyhysteron.Recording.summary: lambda **shown: RECORDING.summary(**shown),
    pyhysteron.fit: lambda **shown: pyhysteron.fit(SERIES, OUTPUT, **{**shown, "load": LOAD}),
    pyhysteron.left_out: lambda **shown: pyhysteron.left_out(SERIES, OUTPUT, **{**shown, "load": LOAD}),
    pyhysteron.prepare: lambda **shown: pyhysteron.prepare(RECORDING, **shown),
    pyhysteron.adapt: lambda **shown: pyhysteron.adapt(MODEL, RECORDING, **shown).table,
    pyhysteron.Adaptive: lambda **shown: pyhysteron.Adaptive(MODEL, **shown).run(SERIES, OUTPUT),
    pyhysteron.Inverse.run: lambda **shown: MODEL.inverse().run(SERIES / 5, **shown),
    pyhysteron.design: lambda **shown: pyhysteron.design((20, 80), 5, **{**shown, **RATES}).input,
    pyhysteron.read: lambda **shown: pyhysteron.read(FILE, **{**shown, **COLUMNS}),
    pyhysteron.read_segments: lambda **shown: pyhysteron.read_segments(FILE, **{**shown, **COLUMNS}),
    pyhysteron.control.Controller: lambda **shown: commanded(**{**shown, "model": MODEL}),
    pyhysteron.SpringPlant: lambda **shown: driven(pyhysteron.SpringPlant(**shown)),
    pyhysteron.PreisachPlant: lambda **shown: driven(pyhysteron.PreisachPlant(**shown)),
    pyhysteron.LatentWirePlant: lambda **shown: driven(pyhysteron.LatentWirePlant(**shown)),
    pyhysteron.BoucWenPlant: lambda **shown: driven(pyhysteron.BoucWenPlant(**shown)),
    pyhysteron.SimulatedPlant.disturb: disturbed,
    Pid.step: lambda **shown: Pid(1.0, integral_s=1.0).step(1.0, 0.1, **shown),
}


def options(call):
    return [p for p in inspect.signature(call).parameters.values() if p.kind is p.KEYWORD_ONLY]


@pytest.mark.filterwarnings("ignore::pyhysteron.HysteronWarning")
@pytest.mark.parametrize("function", DEFAULTS, ids=lambda function: function.__qualname__)
def test_the_defaults_are_those_that_are_shown(function, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    RECORDING.to_csv(FILE)
    shown = {p.name: p.default for p in options(function) if p.default not in (..., p.empty)}
    assert shown
    np.testing.assert_equal(DEFAULTS[function](**shown), DEFAULTS[function]())


@pytest.mark.parametrize("call", [pyhysteron.Adaptive, pyhysteron.adapt])
def test_of_the_options_of_an_estimator(call):
    arguments = [MODEL] if call is pyhysteron.Adaptive else [MODEL, SERIES, 0.1 * SERIES]
    names = [option.name for option in options(call)]
    assert len(names) == (21 if call is pyhysteron.adapt else 19)
    for name in set(names) - {"method", "start", "time", "progress"}:
        method = METHODS.get(name, "increments")
        call(*arguments, method=method, **{name: None})
        if name != "load":
            call(*arguments, method=method, **{name: {"gate": 2, "window": "cycles:2"}.get(name, 1)})


@pytest.mark.parametrize("plant", [pyhysteron.SpringPlant, pyhysteron.PreisachPlant, pyhysteron.LatentWirePlant, pyhysteron.BoucWenPlant])
def test_of_the_options_of_a_plant(plant):
    names = [option.name for option in options(plant) if option.default is ...]
    assert names
    for name in names:
        plant(**{name: {}})

"""Ctrl-C ends whatever takes long, and leaves nothing running."""

import _thread
import os
import signal
import threading
import time

import numpy as np
import pytest
from common import SLOW_SCENARIO

import pyhysteron
from pyhysteron.control import Controller, Pid

SECONDS = 10  # none of these would be done in that time, were it not ended

MODEL = pyhysteron.Model(np.full(820, 0.01), (20, 80))
SWINGS = np.tile(50 - 40 * np.cos(np.linspace(0, 60, 5000)), 400)


def loop():
    return Controller(0.01, (0, 150), pid=Pid(0.2, integral_s=0.05))


LONG = {
    "fit": lambda recording: pyhysteron.fit(recording, levels=40, bootstrap=10_000),
    "left_out": lambda recording: pyhysteron.left_out(recording, levels="auto", smooth="auto"),
    "prepare": lambda recording: pyhysteron.prepare(SWINGS, SWINGS, time=1e-3 * np.arange(len(SWINGS)), lag="auto"),
    "adapt": lambda recording: pyhysteron.adapt(MODEL, SWINGS, 1.1 * MODEL.simulate(SWINGS), method="least-squares"),
    "Adaptive.run": lambda recording: pyhysteron.Adaptive(MODEL, method="least-squares").run(SWINGS, SWINGS),
    "track": lambda recording: pyhysteron.track(SLOW_SCENARIO, seeds=1000),
    "Controller.run": lambda recording: loop().run(pyhysteron.SpringPlant(), np.full(5_000_000, 10.0)),
    "advance": lambda recording: pyhysteron.SpringPlant().advance(1e308),
}


def tasks():
    return len(os.listdir("/proc/self/task")) if os.path.isdir("/proc/self/task") else 0


@pytest.fixture(autouse=True)
def disposition():
    """Python's own: where the run was started with `nohup` or `&`, Ctrl-C is ignored, and nothing would end."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("name", LONG)
@pytest.mark.parametrize("way", [lambda: signal.raise_signal(signal.SIGINT), _thread.interrupt_main], ids=["signal", "interrupt"])
def test_ctrl_c_ends(name, way, recording):
    pyhysteron.fit(recording, levels=5, bootstrap=10)  # so that the pool of threads is there
    before = tasks()
    timer = threading.Timer(0.5, way)
    timer.start()
    began = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        LONG[name](recording)
    assert time.monotonic() - began < SECONDS
    timer.join()
    # A thread that was joined stays in the list until the system has cleared it away.
    while tasks() > before and time.monotonic() - began < SECONDS:
        time.sleep(0.01)
    assert tasks() <= before

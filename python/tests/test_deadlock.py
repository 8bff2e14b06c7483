"""Nothing waits for ever: neither in a forked process, nor where Python's collector runs code in the middle of a call.

Each call is made in a process of its own, since nothing but its end would end a wait for ever.
"""

import gc
import multiprocessing
import os
import signal
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pytest

import pyhysteron
from pyhysteron.control import Controller, Pid

SECONDS = 60  # the slowest of it takes a few

INPUT = 50 + 30 * np.sin(np.linspace(0, 20, 200))
#: With as many the linear algebra is shared between threads, with few it is not.
LEVELS = 40


def ends(work, name):
    """Does `work(name)` in another process, and fails where that fails or takes too long."""
    process = multiprocessing.get_context("spawn").Process(target=work, args=(name,))
    process.start()
    process.join(SECONDS)
    if process.is_alive():
        process.kill()
        pytest.fail(f"{name} waits for ever")
    assert process.exitcode == 0, f"{name} has failed, see its traceback"


def fitted():
    return pyhysteron.fit(INPUT, 0.5 * INPUT, levels=LEVELS, bootstrap=5)


FORKED = {
    "fit": fitted,
    "the choice of levels": lambda: pyhysteron.fit(INPUT, 0.5 * INPUT, levels="auto", bootstrap=0),
    "excitation": lambda: pyhysteron.excitation(INPUT, (20, 80), LEVELS),
    "Model.excitation": lambda: fitted().excitation(INPUT),
    "Model.evaluate": lambda: fitted().evaluate(INPUT, 0.5 * INPUT, start="unknown"),
    "Model.band": lambda: fitted().band(INPUT),
    "Model.bounds": lambda: fitted().bounds(INPUT),
    "design": lambda: pyhysteron.design((20, 80), LEVELS, heating_rate=1, cooling_rate=1),
}


def fork(name):
    fitted()  # so that there are threads, which a fork does not copy
    # A fork that hangs ends before the process that waits for it.
    early = dict(initializer=signal.alarm, initargs=(SECONDS // 2,))
    with ProcessPoolExecutor(1, multiprocessing.get_context("fork"), **early) as pool:
        pool.submit(in_fork, name).result()
    FORKED[name]()


def in_fork(name):
    FORKED[name]()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
@pytest.mark.parametrize("name", FORKED)
def test_in_a_forked_process(name):
    ends(fork, name)


MODEL = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
INVERSE, STATE = MODEL.inverse(), MODEL.start()
STRANGE = pyhysteron.Model(np.ones(6), (0, 1)).start()  # of another model
BATCH = pyhysteron.BatchModel(MODEL, 2)
ADAPTIVE, PID = pyhysteron.Adaptive(MODEL), Pid(1.0, integral_s=1.0)
CONTROLLER = Controller(0.1, (0, 1), model=MODEL, pid=PID)
PLANT = pyhysteron.PreisachPlant(levels=60)
#: For each a call that returns, and one that fails: inside, where there is an error that is found there.
COLLECTED = {
    "State.step": (lambda: STATE.step(0.5), lambda: STATE.step(np.nan)),
    "State.run": (lambda: STATE.run([0.5, 1.0]), lambda: STATE.run([0.5, np.nan])),
    "BatchModel.run": (lambda: BATCH.run([[0.5], [1.0]]), lambda: BATCH.run([[0.5], [np.nan]])),
    "BatchModel.step": (lambda: BATCH.step([0.5, 1.0]), lambda: BATCH.step([0.5, np.nan])),
    "Inverse.step": (lambda: INVERSE.step(STATE, 6.0), lambda: INVERSE.step(STRANGE, 6.0)),
    "Inverse.run": (lambda: INVERSE.run([6.0], state=STATE), lambda: INVERSE.run([6.0], state=STRANGE)),
    "Adaptive.step": (lambda: ADAPTIVE.step(0.5, 3.0), lambda: ADAPTIVE.step(0.5, np.nan)),
    "Adaptive.run": (lambda: ADAPTIVE.run([0.5], [3.0]), lambda: ADAPTIVE.run([0.5], [np.nan])),
    "Controller.step": (lambda: CONTROLLER.step(3.0, 2.0), lambda: CONTROLLER.step(np.nan, 2.0)),
    "Controller.run": (lambda: CONTROLLER.run(PLANT, [3.0]), lambda: CONTROLLER.run(PLANT, [np.nan])),
    "SimulatedPlant.disturb": (lambda: PLANT.disturb(load_n=3.0), lambda: PLANT.disturb(room_degc=3.0)),
    "Pid.step": (lambda: PID.step(1.0, 0.1), lambda: PID.step(np.nan, 0.1)),
}


def look():
    """Uses all that the calls work with."""
    return STATE.input, STRANGE.input, BATCH.states, ADAPTIVE.input, CONTROLLER.interval_s, PLANT.truth(), PID.hold()


def made(error, *text):
    """An error is an object of Python's, so that the collector may run while it is made. Here it always does."""
    gc.collect()


def collect(name):
    returns, fails = COLLECTED[name]
    looked = []
    gc.callbacks.append(lambda *_: looked.append(look()))
    pyhysteron.HysteronError.__init__ = made
    gc.set_threshold(1)
    returns()
    looked.clear()
    with pytest.raises(pyhysteron.HysteronError):
        fails()
    assert looked


@pytest.mark.parametrize("name", COLLECTED)
def test_where_the_collector_uses_the_same(name):
    ends(collect, name)

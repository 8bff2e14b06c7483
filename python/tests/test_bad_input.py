"""Whatever is handed over: an exception that says what is wrong, or the right answer."""

import threading

import numpy as np
import pytest

import hysteron

MODEL = hysteron.Model([1.0, 2.0, 4.0], (0, 1))
CALLS = {
    "simulate": lambda x: MODEL.simulate(x),
    "band": lambda x: MODEL.band(x),
    "run": lambda x: MODEL.start().run(x),
    "inverse": lambda x: MODEL.inverse().run(x),
    "recording": lambda x: hysteron.Recording(x, [0.0, 1.0, 0.5]),
    "output": lambda x: hysteron.Recording([0.0, 1.0, 0.5], x),
    "time": lambda x: hysteron.Recording([0.0, 1.0, 0.5], [0.0, 1.0, 0.5], time=x),
    "load": lambda x: hysteron.Recording([0.0, 1.0, 0.5], [0.0, 1.0, 0.5], load=x),
    "fit": lambda x: hysteron.fit(x, [0.0, 1.0, 0.5], levels=2),
    "left_out": lambda x: hysteron.left_out(x, [0.0, 1.0, 0.5], levels=2),
    "prepare": lambda x: hysteron.prepare(x, [0.0, 1.0, 0.5]),
    "evaluate": lambda x: MODEL.evaluate(x, [0.0, 1.0, 0.5]),
    "excitation": lambda x: MODEL.excitation(x),
    "recorded": lambda x: hysteron.design((0, 1), 2, heating_rate=1, cooling_rate=1, recorded=x),
    "branches": lambda x: hysteron.branches(x),
    "remembered": lambda x: hysteron.remembered(x),
}
BAD = {
    "NaN": np.array([0.0, np.nan, 0.5]),
    "infinite": np.array([0.0, np.inf, 0.5]),
    "None": None,
    "a number": 1.0,
    "a text": "0.5",
    "texts": ["0", "1", "0.5"],
    "complex": np.array([0, 1j, 0.5]),
    "two dimensions": np.zeros((3, 2)),
    "no dimension": np.array(0.5),
    "objects": np.array([object(), 1, 2]),
    "objects with None": np.array([None, 1.0, 2.0], dtype=object),
    "booleans": np.array([True, False, True]),
    "dates": np.array(["2020-01-01"] * 3, dtype="datetime64[s]"),
    "records": np.zeros(3, dtype=[("a", float)]),
    "masked": np.ma.masked_array([0.0, 1.0, 0.5], [False, True, False]),
    "masked integers": np.ma.masked_array([0, 1, 0], [False, True, False]),
    "ragged": [[1.0], [2.0, 3.0], 1.0],
    "a dict": {"a": 1.0},
}


@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize("what", BAD)
def test_refused(call, what):
    if what == "None" and call in ("time", "load", "recorded"):
        return  # there need not be any
    with pytest.raises((ValueError, TypeError)) as error:
        CALLS[call](BAD[what])
    assert not isinstance(error.value, UnicodeError) and str(error.value)


@pytest.mark.parametrize("call", ["recording", "output", "time", "load", "fit", "prepare", "evaluate"])
@pytest.mark.parametrize("values", [[], [0.0, 1.0], np.zeros(4)])
def test_another_length_is_refused(call, values):
    with pytest.raises(hysteron.HysteronError) as error:
        CALLS[call](values)
    assert "samples" in str(error.value)


def test_nothing_in_nothing_out():
    assert MODEL.simulate([]).shape == (0,)
    assert [part.shape for part in MODEL.inverse().run([])] == [(0,), (0,)]
    assert hysteron.branches([]).shape == hysteron.remembered([]).shape == (0,)


SAMPLES = np.array([0.0, 1.0, 0.5, 0.75, 0.25])


def same(name):
    pandas = pytest.importorskip("pandas") if name == "series" else None
    frozen = SAMPLES.copy()
    frozen.flags.writeable = False
    return {
        "list": lambda: SAMPLES.tolist(),
        "tuple": lambda: tuple(SAMPLES),
        "float32": lambda: SAMPLES.astype(np.float32),
        "float16": lambda: SAMPLES.astype(np.float16),
        "long double": lambda: SAMPLES.astype(np.longdouble),
        "other byte order": lambda: SAMPLES.astype(SAMPLES.dtype.newbyteorder()),
        "objects": lambda: SAMPLES.astype(object),
        "read-only": lambda: frozen,
        "strided": lambda: np.repeat(SAMPLES, 2)[::2],
        "backwards": lambda: SAMPLES[::-1].copy()[::-1],
        "a column": lambda: np.asfortranarray(np.stack([SAMPLES] * 2))[0],
        "broadcast": lambda: np.broadcast_to(SAMPLES, (2, 5))[1],
        "not aligned": lambda: np.frombuffer(b"-" + SAMPLES.tobytes(), np.float64, offset=1),
        "nothing masked": lambda: np.ma.masked_array(SAMPLES),
        "a subclass": lambda: SAMPLES.view(np.recarray),
        "series": lambda: pandas.Series(SAMPLES, index=[5, 4, 3, 2, 1]),
    }[name]()


@pytest.mark.parametrize(
    "name",
    "list,tuple,float32,float16,long double,other byte order,objects,read-only,strided,backwards,a column,broadcast,"
    "not aligned,nothing masked,a subclass,series".split(","),
)
def test_the_same_samples_give_the_same(name):
    samples = same(name)
    np.testing.assert_array_equal(MODEL.simulate(samples), MODEL.simulate(SAMPLES))
    np.testing.assert_array_equal(hysteron.Recording(samples, samples).output, SAMPLES)
    assert MODEL.excitation(samples).shape == (2, 2)


def test_integers():
    integers = np.array([0, 1, 0], dtype=np.int8)
    np.testing.assert_array_equal(MODEL.simulate(integers), MODEL.simulate([0.0, 1.0, 0.0]))


def test_messages_name_argument_index_and_value():
    with pytest.raises(hysteron.CoreError, match=r"`input`\[1\] is NaN"):
        MODEL.simulate([0, np.nan])
    with pytest.raises(hysteron.RecordingError, match="column `lift`: sample 1 .from 0. is inf"):
        hysteron.Recording([0, 1], [0, np.inf], output_name="lift [mm]")
    with pytest.raises(hysteron.RecordingError, match="column `output`: 1 samples, but 2 of the input"):
        hysteron.Recording([0, 1], [0])
    with pytest.raises(hysteron.RecordingError, match="`time`: goes back after sample 0"):
        hysteron.Recording([0, 1], [0, 1], time=[1, 0])
    with pytest.raises(TypeError, match="`time`: real numbers are needed, not datetime64"):
        hysteron.Recording([0, 1], [0, 1], time=np.zeros(2, "datetime64[s]"))


def test_threads_share_a_state():
    state = MODEL.start()
    errors = []

    def work(seed):
        values = np.random.default_rng(seed).random(200)
        try:
            for _ in range(50):
                state.run(values)
                state.step(values[0])
                MODEL.restore(state.save())
                state.turning_points, state.copy().reset()
        except Exception as error:
            errors.append(error)

    threads = [threading.Thread(target=work, args=(n,)) for n in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert errors == []
    assert state.step(1) == 7.0

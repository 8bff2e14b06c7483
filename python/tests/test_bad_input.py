"""Whatever is handed over: an exception that says what is wrong, or the right answer."""

import errno
import pickle

import numpy as np
import pytest
from common import together

import pyhysteron

MODEL = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
CALLS = {
    "simulate": lambda x: MODEL.simulate(x),
    "band": lambda x: MODEL.band(x),
    "run": lambda x: MODEL.start().run(x),
    "inverse": lambda x: MODEL.inverse().run(x),
    "recording": lambda x: pyhysteron.Recording(x, [0.0, 1.0, 0.5]),
    "output": lambda x: pyhysteron.Recording([0.0, 1.0, 0.5], x),
    "time": lambda x: pyhysteron.Recording([0.0, 1.0, 0.5], [0.0, 1.0, 0.5], time=x),
    "load": lambda x: pyhysteron.Recording([0.0, 1.0, 0.5], [0.0, 1.0, 0.5], load=x),
    "fit": lambda x: pyhysteron.fit(x, [0.0, 1.0, 0.5], levels=2),
    "left_out": lambda x: pyhysteron.left_out(x, [0.0, 1.0, 0.5], levels=2),
    "prepare": lambda x: pyhysteron.prepare(x, [0.0, 1.0, 0.5]),
    "evaluate": lambda x: MODEL.evaluate(x, [0.0, 1.0, 0.5]),
    "excitation": lambda x: MODEL.excitation(x),
    "recorded": lambda x: pyhysteron.design((0, 1), 2, heating_rate=1, cooling_rate=1, recorded=x),
    "branches": lambda x: pyhysteron.branches(x),
    "remembered": lambda x: pyhysteron.remembered(x),
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
    if what == "dates" and call == "time":
        return  # they are taken: test_times.py
    with pytest.raises((ValueError, TypeError)) as error:
        CALLS[call](BAD[what])
    assert not isinstance(error.value, UnicodeError) and str(error.value)


@pytest.mark.parametrize("call", ["recording", "output", "time", "load", "fit", "prepare", "evaluate"])
@pytest.mark.parametrize("values", [[], [0.0, 1.0], np.zeros(4)])
def test_another_length_is_refused(call, values):
    with pytest.raises(pyhysteron.HysteronError) as error:
        CALLS[call](values)
    assert "samples" in str(error.value)


def test_nothing_in_nothing_out():
    assert MODEL.simulate([]).shape == (0,)
    assert [part.shape for part in MODEL.inverse().run([])] == [(0,), (0,)]
    assert pyhysteron.branches([]).shape == pyhysteron.remembered([]).shape == (0,)


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
    np.testing.assert_array_equal(pyhysteron.Recording(samples, samples).output, SAMPLES)
    assert MODEL.excitation(samples).shape == (2, 2)


def test_integers():
    integers = np.array([0, 1, 0], dtype=np.int8)
    np.testing.assert_array_equal(MODEL.simulate(integers), MODEL.simulate([0.0, 1.0, 0.0]))


def test_messages_name_argument_index_and_value():
    with pytest.raises(pyhysteron.CoreError, match=r"`input\[1\]` is NaN"):
        MODEL.simulate([0, np.nan])
    with pytest.raises(pyhysteron.RecordingError, match="column `lift`: sample 1 .from 0. is inf"):
        pyhysteron.Recording([0, 1], [0, np.inf], output_name="lift [mm]")
    with pytest.raises(pyhysteron.RecordingError, match="column `output`: 1 samples, but 2 of the input"):
        pyhysteron.Recording([0, 1], [0])
    with pytest.raises(pyhysteron.RecordingError, match="`time`: goes back after sample 0"):
        pyhysteron.Recording([0, 1], [0, 1], time=[1, 0])
    with pytest.raises(TypeError, match="`input`: real numbers are needed, not datetime64.*go to `time`"):
        pyhysteron.Recording(np.zeros(2, "datetime64[s]"), [0, 1])


RECORDING = pyhysteron.Recording([0.0, 1.0, 0.5], [0.0, 1.0, 0.5])
WHOLE = {
    "levels": lambda n: pyhysteron.fit(RECORDING, levels=n),
    "load_degree": lambda n: pyhysteron.fit(RECORDING, levels=2, load_degree=n),
    "bootstrap": lambda n: pyhysteron.fit(RECORDING, levels=2, bootstrap=n),
    "sign": lambda n: pyhysteron.Model([1.0, 2.0, 4.0], (0, 1), sign=n),
    "trial": lambda n: pyhysteron.Adaptive(MODEL, method="increments", trial=n),
    "burst": lambda n: pyhysteron.Adaptive(MODEL, burst=n),
    "seeds": lambda n: pyhysteron.track("sine", seeds=n),
    "begin": lambda n: pyhysteron.control.Pid.from_step([0.0, 1.0], n, 1.0, 0.1),
    "fmi": lambda n: MODEL.export_fmu("never.fmu", fmi=n),
    **{
        f"levels of {of}": call
        for of, call in {
            "a design": lambda n: pyhysteron.design((0, 1), n, heating_rate=1, cooling_rate=1),
            "an excitation": lambda n: pyhysteron.excitation([0.0, 1.0], (0, 1), n),
            "a summary": lambda n: RECORDING.summary(levels=n),
        }.items()
    },
}


@pytest.mark.parametrize("name", WHOLE)
def test_a_number_that_is_no_count_is_refused_by_name(name):
    argument = name.split()[0]
    for number in [-7, -(10**30), 10**30]:
        with pytest.raises(ValueError, match=f"`{argument}` is {number}"):
            WHOLE[name](number)
    with pytest.raises(ValueError, match=f"`{argument}` is "):
        WHOLE[name](10**10_000)
    for other in [2.5, "2", [2]]:
        with pytest.raises(TypeError, match=f"`{argument}` is .*: a .*number"):
            WHOLE[name](other)


@pytest.mark.parametrize(
    "call, error, text",
    [
        (lambda: pyhysteron.SpringPlant().advance(np.nan), ValueError, "`dt_s` is NaN"),
        (lambda: pyhysteron.SpringPlant().advance(-1), ValueError, "`dt_s` is -1"),
        (lambda: pyhysteron.PreisachPlant().write(np.nan), pyhysteron.CoreError, "`drive` is NaN"),
        (lambda: pyhysteron.SpringPlant(fatigue=[]), TypeError, "`fatigue` is []: a dictionary"),
        (lambda: pyhysteron.PreisachPlant(output_sensor=(1, 2)), TypeError, "`output_sensor` is (1, 2)"),
        (lambda: pyhysteron.control.Pid(1.0).step(np.nan, 0.1), pyhysteron.CoreError, "`error` is NaN"),
        (lambda: pyhysteron.control.Pid(1.0).hold(bias=np.inf), pyhysteron.CoreError, "`bias` is inf"),
        (lambda: MODEL.restore(np.ones(3)), TypeError, "`saved`: a dictionary"),
        (lambda: MODEL.restore({}), TypeError, "`saved`: a dictionary"),
        (lambda: pyhysteron.fit(RECORDING, progress=3), TypeError, "`progress` is 3"),
        (lambda: pyhysteron.Recording.from_frame([1, 2], input="a", output="b"), TypeError, "`frame` of"),
        (lambda: pyhysteron.Recording.from_frame({"a": [1]}, input="a", output="b"), KeyError, "b"),
        (lambda: MODEL.excitation([[0.0, 1.0], [0.0, np.nan]]), pyhysteron.CoreError, "`input[1][1]` is NaN"),
    ],
)
def test_what_is_refused(call, error, text):
    with pytest.raises(error) as raised:
        call()
    assert text in str(raised.value)


def test_a_missing_file_is_what_python_knows_as_one(tmp_path):
    path = tmp_path / "nowhere.json"
    with pytest.raises(FileNotFoundError) as raised:
        pyhysteron.Model.load(path)
    assert isinstance(raised.value, pyhysteron.FileError) and raised.value.code == 20
    assert (raised.value.errno, raised.value.filename) == (errno.ENOENT, str(path))
    with pytest.raises(pyhysteron.FileError) as raised:
        pyhysteron.Model.load(tmp_path)
    assert raised.value.errno == errno.EISDIR


def test_results_pickle():
    state = MODEL.start()
    state.run([0.9, 0.3, 0.6])
    same = pickle.loads(pickle.dumps(state))
    assert same.save()["input"] == 0.6 and np.array_equal(same.turning_points, state.turning_points)
    assert pickle.loads(pickle.dumps(MODEL.inverse())).model == MODEL
    learning = pyhysteron.Adaptive(MODEL).step(0.5, 3.0)
    assert repr(pickle.loads(pickle.dumps(learning))) == repr(learning)
    input = np.linspace(0, 1, 50)
    adapted = pyhysteron.adapt(MODEL, input, MODEL.simulate(input))
    again = pickle.loads(pickle.dumps(adapted))
    assert again.model == adapted.model and repr(again) == repr(adapted)


def test_operators_are_those_of_the_definition():
    state = MODEL.start()
    state.run([0.5, 1.0, 0.5])
    np.testing.assert_array_equal(state.operators, [[1.0, 1.0], [np.nan, 0.5]])
    state.reset(on=True)
    np.testing.assert_array_equal(state.operators, [[1.0, 1.0], [np.nan, 1.0]])


def test_threads_share_a_state():
    state = MODEL.start()

    def work(seed):
        values = np.random.default_rng(seed).random(200)
        for _ in range(50):
            state.run(values)
            state.step(values[0])
            MODEL.restore(state.save())
            state.turning_points, state.copy().reset()

    together(work)
    assert state.step(1) == 7.0

import copy
import pickle
import warnings

import numpy as np
import pytest

import pyhysteron


def test_series_names_and_length(recording, swings):
    assert len(recording) == 3000
    np.testing.assert_array_equal(recording.input, swings)
    assert recording.load is None
    assert recording.time.dtype == np.float64
    assert recording.input_name == "temperature [degC]"
    assert not recording.simulated
    assert recording.path is None


def test_what_it_gives_is_a_copy(recording):
    recording.input[0] = 1e9
    assert recording.input[0] != 1e9


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, lambda r: pickle.loads(pickle.dumps(r))])
def test_copies_and_pickles(recording, again):
    assert again(recording) == recording
    loaded = pyhysteron.Recording([1, 2], [3, 4], load=[5, 6], load_name="force [N]", simulated=True)
    assert again(loaded) == loaded
    assert again(loaded) != recording


def test_csv_there_and_back(recording, tmp_path):
    path = tmp_path / "run.csv"
    recording.to_csv(path)
    back = pyhysteron.read(path, input="temperature [degC]", output="lift [mm]", time="time [s]")
    np.testing.assert_array_equal(back.output, recording.output)
    np.testing.assert_array_equal(back.time, recording.time)
    assert back.path == path
    named = pyhysteron.read(path, input="temperature [degC]", output="lift [mm]", output_name="strain [%]")
    assert named.output_name == "strain [%]" and named.input_name == "temperature [degC]"


def test_parquet_and_mat(tmp_path):
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    io = pytest.importorskip("scipy.io")
    frame = pandas.DataFrame({"T": [20.0, 80.0, 50.0], "y": [0.0, 14.0, 11.0]})
    frame.to_parquet(tmp_path / "run.parquet")
    io.savemat(tmp_path / "run.mat", {name: frame[name].to_numpy() for name in frame})
    for file in ("run.parquet", "run.mat"):
        recording = pyhysteron.read(tmp_path / file, input="T", output="y")
        np.testing.assert_array_equal(recording.output, frame["y"])


def test_rows_are_mended_only_when_asked_and_said(tmp_path):
    path = tmp_path / "run.csv"
    path.write_text("T,y\n20,0\n,1\n80,14\n")
    with pytest.raises(pyhysteron.RecordingError, match="line 3, column `T`"):
        pyhysteron.read(path, input="T", output="y")
    with pytest.warns(pyhysteron.HysteronWarning, match="line 3 without a number: dropped"):
        recording = pyhysteron.read(path, input="T", output="y", repair=True)
    assert len(recording) == 2


def test_from_frame():
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame({"t": [0, 1], "T [K]": np.float32([1.5, 2]), "y": [3, 4], "F": [5, 6]}, index=[7, 3])
    recording = pyhysteron.Recording.from_frame(frame, input="T [K]", output="y", time="t", load="F")
    assert recording == pyhysteron.Recording(
        [1.5, 2], [3, 4], time=[0, 1], load=[5, 6], input_name="T [K]", output_name="y", load_name="F"
    )
    with pytest.raises(KeyError, match="missing"):
        pyhysteron.Recording.from_frame(frame, input="missing", output="y")


def test_summary(recording):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        summary = recording.summary(levels=10)
    assert summary.samples == 3000
    assert summary.operators == 55
    assert summary.input.unit == "degC"
    assert summary.time.gaps == 0


@pytest.mark.parametrize("name", ["run--two.csv", "run --old/m.csv", "--start unknown.csv", "`--repair`.csv"])
def test_the_path_in_a_message_is_the_path(tmp_path, name):
    path = tmp_path / name
    with pytest.raises(pyhysteron.FileError) as raised:
        pyhysteron.read(path, input="T", output="y")
    assert str(path) in str(raised.value)
    path.parent.mkdir(exist_ok=True)
    path.write_text("T,y\n20,0\n,1\n")
    with pytest.raises(pyhysteron.RecordingError) as raised:
        pyhysteron.read(path, input="T", output="y")
    assert f"recording {path}, line 3" in str(raised.value)
    assert str(raised.value).endswith("or use `repair=True`")
    with pytest.warns(pyhysteron.HysteronWarning) as warned:
        pyhysteron.read(path, input="T", output="y", repair=True)
    assert str(warned[0].message).startswith(f"{path}: ")


def test_segments_are_recordings_of_one_experiment(tmp_path):
    path = tmp_path / "run.csv"
    rows = [(n, 50 - 30 * np.cos(0.05 * n)) for n in range(300)]
    again = [(n, 45 - 25 * np.cos(0.05 * n)) for n in range(200)]
    columns = {"input": "x", "output": "y", "time": "t"}

    def write(rows):
        path.write_text("t,x,y\n" + "".join(f"{t},{x},{0.2 * x}\n" for t, x in rows))

    write(rows + rows[:200])
    with pytest.warns(pyhysteron.HysteronWarning, match="197 more standing there before: dropped"):
        parts = pyhysteron.read_segments(path, **columns, repair=True)
    assert [len(part) for part in parts] == [300]
    write(rows + again)
    with pytest.raises(pyhysteron.RecordingError, match="line 302"):
        pyhysteron.read_segments(path, **columns)
    with pytest.warns(pyhysteron.HysteronWarning, match="line 302 going back in time"):
        parts = pyhysteron.read_segments(path, **columns, repair=True)
    assert [len(part) for part in parts] == [300, 200]
    model = pyhysteron.fit(parts, levels=6, bootstrap=0, start="off")
    found = model.evaluate(parts, start="off")
    apart = [model.evaluate(part, start="off") for part in parts]
    np.testing.assert_array_equal(found.output_model, np.concatenate([one.output_model for one in apart]))
    assert found.forward.samples == 500
    assert pyhysteron.compare(model, parts, start="off")[0].residual.shape == (500,)
    assert pyhysteron.adapt(model, parts).table["output_model"].shape == (500,)

"""Dates and durations as time, and series of pandas given back as such."""

import datetime

import numpy as np
import pytest

import pyhysteron

MODEL = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
BEGIN = datetime.datetime(2024, 3, 31, 0, 59, 59)
STEPS = [0.0, 0.5, 2.0]
DATES = [BEGIN + datetime.timedelta(seconds=step) for step in STEPS]
ZONE = datetime.timezone(datetime.timedelta(hours=2))


def seconds(time):
    return pyhysteron.Recording([0, 1, 0.5], [0, 1, 0.5], time=time).time.tolist()


@pytest.mark.parametrize("unit", ["ms", "us", "ns"])
def test_numpy(unit):
    dates = np.array(DATES, f"datetime64[{unit}]")
    assert seconds(dates) == STEPS
    assert seconds(dates - dates[0] + np.timedelta64(7, "s")) == [7.0, 7.5, 9.0]


@pytest.mark.parametrize("unit, size", [("m", 60), ("h", 3600), ("D", 86400), ("W", 604800), ("10s", 10), ("ps", 1e-12)])
def test_units(unit, size):
    assert seconds(np.arange(3).astype(f"timedelta64[{unit}]")) == pytest.approx([0, size, 2 * size], rel=1e-12)


def test_standard_library():
    assert seconds(DATES) == seconds(tuple(DATES)) == seconds(np.array(DATES, object)) == STEPS
    assert seconds([datetime.timedelta(seconds=step) for step in STEPS]) == STEPS
    assert seconds([datetime.date(2024, 1, day) for day in (1, 2, 4)]) == [0, 86400, 3 * 86400]
    assert seconds([date.replace(tzinfo=ZONE) for date in DATES]) == STEPS


def test_pandas():
    pandas = pytest.importorskip("pandas")
    index = pandas.DatetimeIndex(DATES)
    zoned = index.tz_localize("UTC").tz_convert("Europe/Berlin")  # summer time begins within
    for time in (index, index.to_series(), zoned, zoned.to_series(), index - index[0], list(index), list(zoned)):
        assert seconds(time) == STEPS
    frame = pandas.DataFrame({"t": index, "T": [0, 1, 0.5], "y": [0, 1, 0.5]})
    assert pyhysteron.Recording.from_frame(frame, input="T", output="y", time="t").time.tolist() == STEPS


def test_everywhere(recording, swings):
    pandas = pytest.importorskip("pandas")
    dates = pandas.date_range("2024-01-01", periods=len(swings), freq="100ms")
    prepared, report = pyhysteron.prepare(swings, recording.output, time=dates)
    assert report.rate is not None and prepared.time[-1] == pytest.approx(299.9)
    body = pyhysteron.fit((swings / 100) ** 2, recording.output, time=dates, levels=5, thermal="first-order", bootstrap=0)
    numbers = body.simulate(swings, time=0.1 * np.arange(len(swings)))
    np.testing.assert_allclose(body.simulate(swings, time=dates), numbers)


@pytest.mark.parametrize(
    "time, error, text",
    [
        (np.array(["2024-01-01", "NaT", "2024-01-02"], "datetime64[s]"), ValueError, r"`time\[1\]` is NaT.*Drop the sample"),
        ([DATES[0], None, DATES[2]], ValueError, r"`time\[1\]` is NaT"),
        (["2024-01-01", "2024-01-02", "2024-01-03"], TypeError, "pandas.to_datetime"),
        (np.array(["a", "b", "c"], object), TypeError, "pandas.to_datetime"),
        (np.array([1, 2, 3], "timedelta64[Y]"), TypeError, "convert it to datetime64"),
        (np.array([1, 2, 3], "timedelta64"), TypeError, "give one"),
        ([DATES[0], 1.0, DATES[2]], TypeError, "nothing else"),
        ([DATES[0].replace(tzinfo=ZONE), DATES[1], 3.0], TypeError, "time zone"),
        ([DATES[1], DATES[0], DATES[2]], pyhysteron.RecordingError, "goes back after sample 0"),
    ],
)
def test_what_is_refused(time, error, text):
    with pytest.raises(error, match=text):
        seconds(time)


def test_a_series_gives_a_series():
    pandas = pytest.importorskip("pandas")
    input = pandas.Series([0.5, 1.0, 0.5], index=["a", "b", "c"], name="T")
    output = MODEL.simulate(input)
    assert isinstance(output, pandas.Series) and output.index is not None
    assert output.index.equals(input.index) and output.name == "output"
    np.testing.assert_array_equal(output, MODEL.simulate(input.to_numpy()))
    pandas.testing.assert_series_equal(MODEL.start().run(input), output)
    inputs, status = MODEL.inverse().run(output)
    assert inputs.index.equals(input.index) and status.index.equals(input.index)
    assert (inputs.name, status.name, status.dtype) == ("input", "status", np.int8)
    pandas.testing.assert_series_equal(MODEL.simulate(inputs), output)
    assert type(MODEL.simulate(list(input))) is np.ndarray


def test_the_band_of_a_series(model, swings):
    pandas = pytest.importorskip("pandas")
    input = pandas.Series(swings[:50], index=range(100, 150))
    lower, upper = model.band(input)
    assert lower.index.equals(input.index) and (lower < upper).all()

"""Arguments and results of the compiled half, as far as that is simpler in Python."""

import datetime
import difflib
import sys
from collections.abc import Iterable
from typing import Any

import numpy as np

_DATES = (datetime.datetime, datetime.date, datetime.timedelta, np.datetime64, np.timedelta64)

#: Seconds of a unit, and units of a second.
_LONGER = {"W": 604_800, "D": 86_400, "h": 3600, "m": 60}
_SHORTER = {"ms": 10**3, "us": 10**6, "ns": 10**9, "ps": 10**12, "fs": 10**15, "as": 10**18}


def did_you_mean(name: str, names: Iterable[str], quote: str = "'") -> str:
    """`. Did you mean 'increments'?` for a similar name, or nothing."""
    found = difflib.get_close_matches(str(name), list(names), n=1, cutoff=0.6)
    return f". Did you mean {quote}{found[0]}{quote}?" if found else ""


def one_of(argument: str, value: object, *names: str) -> None:
    """Refuses what is none of `names`."""
    if value not in names:
        listed = ", ".join(map(repr, names))
        meant = did_you_mean(value, names) if isinstance(value, str) else ""
        raise ValueError(f"`{argument}` is {value!r}: one of {listed} is needed{meant}")


def seconds(time: Any) -> Any:
    """Dates as seconds from the first sample, durations as seconds; anything else as it is."""
    array = time if isinstance(time, np.ndarray) else np.asarray(time)
    text = array.dtype.kind == "U" or array.dtype.kind == "O" and array.ndim == 1 and len(array) and isinstance(array.flat[0], str)
    if text:
        raise TypeError("`time` has texts: seconds or dates are needed. Convert them with pandas.to_datetime, or numpy.array(time, 'datetime64[ms]')")
    if array.dtype.kind == "O" and array.ndim == 1 and len(array) and isinstance(array.flat[0], _DATES):
        array = _from_objects(array)
    if array.dtype.kind not in "Mm":
        return time
    missing = np.flatnonzero(np.isnat(array))
    if len(missing):
        raise ValueError(f"`time[{missing[0]}]` is NaT: a date or a duration is needed. Drop the sample, or fill it in")
    if array.dtype.kind == "M":
        array = array - array[:1] if array.ndim else array - array
    if array.dtype == np.dtype("timedelta64"):
        raise TypeError("`time` is of timedelta64 without a unit: give one, as timedelta64[ms]")
    unit, count = np.datetime_data(array.dtype)
    if unit in ("Y", "M"):
        raise TypeError(f"`time` is in {unit}, which is no fixed number of seconds: convert it to datetime64[s]")
    longer, shorter = _LONGER.get(unit, 1), _SHORTER.get(unit, 1)
    return array.astype(np.int64) * (count * longer) / shorter


def _from_objects(array: Any) -> Any:
    """Objects of `datetime`, pandas or NumPy, as a NumPy array of dates or durations."""
    first = array.flat[0]
    if isinstance(first, datetime.datetime) and first.tzinfo is not None:
        zone = datetime.timezone.utc
        try:
            array = [each.astimezone(zone).replace(tzinfo=None) for each in array]
        except (AttributeError, TypeError, ValueError) as error:
            raise TypeError(f"`time`: all have to be dates with a time zone, as the first: {error}") from error
    kind = "timedelta64[us]" if isinstance(first, (datetime.timedelta, np.timedelta64)) else "datetime64[us]"
    try:
        return np.array(list(array), dtype=kind)
    except (TypeError, ValueError) as error:
        raise TypeError(f"`time`: dates without time zone, or durations, and nothing else are needed: {error}") from error


def like(input: Any, result: Any, name: str) -> Any:
    """`result` as a pandas series with the index of `input`, where `input` is one."""
    pandas = sys.modules.get("pandas")
    if pandas is not None and isinstance(input, pandas.Series):
        return pandas.Series(result, index=input.index, name=name)
    return result

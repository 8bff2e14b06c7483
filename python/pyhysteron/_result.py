"""What all results share, and how they are made from plain data."""

import dataclasses
import types
import typing
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

_Array = NDArray[np.float64]
#: For type checkers what may be None, but is not where it is used as a rule: they do not ask for a check.
_MaybeNone: TypeAlias = Any


class _Result:
    """What the dataclasses share."""

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return all(_same(getattr(self, name), getattr(other, name)) for name in _names(self))

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        fields = (f"{name}={_short(getattr(self, name))}" for name in _names(self))
        return f"{type(self).__name__}({', '.join(fields)})"

    def to_dict(self) -> dict[str, Any]:
        """The fields as a dictionary, nested ones too."""
        return dataclasses.asdict(self)  # type: ignore[call-overload, no-any-return]


def _names(result: _Result) -> list[str]:
    return [field.name for field in dataclasses.fields(result)]  # type: ignore[arg-type]


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        numbers = getattr(one, "dtype", None) == np.float64
        return bool(np.array_equal(one, other, equal_nan=numbers))
    return one is other or bool(one == other) or (one != one and other != other)


def _short(value: Any) -> str:
    if isinstance(value, np.ndarray) and value.size > 6:
        return f"<array of {value.dtype}, shape {value.shape}>"
    return repr(value)


_HINTS: dict[type, dict[str, Any]] = {}


def _hints(cls: type) -> dict[str, Any]:
    """The types of the fields. They are worked out once: that takes longer than the rest."""
    if cls not in _HINTS:
        _HINTS[cls] = typing.get_type_hints(cls)
    return _HINTS[cls]


def _make(cls: Any, data: dict[str, Any]) -> Any:
    """A dataclass from plain data. Entries that it does not know go to its field `other`."""
    hints = _hints(cls)
    fields = {name: _convert(hints[name], value) for name, value in data.items() if name in hints}
    unknown = {name: value for name, value in data.items() if name not in hints}
    if unknown:
        fields["other"] = unknown  # a TypeError where there is no such field
    return cls(**fields)


def _convert(hint: Any, value: Any) -> Any:
    """`value` with lists made tuples and dictionaries made dataclasses where `hint` says so."""
    origin, arguments = typing.get_origin(hint), typing.get_args(hint)
    if value is None:
        return None
    if origin in (types.UnionType, typing.Union):
        return _convert(next(part for part in arguments if part is not type(None)), value)
    if origin is tuple:
        variable = arguments[-1] is Ellipsis
        parts = [arguments[0]] * len(value) if variable else arguments
        return tuple(_convert(part, entry) for part, entry in zip(parts, value, strict=True))
    if dataclasses.is_dataclass(hint):
        return _make(hint, value) if isinstance(value, dict) else value
    return value

"""Exceptions: one class for each kind of error, all of them `HysteronError`.

Every exception has the attribute `code`, the error's number in the C interface and the library.
"""

__all__ = [
    "HysteronError",
    "CoreError",
    "FileError",
    "FileMissingError",
    "ModelFileError",
    "RecordingError",
    "FitError",
    "FilterError",
    "RigError",
    "PreparationError",
    "DesignError",
    "ThermalError",
    "ScenarioError",
    "ControlError",
    "ExportError",
    "HysteronWarning",
]


class HysteronError(Exception):
    """Any error of pyhysteron."""

    code = 0


class CoreError(HysteronError, ValueError):
    """An invalid plane, invalid weights or inputs, or a state of another model."""


class FileError(HysteronError, OSError):
    """A file cannot be read or written; `errno` and `filename` say why and which."""


class FileMissingError(FileError, FileNotFoundError):
    """A file, or the folder that it should go to, is not there."""


class ModelFileError(HysteronError, ValueError):
    """An invalid model or model file."""


class RecordingError(HysteronError, ValueError):
    """An invalid recording."""


class FitError(HysteronError, ValueError):
    """Options do not fit the model or the recording."""


class FilterError(HysteronError, ValueError):
    """Arguments of a filter do not fit the data."""


class RigError(HysteronError, ValueError):
    """A value outside the physics of a simulated plant."""


class PreparationError(HysteronError, ValueError):
    """A step of `prepare` is impossible with its options."""


class DesignError(HysteronError, ValueError):
    """No experiment is possible with the options."""


class ThermalError(HysteronError, ValueError):
    """A thermal body cannot be simulated or identified."""


class ScenarioError(HysteronError, ValueError):
    """An invalid scenario."""


class ControlError(HysteronError, ValueError):
    """Invalid arguments of a controller."""


class ExportError(HysteronError, ValueError):
    """A model cannot be exported."""


class HysteronWarning(UserWarning):
    """Something that makes a result doubtful, or that was repaired."""

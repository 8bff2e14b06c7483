"""What can go wrong: one class for each kind of error, all of them `HysteronError`.

Every exception has the attribute `code`, the number that the C interface and the library return for it.
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
    """A plane, weights or an input that cannot be; a state of another model."""


class FileError(HysteronError, OSError):
    """A file cannot be read or written; `errno` and `filename` say why and which."""


class FileMissingError(FileError, FileNotFoundError):
    """A file, or the folder that it should go to, is not there."""


class ModelFileError(HysteronError, ValueError):
    """A model, or its file, says something that cannot be."""


class RecordingError(HysteronError, ValueError):
    """A recording cannot be used as it is."""


class FitError(HysteronError, ValueError):
    """Model or options of a fit do not allow this."""


class FilterError(HysteronError, ValueError):
    """A filter's arguments do not fit the data."""


class RigError(HysteronError, ValueError):
    """The virtual rig was asked for something outside its physics."""


class PreparationError(HysteronError, ValueError):
    """A step of the preparation cannot be done as told."""


class DesignError(HysteronError, ValueError):
    """No experiment follows from the options."""


class ThermalError(HysteronError, ValueError):
    """A thermal body cannot be run or identified."""


class ScenarioError(HysteronError, ValueError):
    """A scenario says something that cannot be."""


class ControlError(HysteronError, ValueError):
    """A controller cannot be made as told."""


class ExportError(HysteronError, ValueError):
    """A model cannot be carried to where it should run."""


class HysteronWarning(UserWarning):
    """What speaks against a result, or was mended on the way to it."""

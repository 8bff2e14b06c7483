"""Hysteresis models of actuators: identify, simulate, invert, adapt.

From a recording of input and output (temperature and displacement, say) to an MKP model (modified
Krasnosel'skii-Pokrovskii; KP and the classical Preisach relay beside it), and to its exact inverse.

Where to begin: `read` (or `Recording`), `prepare`, `fit`, then `Model.simulate`, `Model.inverse`
and `Model.start`. `design` plans a recording. `adapt` and `Adaptive` let a model follow an actuator
that changes.

Submodules: `pyhysteron.control` and `track` for control loops, `pyhysteron.plot` for figures,
`pyhysteron.sklearn` for a regressor, `pyhysteron.blocks` for blocks of python-control,
`pyhysteron.fleet` for fits of many actuators, `BatchModel` to run many models at once, `pyhysteron.results` for what functions return, `pyhysteron.errors` for exceptions. Those with an
extra package are imported when they are first used.
"""

import importlib as _importlib
from typing import TYPE_CHECKING as _TYPE_CHECKING

from . import control, errors as errors, fleet as fleet, results as results
from ._convert import did_you_mean as _did_you_mean
from ._hysteron import (
    __version__ as __version__,
    Adapted,
    Adaptive,
    AdaptiveLoad,
    BatchModel,
    BoucWenPlant,
    Comparison,
    Design,
    Inverse,
    LatentWirePlant,
    Learning,
    Model,
    PreisachPlant,
    Recording,
    SimulatedPlant,
    SpringPlant,
    State,
    adapt,
    branches,
    compare,
    design,
    design_heated,
    excitation,
    fit,
    left_out,
    prepare,
    read,
    read_segments,
    remembered,
    scenarios,
    track,
)
# Exported without being in `__all__`: their inherited methods would fill `help(pyhysteron)`.
from .errors import (
    ControlError as ControlError,
    CoreError as CoreError,
    DesignError as DesignError,
    ExportError as ExportError,
    FileError as FileError,
    FileMissingError as FileMissingError,
    FilterError as FilterError,
    FitError as FitError,
    HysteronError as HysteronError,
    HysteronWarning as HysteronWarning,
    ModelFileError as ModelFileError,
    PreparationError as PreparationError,
    RecordingError as RecordingError,
    RigError as RigError,
    ScenarioError as ScenarioError,
    ThermalError as ThermalError,
)

if _TYPE_CHECKING:
    from . import blocks as blocks, plot as plot, sklearn as sklearn

#: Submodules that need an extra package: imported when they are first used.
_LAZY = ("blocks", "plot", "sklearn")

__all__ = [
    "Adapted",
    "Adaptive",
    "AdaptiveLoad",
    "BatchModel",
    "BoucWenPlant",
    "Comparison",
    "Design",
    "Inverse",
    "LatentWirePlant",
    "Learning",
    "Model",
    "PreisachPlant",
    "Recording",
    "SimulatedPlant",
    "SpringPlant",
    "State",
    "adapt",
    "branches",
    "compare",
    "control",
    "design",
    "design_heated",
    "excitation",
    "fit",
    "left_out",
    "prepare",
    "read",
    "read_segments",
    "remembered",
    "scenarios",
    "track",
]


def __getattr__(name: str) -> object:
    if name in _LAZY:
        return _importlib.import_module(f"{__name__}.{name}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}{_did_you_mean(name, __dir__())}")


def __dir__() -> list[str]:
    return sorted({*globals(), *_LAZY})

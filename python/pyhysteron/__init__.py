"""Hysteresis models of actuators: identify, simulate, invert, adapt.

From a recording of input and output (temperature and displacement, say) to an MKP model
(modified Krasnosel'skii-Pokrovskii; KP and the classical Preisach relay beside it), and to its exact inverse.

Where to begin: `read` (or `Recording`), `prepare`, `fit`, then `Model.simulate`, `Model.inverse` and `Model.start`.
`design` plans a recording. Where the actuator changes, a model learns: `adapt`, `Adaptive`. Loops are in `pyhysteron.control` and
`track`, figures in `pyhysteron.plot`, a regressor in `pyhysteron.sklearn`, blocks for python-control in `pyhysteron.blocks`.
What can go wrong is a `HysteronError`; its kinds, of which many are ValueErrors too, are in `pyhysteron.errors`.
"""

from . import control
from ._hysteron import (
    Adapted,
    Adaptive,
    Comparison,
    Design,
    Inverse,
    Learning,
    Model,
    PreisachPlant,
    Recording,
    SimulatedPlant,
    SpringPlant,
    State,
    adapt,
    branches,
    design,
    excitation,
    fit,
    left_out,
    prepare,
    read,
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

__all__ = [
    "Adapted",
    "Adaptive",
    "Comparison",
    "Design",
    "Inverse",
    "Learning",
    "Model",
    "PreisachPlant",
    "Recording",
    "SimulatedPlant",
    "SpringPlant",
    "State",
    "adapt",
    "branches",
    "control",
    "design",
    "excitation",
    "fit",
    "left_out",
    "prepare",
    "read",
    "remembered",
    "scenarios",
    "track",
]

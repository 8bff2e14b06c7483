# Written by python/stubs: change the docstrings, or the tables there.
from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Literal, Protocol, TypeAlias, TypedDict, TypeVar, final, overload

from numpy import bool_, float64, int8, int64
from numpy.typing import ArrayLike, NDArray
from typing_extensions import disjoint_base

from .results import (
    AdaptedComparison,
    AdaptedTable,
    CExport,
    Confidence,
    CreepTerm,
    Evaluation,
    Event,
    FitSummary,
    FmuExport,
    Forward,
    LearningTable,
    FleetFitted,
    LeftOut,
    LoadCurves,
    Median,
    ModelSummary,
    Preparation,
    Ratio,
    RecordingSummary,
    SavedState,
    ScoreTable,
    Snapshot,
    ThermalBody,
    TraceTable,
    Verdict,
)

__all__ = [
    "__version__",
    "Action",
    "Adapted",
    "Adaptive",
    "AdaptiveLoad",
    "BatchModel",
    "BoucWenPlant",
    "Comparison",
    "Controller",
    "Design",
    "Inverse",
    "LatentWirePlant",
    "Learning",
    "Model",
    "Pid",
    "PreisachPlant",
    "Recording",
    "RelayTest",
    "SimulatedPlant",
    "SpringPlant",
    "State",
    "Trace",
    "WeightPrior",
    "adapt",
    "branches",
    "compare",
    "design",
    "design_heated",
    "excitation",
    "fit",
    "fit_fleet",
    "headings",
    "join_fleets",
    "left_out",
    "prepare",
    "prior_of_fleet",
    "read",
    "read_fleet",
    "read_segments",
    "remembered",
    "scenarios",
    "track",
    "tune",
]

__version__: str

# What may be None, but is not where it is used as a rule: type checkers do not ask for a check.
_MaybeNone: TypeAlias = Any
_Array: TypeAlias = NDArray[float64]
_Flags: TypeAlias = NDArray[bool_]
_Path: TypeAlias = str | PathLike[str]
_Range: TypeAlias = tuple[float, float]
_Operator: TypeAlias = Literal["mkp", "kp", "relay"]
_Heading: TypeAlias = Literal["rising", "falling"] | None
_Outcome: TypeAlias = Literal["learned", "waiting", "at-rest", "frozen", "rolled-back", "rejected", "output-stuck", "input-stuck"]
_Progress: TypeAlias = Callable[[str, float | None], object] | bool | None
# Dates and durations are no ArrayLike for NumPy's stubs.
_Times: TypeAlias = ArrayLike | Sequence[Any] | _Series
_Inputs: TypeAlias = ArrayLike | Recording | Sequence[ArrayLike | Recording]
_Recordings: TypeAlias = Recording | Sequence[Recording] | ArrayLike

class _Series(Protocol):
    """A pandas series, without a need for pandas."""

    @property
    def index(self) -> Any: ...
    @property
    def iloc(self) -> Any: ...

_S = TypeVar("_S", bound=_Series)

class _Sensor(TypedDict, total=False):
    lag_s: float
    accuracy: float
    resolution: float
    range: _Range | None
    dropout: float

class _Fatigue(TypedDict, total=False):
    shift_k: float
    irrecoverable_mm: float
    cycles: float

class _Drift(TypedDict, total=False):
    threshold_v: float
    gain: float
    time_s: float

@final
class Action:
    @property
    def command(self) -> float: ...
    @property
    def drive(self) -> float: ...
    @property
    def prediction(self) -> float: ...
    @property
    def output(self) -> float: ...
    @property
    def input(self) -> float | _MaybeNone: ...
    @property
    def saturated(self) -> bool: ...
    @property
    def out_of_reach(self) -> bool: ...
    @property
    def sensor_fault(self) -> bool: ...
    @property
    def adapted(self) -> bool: ...
    @property
    def rejected(self) -> bool: ...
    @property
    def stuck(self) -> bool: ...

@final
class Adapted:
    def __new__(
        cls,
        model: Model,
        table: AdaptedTable,
        comparison: AdaptedComparison,
    ) -> Adapted: ...
    @property
    def model(self) -> Model: ...
    @property
    def table(self) -> AdaptedTable: ...
    @property
    def comparison(self) -> AdaptedComparison: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class Adaptive:
    def __new__(
        cls,
        model: Model,
        *,
        method: Literal["auto", "fixed", "refit", "drift", "least-squares", "increments"] = "auto",
        start: Literal["off", "on"] = "off",
        window: str | None = None,
        every: int | None = None,
        ridge: float | None = None,
        gain: float | None = None,
        span: float | None = None,
        forgetting: float | None = None,
        noise: float | None = None,
        spread: float | None = None,
        correlation: float | None = None,
        offset_share: float | None = None,
        dead_zone: float | None = None,
        leakage: float | None = None,
        movement: float | None = None,
        trial: int | None = None,
        gate: float | None = None,
        burst: int | None = None,
        load: float | None = None,
    ) -> Adaptive: ...
    @property
    def output(self) -> float: ...
    @property
    def offset(self) -> float: ...
    @property
    def input(self) -> float: ...
    @property
    def weights(self) -> _Array: ...
    @property
    def turning_points(self) -> _Array: ...
    @property
    def offline(self) -> Model: ...
    def align(self) -> None: ...
    def copy(self) -> Adaptive: ...
    def freeze(self, frozen: bool = True) -> None: ...
    def keep(self) -> None: ...
    def model(self) -> Model: ...
    def refit(self) -> None: ...
    def reset(self, *, on: bool = False) -> None: ...
    def roll_back(self) -> None: ...
    def run(self, input: ArrayLike, measured: ArrayLike) -> LearningTable: ...
    def simulate(self, input: float, *, dt: float | None = None) -> float: ...
    def solve(
        self,
        target: float,
        *,
        dt: float | None = None,
        heading: _Heading = None,
        tolerance: float = 0.0,
    ) -> tuple[float, int]: ...
    def step(self, input: float, measured: float, *, dt: float | None = None) -> Learning: ...
    def __copy__(self) -> Adaptive: ...
    def __deepcopy__(self, _memo: object) -> Adaptive: ...

@final
class AdaptiveLoad:
    def __new__(
        cls,
        model: Model,
        *,
        load: float | None = None,
        start: Literal["off", "on"] = "off",
        noise: float | None = None,
        spread: float | None = None,
        dead_zone: float | None = None,
        movement: float | None = None,
        gate: float | None = None,
        burst: int | None = None,
    ) -> AdaptiveLoad: ...
    @property
    def shift(self) -> float: ...
    @property
    def deviation(self) -> float: ...
    @property
    def load(self) -> float | _MaybeNone: ...
    @property
    def offline(self) -> Model: ...
    def align(self) -> None: ...
    def copy(self) -> AdaptiveLoad: ...
    def freeze(self, frozen: bool = True) -> None: ...
    def model(self) -> Model: ...
    def reset(self, *, on: bool = False) -> None: ...
    def simulate(self, input: float, *, dt: float | None = None) -> float: ...
    def solve(
        self,
        target: float,
        *,
        dt: float | None = None,
        heading: _Heading = None,
        tolerance: float = 0.0,
    ) -> tuple[float, int]: ...
    def step(self, input: float, measured: float, *, dt: float | None = None) -> Learning: ...
    def __copy__(self) -> AdaptiveLoad: ...
    def __deepcopy__(self, _memo: object) -> AdaptiveLoad: ...

@final
class BatchModel:
    def __new__(cls, models: Model | Sequence[Model], count: int | None = None) -> BatchModel: ...
    @property
    def models(self) -> list[Model]: ...
    @property
    def states(self) -> list[State]: ...
    def reset(self) -> None: ...
    def run(
        self,
        inputs: ArrayLike,
        *,
        time: _Times | None = None,
        load: float | ArrayLike | None = None,
    ) -> _Array: ...
    def step(
        self,
        inputs: ArrayLike,
        *,
        dt: float | None = None,
        load: float | ArrayLike | None = None,
    ) -> _Array: ...
    def __len__(self) -> int: ...

@final
class BoucWenPlant(SimulatedPlant):
    def __new__(
        cls,
        *,
        load_n: float = 0.0,
        limit_v: float = 100.0,
        alpha: float = 0.3,
        beta: float = 0.02,
        gamma: float = 0.01,
        creep: float = 0.03,
        resonance_hz: float = 400.0,
        damping: float = 0.03,
        delay_s: float = 0.0005,
        sensor: _Sensor = ...,
        seed: int = 1,
    ) -> BoucWenPlant: ...

@final
class Comparison:
    @property
    def title(self) -> str: ...
    @property
    def simulated(self) -> Literal[True]: ...
    @property
    def controllers(self) -> list[str]: ...
    @property
    def scores(self) -> ScoreTable: ...
    @property
    def medians(self) -> list[Median]: ...
    @property
    def ratios(self) -> list[Ratio]: ...
    @property
    def traces(self) -> dict[str, Trace]: ...
    @property
    def tuned(self) -> dict[str, tuple[Pid, float]]: ...
    @property
    def model(self) -> Model: ...
    @property
    def pid(self) -> Pid | _MaybeNone: ...
    @property
    def inner_pid(self) -> Pid | _MaybeNone: ...
    def to_csv(self, path: _Path) -> None: ...

@final
class Controller:
    def __new__(
        cls,
        interval_s: float,
        commands: _Range,
        *,
        model: Model | Adaptive | AdaptiveLoad | None = None,
        pid: Pid | None = None,
        policy: Literal["hold", "anticipate"] = "hold",
        tolerance: float = 0.0,
        bias: float = 0.0,
        drives: _Range | None = None,
        inner: Pid | None = None,
        square_root: bool = False,
        filter_s: float = 0.0,
        stuck_s: float | None = None,
        delay: int | None = None,
    ) -> Controller: ...
    @property
    def interval_s(self) -> float: ...
    @property
    def adaptive(self) -> Adaptive | AdaptiveLoad | _MaybeNone: ...
    def run(
        self,
        device: object,
        reference: ArrayLike,
        *,
        events: Sequence[Event] | None = None,
        ahead: int = 0,
    ) -> Trace: ...
    def step(
        self,
        target: float,
        output: float,
        input: float | None = None,
        *,
        heading: _Heading = None,
        ahead: ArrayLike | None = None,
    ) -> Action: ...
    def step_command(self, command: float, output: float, input: float | None = None) -> Action: ...

@final
class Design:
    @property
    def time(self) -> _Array: ...
    @property
    def input(self) -> _Array: ...
    @property
    def excitation(self) -> _Array: ...
    @property
    def legs(self) -> list[tuple[float, float, int]]: ...
    @property
    def recorded(self) -> _Array | _MaybeNone: ...
    @property
    def corners(self) -> int: ...
    @property
    def duration(self) -> float: ...
    @property
    def full_duration(self) -> float: ...
    def to_csv(self, path: _Path) -> None: ...
    def __len__(self) -> int: ...

@final
class Inverse:
    @property
    def model(self) -> Model: ...
    @property
    def drive_range(self) -> _Range: ...
    @property
    def horizon(self) -> float: ...
    @overload
    def run(
        self,
        target: _S,
        *,
        time: _Times | None = None,
        load: float | ArrayLike | None = None,
        policy: Literal["hold", "anticipate"] = "hold",
        tolerance: float | None = None,
        state: State | None = None,
        heading: Sequence[_Heading] | None = None,
    ) -> tuple[_S, _S]: ...
    @overload
    def run(
        self,
        target: ArrayLike,
        *,
        time: _Times | None = None,
        load: float | ArrayLike | None = None,
        policy: Literal["hold", "anticipate"] = "hold",
        tolerance: float | None = None,
        state: State | None = None,
        heading: Sequence[_Heading] | None = None,
    ) -> tuple[_Array, NDArray[int8]]: ...
    def step(
        self,
        state: State,
        target: float,
        *,
        dt: float | None = None,
        load: float | None = None,
        heading: _Heading = None,
        tolerance: float = 0.0,
    ) -> tuple[float, int]: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class LatentWirePlant(SimulatedPlant):
    def __new__(
        cls,
        *,
        load_n: float = 3.0,
        stiffness_n_per_mm: float = 0.1,
        room_degc: float = 20.0,
        latent_heat_j_per_g: float = 20.0,
        strain: float = 0.04,
        drive: Literal["duty", "current"] = "duty",
        limit_a: float = 0.3,
        sensor: _Sensor = ...,
        seed: int = 1,
    ) -> LatentWirePlant: ...

@final
class Learning:
    def __new__(
        cls,
        output: float,
        error: float,
        outcome: _Outcome,
        clipped: Literal[-1, 0, 1],
    ) -> Learning: ...
    @property
    def output(self) -> float: ...
    @property
    def error(self) -> float: ...
    @property
    def outcome(self) -> _Outcome: ...
    @property
    def clipped(self) -> Literal[-1, 0, 1]: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class Model:
    def __new__(
        cls,
        weights: ArrayLike,
        range: _Range,
        *,
        operator: _Operator = "mkp",
        offset: float = 0.0,
        sign: Literal[1, -1] = 1,
        input: str = "input",
        output: str = "output",
    ) -> Model: ...
    @property
    def operator(self) -> _Operator: ...
    @property
    def levels(self) -> int: ...
    @property
    def range(self) -> _Range: ...
    @property
    def plane(self) -> _Array: ...
    @property
    def weights(self) -> _Array: ...
    @property
    def offset(self) -> float: ...
    @property
    def sign(self) -> Literal[1, -1]: ...
    @property
    def output_range(self) -> _Range: ...
    @property
    def input(self) -> str: ...
    @property
    def output(self) -> str: ...
    @property
    def fit(self) -> FitSummary | _MaybeNone: ...
    @property
    def confidence(self) -> Confidence | _MaybeNone: ...
    @property
    def verdict(self) -> Verdict | _MaybeNone: ...
    @property
    def delay_s(self) -> float: ...
    @property
    def thermal(self) -> ThermalBody | _MaybeNone: ...
    @property
    def load_range(self) -> _Range | _MaybeNone: ...
    @property
    def load_name(self) -> str | _MaybeNone: ...
    @property
    def load_curves(self) -> LoadCurves | _MaybeNone: ...
    @property
    def load_degree(self) -> int | _MaybeNone: ...
    @property
    def drive(self) -> _Range | _MaybeNone: ...
    @property
    def active_range(self) -> _Range: ...
    @property
    def spacing(self) -> _Array | _MaybeNone: ...
    @property
    def constants(self) -> dict[str, _Array]: ...
    @property
    def creep(self) -> tuple[CreepTerm, ...]: ...
    @property
    def lag(self) -> float: ...
    @property
    def is_timed(self) -> bool: ...
    @property
    def fitted_start(self) -> SavedState | _MaybeNone: ...
    def at_load(self, load: float) -> Model: ...
    @overload
    def band(
        self,
        input: _S,
        *,
        time: _Times | None = None,
        load: float | ArrayLike | None = None,
    ) -> tuple[_S, _S]: ...
    @overload
    def band(
        self,
        input: ArrayLike,
        *,
        time: _Times | None = None,
        load: float | ArrayLike | None = None,
    ) -> tuple[_Array, _Array]: ...
    @overload
    def bounds(
        self,
        input: _S,
        *,
        time: _Times | None = None,
        load: float | ArrayLike | None = None,
        start: Literal["fitted", "off", "on"] = "fitted",
    ) -> tuple[_S, _S]: ...
    @overload
    def bounds(
        self,
        input: ArrayLike,
        *,
        time: _Times | None = None,
        load: float | ArrayLike | None = None,
        start: Literal["fitted", "off", "on"] = "fitted",
    ) -> tuple[_Array, _Array]: ...
    def evaluate(
        self,
        recording: _Recordings,
        output: ArrayLike | None = None,
        *,
        start: Literal["fitted", "off", "on", "rest", "unknown"] = "fitted",
        time: _Times | None = None,
        load: ArrayLike | None = None,
    ) -> Evaluation: ...
    def excitation(self, input: _Inputs) -> _Array: ...
    def export_c(
        self,
        folder: _Path,
        *,
        real: Literal["float", "double"] = "float",
        name: str | None = None,
        adaptation: bool = False,
        dt: float | None = None,
        drive_range: _Range | None = None,
        controller: bool = False,
        gains: Pid | None = None,
        gate: float | None = None,
        filter_s: float | None = None,
        measured_dt: bool = False,
    ) -> CExport: ...
    def export_fmu(
        self,
        path: _Path,
        *,
        inverse: bool = False,
        fmi: Literal[2, 3] = 2,
        name: str | None = None,
        controller: bool = False,
        gains: Pid | None = None,
        gate: float | None = None,
        filter_s: float | None = None,
        dt: float | None = None,
        drive_range: _Range | None = None,
    ) -> FmuExport: ...
    @classmethod
    def from_json(cls, text: str) -> Model: ...
    def inverse(self, drive_range: _Range | None = None, horizon: float = 0.0) -> Inverse: ...
    @classmethod
    def load(cls, path: _Path) -> Model: ...
    def plot(self, recording: Recording | None = None) -> Any: ...
    def restore(self, saved: SavedState) -> State: ...
    def save(self, path: _Path) -> None: ...
    @overload
    def simulate(
        self,
        input: _S,
        *,
        time: _Times | None = None,
        load: float | ArrayLike | None = None,
        start: Literal["fitted", "off", "on"] = "fitted",
        rest: float | None = None,
    ) -> _S: ...
    @overload
    def simulate(
        self,
        input: ArrayLike,
        *,
        time: _Times | None = None,
        load: float | ArrayLike | None = None,
        start: Literal["fitted", "off", "on"] = "fitted",
        rest: float | None = None,
    ) -> _Array: ...
    def start(self, *, on: bool | None = None) -> State: ...
    def summary(self) -> ModelSummary: ...
    def to_json(self) -> str: ...
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __reduce__(self) -> tuple[Any, ...]: ...
    def _repr_html_(self) -> str: ...

@final
class Pid:
    def __new__(cls, gain: float, *, integral_s: float = 0.0, derivative_s: float = 0.0) -> Pid: ...
    @property
    def gain(self) -> float: ...
    @property
    def integral_s(self) -> float: ...
    @property
    def derivative_s(self) -> float: ...
    @staticmethod
    def from_oscillation(ultimate_gain: float, period_s: float) -> Pid: ...
    @staticmethod
    def from_step(output: ArrayLike, begin: int, step: float, interval_s: float) -> Pid: ...
    def hold(self, *, bias: float = 0.0, limits: _Range | None = None) -> float: ...
    def relax(self, dt: float, *, bias: float = 0.0, limits: _Range | None = None) -> float: ...
    def reset(self) -> None: ...
    def step(
        self,
        error: float,
        dt: float,
        *,
        bias: float = 0.0,
        limits: _Range | None = None,
        held: tuple[bool, bool] = (False, False),
    ) -> float: ...

@final
class PreisachPlant(SimulatedPlant):
    def __new__(
        cls,
        *,
        load_n: float = 6.0,
        lag_s: float = 0.02,
        limit_v: float = 150.0,
        levels: int = 240,
        drift: _Drift = ...,
        measure_input: bool = False,
        output_sensor: _Sensor = ...,
        input_sensor: _Sensor = ...,
        seed: int = 1,
    ) -> PreisachPlant: ...

@final
class Recording:
    def __new__(
        cls,
        input: ArrayLike,
        output: ArrayLike,
        *,
        time: _Times | None = None,
        load: ArrayLike | None = None,
        input_name: str = "input",
        output_name: str = "output",
        load_name: str = "load",
        simulated: bool = False,
    ) -> Recording: ...
    @property
    def input(self) -> _Array: ...
    @property
    def output(self) -> _Array: ...
    @property
    def time(self) -> _Array | _MaybeNone: ...
    @property
    def load(self) -> _Array | _MaybeNone: ...
    @property
    def input_name(self) -> str: ...
    @property
    def output_name(self) -> str: ...
    @property
    def load_name(self) -> str: ...
    @property
    def simulated(self) -> bool: ...
    @property
    def path(self) -> Path | None: ...
    @classmethod
    def from_frame(
        cls,
        frame: Any,
        *,
        input: Any,
        output: Any,
        time: Any | None = None,
        load: Any | None = None,
        input_name: str | None = None,
        output_name: str | None = None,
        load_name: str | None = None,
    ) -> Recording: ...
    def plot(self, model: Model | None = None) -> Any: ...
    def summary(self, *, levels: int = 20, range: _Range | None = None) -> RecordingSummary: ...
    def to_csv(self, path: _Path) -> None: ...
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __len__(self) -> int: ...
    def __reduce__(self) -> tuple[Any, ...]: ...
    def _repr_html_(self) -> str: ...

@final
class RelayTest:
    def __new__(cls, commands: _Range, middle: float, *, hysteresis: float = 0.0) -> RelayTest: ...
    @property
    def command(self) -> float: ...
    @property
    def done(self) -> bool: ...
    @property
    def outputs(self) -> _Range | None: ...
    def gains(self, interval_s: float) -> Pid: ...
    def oscillation(self, interval_s: float) -> _Range | None: ...
    def push(self, output: float) -> None: ...

@disjoint_base
class SimulatedPlant:
    @property
    def simulated(self) -> Literal[True]: ...
    @property
    def drives(self) -> _Range: ...
    @property
    def quantities(self) -> list[str]: ...
    def advance(self, dt_s: float) -> None: ...
    def disturb(
        self,
        *,
        load_n: float | None = None,
        room_degc: float | None = None,
        predeformation_mm: float | None = None,
        gain: float | None = None,
        stuck: bool | None = None,
        lost: bool | None = None,
    ) -> None: ...
    def read(self) -> tuple[float, float | _MaybeNone]: ...
    def truth(self) -> tuple[float, float | _MaybeNone]: ...
    def write(self, drive: float) -> None: ...

@final
class SpringPlant(SimulatedPlant):
    def __new__(
        cls,
        *,
        load_n: float = 6.0,
        room_degc: float = 22.0,
        predeformation_mm: float = 0.0,
        limit_a: float = 2.0,
        fatigue: _Fatigue | None = None,
        thermocouple: _Sensor = ...,
        lvdt: _Sensor = ...,
        seed: int = 1,
    ) -> SpringPlant: ...

@final
class State:
    @property
    def model(self) -> Model: ...
    @property
    def turning_points(self) -> _Array: ...
    @property
    def operators(self) -> _Array: ...
    @property
    def input(self) -> float: ...
    @property
    def temperature(self) -> float: ...
    def copy(self) -> State: ...
    def reset(self, *, on: bool | None = None) -> None: ...
    @overload
    def run(
        self,
        input: _S,
        *,
        time: _Times | None = None,
        load: float | ArrayLike | None = None,
    ) -> _S: ...
    @overload
    def run(
        self,
        input: ArrayLike,
        *,
        time: _Times | None = None,
        load: float | ArrayLike | None = None,
    ) -> _Array: ...
    def save(self) -> SavedState: ...
    def step(
        self,
        input: float,
        *,
        dt: float | None = None,
        load: float | None = None,
    ) -> float: ...
    def __copy__(self) -> State: ...
    def __deepcopy__(self, _memo: object) -> State: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class Trace:
    @property
    def time(self) -> _Array: ...
    @property
    def reference(self) -> _Array: ...
    @property
    def output(self) -> _Array: ...
    @property
    def measured(self) -> _Array: ...
    @property
    def input(self) -> _Array: ...
    @property
    def command(self) -> _Array: ...
    @property
    def drive(self) -> _Array: ...
    @property
    def prediction(self) -> _Array: ...
    @property
    def saturated(self) -> _Flags: ...
    @property
    def out_of_reach(self) -> _Flags: ...
    @property
    def sensor_fault(self) -> _Flags: ...
    @property
    def adapted(self) -> _Flags: ...
    @property
    def rejected(self) -> _Flags: ...
    @property
    def stuck(self) -> _Flags: ...
    @property
    def snapshots(self) -> list[Snapshot]: ...
    def to_csv(self, path: _Path) -> None: ...
    def to_dict(self) -> TraceTable: ...
    def __len__(self) -> int: ...

@final
class WeightPrior:
    def __new__(cls, models: Sequence[Model]) -> WeightPrior: ...

def adapt(
    model: Model,
    recording: _Recordings,
    output: ArrayLike | None = None,
    *,
    time: _Times | None = None,
    method: Literal["auto", "fixed", "refit", "drift", "least-squares", "increments", "load"] = "auto",
    start: Literal["fitted", "off", "on", "rest", "unknown"] = "unknown",
    window: str | None = None,
    every: int | None = None,
    ridge: float | None = None,
    gain: float | None = None,
    span: float | None = None,
    forgetting: float | None = None,
    noise: float | None = None,
    spread: float | None = None,
    correlation: float | None = None,
    offset_share: float | None = None,
    dead_zone: float | None = None,
    leakage: float | None = None,
    movement: float | None = None,
    trial: int | None = None,
    gate: float | None = None,
    burst: int | None = None,
    load: float | None = None,
    progress: _Progress = None,
) -> Adapted: ...
def branches(input: ArrayLike, *, dead_band: float | None = None) -> NDArray[int64]: ...
def compare(
    models: Model | Sequence[Model] | Mapping[str, Model],
    recording: _Recordings,
    output: ArrayLike | None = None,
    *,
    start: Literal["fitted", "off", "on", "rest", "unknown"] = "fitted",
    time: ArrayLike | None = None,
    load: ArrayLike | None = None,
) -> list[Forward]: ...
def design(
    range: _Range,
    levels: int,
    *,
    heating_rate: float,
    cooling_rate: float,
    budget: float | None = None,
    recorded: _Inputs | None = None,
    step: float | None = None,
    operator: _Operator = "mkp",
) -> Design: ...
def design_heated(
    model: Model,
    *,
    range: _Range | None = None,
    levels: int = 20,
    heating_rate: float | None = None,
    cooling_rate: float | None = None,
    budget: float | None = None,
    step: float | None = None,
) -> Design: ...
def excitation(
    input: _Inputs,
    range: _Range,
    levels: int,
    *,
    operator: _Operator = "mkp",
) -> _Array: ...
def fit(
    recording: _Recordings,
    output: ArrayLike | None = None,
    *,
    levels: int | Literal['auto'] = "auto",
    range: _Range | None = None,
    operator: _Operator = "mkp",
    solver: Literal["nnls", "ols"] = "nnls",
    smooth: float | tuple[float, float] | Literal['auto'] = "auto",
    ridge: float = 1e-06,
    robust: bool = True,
    start: Literal["auto", "off", "on", "rest", "unknown"] = "auto",
    sign: Literal[1, -1] | None = None,
    offset: float | None = None,
    load_law: Literal["auto", "shift", "weights"] = "auto",
    load_degree: int | Literal['auto'] = "auto",
    spacing: Literal["auto", "uniform"] = "auto",
    delay: int | Literal['auto', 'off'] = "auto",
    creep: int | Literal['auto', 'off'] = "off",
    lag: float | Literal['auto', 'off'] = "off",
    dynamics: Literal["auto", "off", "lag", "ring"] = "auto",
    curve: int | Literal['auto', 'off'] = "off",
    bootstrap: int | None = None,
    repeats: Recording | Sequence[Recording] | None = None,
    hold_out: str | Recording | Sequence[str | Recording] | None = None,
    thermal: Literal["first-order", "auto", True, False] | None = None,
    prior: WeightPrior | None = None,
    time: _Times | None = None,
    load: ArrayLike | None = None,
    progress: _Progress = None,
) -> Model: ...
def fit_fleet(
    data: Sequence[_Path],
    target: _Path,
    *,
    input: str,
    output: str,
    by: str | None = None,
    levels: int | Literal['auto'] = "auto",
    range: _Range | None = None,
    operator: _Operator = "mkp",
    solver: Literal["nnls", "ols"] = "nnls",
    smooth: float | tuple[float, float] | Literal['auto'] = "auto",
    ridge: float = 1e-06,
    robust: bool = True,
    start: Literal["auto", "off", "on", "rest", "unknown"] = "auto",
    sign: Literal[1, -1] | None = None,
    offset: float | None = None,
    load_law: Literal["auto", "shift", "weights"] = "auto",
    load_degree: int | Literal['auto'] = "auto",
    spacing: Literal["auto", "uniform"] = "auto",
    delay: int | Literal['auto', 'off'] = "auto",
    creep: int | Literal['auto', 'off'] = "off",
    lag: float | Literal['auto', 'off'] = "off",
    dynamics: Literal["auto", "off", "lag", "ring"] = "auto",
    curve: int | Literal['auto', 'off'] = "off",
    bootstrap: int | None = None,
    choice: Literal["pilots", "each"] = "pilots",
    hold_out: str | None = None,
    thermal: Literal["first-order", "auto", True, False] | None = None,
    prior: WeightPrior | None = None,
    time: str | None = None,
    load: str | None = None,
    repair: bool = False,
    force: bool = False,
    progress: _Progress = None,
) -> FleetFitted: ...
def headings(series: ArrayLike, tolerance: float = 0.0) -> list[_Heading]: ...
def join_fleets(parts: Sequence[_Path], target: _Path, *, force: bool = False) -> int: ...
def left_out(
    recording: _Recordings,
    output: ArrayLike | None = None,
    *,
    levels: int | Literal['auto'] = "auto",
    range: _Range | None = None,
    operator: _Operator = "mkp",
    solver: Literal["nnls", "ols"] = "nnls",
    smooth: float | tuple[float, float] | Literal['auto'] = "auto",
    ridge: float = 1e-06,
    start: Literal["auto", "off", "on", "rest", "unknown"] = "auto",
    sign: Literal[1, -1] | None = None,
    offset: float | None = None,
    load_degree: int | Literal['auto'] = "auto",
    time: _Times | None = None,
    load: ArrayLike | None = None,
    progress: _Progress = None,
) -> LeftOut: ...
def prepare(
    recording: Recording | ArrayLike,
    output: ArrayLike | None = None,
    *,
    spikes: float | Literal['auto', 'off'] = "auto",
    resample: float | Literal['auto', 'off'] = "auto",
    low_pass: float | Literal['auto', 'off'] = "auto",
    lag: float | Literal['auto', 'off'] = "off",
    dead_band: float | Literal['auto', 'off'] = "auto",
    signs: bool = False,
    believe: bool = False,
    time: _Times | None = None,
    load: ArrayLike | None = None,
    progress: _Progress = None,
) -> tuple[Recording, Preparation]: ...
def prior_of_fleet(models: _Path) -> WeightPrior: ...
def read(
    path: _Path,
    *,
    input: str,
    output: str,
    time: str | None = None,
    load: str | None = None,
    input_name: str | None = None,
    output_name: str | None = None,
    load_name: str | None = None,
    repair: bool = False,
    max_memory: int | None = None,
) -> Recording: ...
def read_fleet(models: _Path, *, actuators: Sequence[str] | None = None) -> dict[str, Model]: ...
def read_segments(
    path: _Path,
    *,
    input: str,
    output: str,
    time: str | None = None,
    load: str | None = None,
    input_name: str | None = None,
    output_name: str | None = None,
    load_name: str | None = None,
    repair: bool = False,
    max_memory: int | None = None,
) -> list[Recording]: ...
def remembered(input: ArrayLike) -> NDArray[int64]: ...
def scenarios() -> dict[str, str]: ...
def track(
    scenario: _Path,
    *,
    seeds: int | None = None,
    progress: _Progress | None = None,
) -> Comparison: ...
def tune(scenario: _Path) -> tuple[Pid | _MaybeNone, Pid | _MaybeNone]: ...

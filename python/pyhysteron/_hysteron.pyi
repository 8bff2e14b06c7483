from collections.abc import Callable, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Literal, TypeAlias, TypedDict, final

from numpy import bool_, float64, int8, int64
from numpy.typing import ArrayLike, NDArray
from typing_extensions import disjoint_base

__all__ = [
    "Action",
    "Adapted",
    "Adaptive",
    "Comparison",
    "Controller",
    "Design",
    "Inverse",
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
    "adapt",
    "branches",
    "design",
    "excitation",
    "fit",
    "headings",
    "left_out",
    "prepare",
    "read",
    "remembered",
    "scenarios",
    "track",
    "tune",
]

_Array: TypeAlias = NDArray[float64]
_Path: TypeAlias = str | PathLike[str]
_Operator: TypeAlias = Literal["mkp", "kp", "relay"]
_Solver: TypeAlias = Literal["nnls", "ols"]
_Start: TypeAlias = Literal["off", "on", "unknown"]
_Sign: TypeAlias = Literal[1, -1]
_Auto: TypeAlias = Literal["auto"]
_Step: TypeAlias = float | Literal["auto", "off"]
_Progress: TypeAlias = Callable[[str, float | None], object] | bool | None
_Inputs: TypeAlias = ArrayLike | Recording | Sequence[ArrayLike | Recording]
_Recordings: TypeAlias = Recording | Sequence[Recording] | ArrayLike
_Flags: TypeAlias = NDArray[bool_]
_Heading: TypeAlias = Literal["rising", "falling"] | None
_Method: TypeAlias = Literal["gradient", "increments", "least-squares", "drift"]
_Outcome: TypeAlias = Literal["learned", "waiting", "at-rest", "frozen", "rolled-back", "rejected"]
_Range: TypeAlias = tuple[float, float]

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
class Model:
    def __new__(
        cls,
        weights: ArrayLike,
        range: _Range,
        *,
        operator: _Operator = "mkp",
        offset: float = 0.0,
        sign: _Sign = 1,
        input: str = "input",
        output: str = "output",
    ) -> Model: ...
    @classmethod
    def load(cls, path: _Path) -> Model: ...
    def save(self, path: _Path) -> None: ...
    @classmethod
    def from_json(cls, text: str) -> Model: ...
    def to_json(self) -> str: ...
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
    def sign(self) -> _Sign: ...
    @property
    def output_range(self) -> _Range: ...
    @property
    def input(self) -> str: ...
    @property
    def output(self) -> str: ...
    @property
    def fit(self) -> dict[str, Any] | None: ...
    @property
    def confidence(self) -> dict[str, Any] | None: ...
    @property
    def thermal(self) -> dict[str, float] | None: ...
    @property
    def load_range(self) -> _Range | None: ...
    @property
    def load_name(self) -> str | None: ...
    def summary(self) -> dict[str, Any]: ...
    def simulate(
        self, input: ArrayLike, *, time: ArrayLike | None = None, load: ArrayLike | None = None
    ) -> _Array: ...
    def band(
        self, input: ArrayLike, *, time: ArrayLike | None = None, load: ArrayLike | None = None
    ) -> tuple[_Array, _Array]: ...
    def evaluate(
        self,
        recording: Recording | ArrayLike,
        output: ArrayLike | None = None,
        *,
        start: _Start = "off",
        time: ArrayLike | None = None,
        load: ArrayLike | None = None,
    ) -> dict[str, Any]: ...
    def excitation(self, input: _Inputs) -> _Array: ...
    def start(self, *, on: bool = False) -> State: ...
    def restore(self, saved: dict[str, Any]) -> State: ...
    def inverse(self) -> Inverse: ...
    def export_c(
        self,
        folder: _Path,
        *,
        real: Literal["float", "double"] = "float",
        name: str | None = None,
        adaptation: bool = False,
    ) -> dict[str, Any]: ...
    def export_fmu(
        self, path: _Path, *, inverse: bool = False, fmi: Literal[2, 3] = 2, name: str | None = None
    ) -> dict[str, Any]: ...
    def at_load(self, load: float) -> Model: ...
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

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
    def step(self, input: float) -> float: ...
    def run(self, input: ArrayLike) -> _Array: ...
    def reset(self, *, on: bool = False) -> None: ...
    def save(self) -> dict[str, Any]: ...
    def copy(self) -> State: ...
    def __copy__(self) -> State: ...
    def __deepcopy__(self, _memo: object) -> State: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class Inverse:
    @property
    def model(self) -> Model: ...
    def run(
        self,
        target: ArrayLike,
        *,
        policy: Literal["hold", "anticipate"] = "hold",
        band: float | None = None,
        state: State | None = None,
        heading: Sequence[_Heading] | None = None,
    ) -> tuple[_Array, NDArray[int8]]: ...
    def step(
        self, state: State, target: float, *, heading: _Heading = None, band: float = 0.0
    ) -> tuple[float, int]: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class Recording:
    def __new__(
        cls,
        input: ArrayLike,
        output: ArrayLike,
        *,
        time: ArrayLike | None = None,
        load: ArrayLike | None = None,
        input_name: str = "input",
        output_name: str = "output",
        load_name: str = "load",
        simulated: bool = False,
    ) -> Recording: ...
    @classmethod
    def from_frame(
        cls,
        frame: Any,
        *,
        input: Any,
        output: Any,
        time: Any = None,
        load: Any = None,
        input_name: str | None = None,
        output_name: str | None = None,
        load_name: str | None = None,
    ) -> Recording: ...
    @property
    def input(self) -> _Array: ...
    @property
    def output(self) -> _Array: ...
    @property
    def time(self) -> _Array | None: ...
    @property
    def load(self) -> _Array | None: ...
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
    def to_csv(self, path: _Path) -> None: ...
    def summary(self, *, levels: int = 20, range: _Range | None = None) -> dict[str, Any]: ...
    def __len__(self) -> int: ...
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class Design:
    @property
    def time(self) -> _Array: ...
    @property
    def input(self) -> _Array: ...
    @property
    def legs(self) -> list[tuple[float, float, int]]: ...
    @property
    def excitation(self) -> _Array: ...
    @property
    def recorded(self) -> _Array | None: ...
    @property
    def corners(self) -> int: ...
    @property
    def duration(self) -> float: ...
    @property
    def full_duration(self) -> float: ...
    def to_csv(self, path: _Path) -> None: ...
    def __len__(self) -> int: ...

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
def fit(
    recording: _Recordings,
    output: ArrayLike | None = None,
    *,
    levels: int | _Auto = 20,
    range: _Range | None = None,
    operator: _Operator = "mkp",
    solver: _Solver = "nnls",
    smooth: float | _Auto = 0.0,
    start: _Start = "off",
    sign: _Sign | None = None,
    offset: float | None = None,
    load_degree: int = 1,
    bootstrap: int | None = None,
    thermal: Literal["first-order"] | None = None,
    time: ArrayLike | None = None,
    load: ArrayLike | None = None,
    progress: _Progress = None,
) -> Model: ...
def left_out(
    recording: _Recordings,
    output: ArrayLike | None = None,
    *,
    levels: int | _Auto = 20,
    range: _Range | None = None,
    operator: _Operator = "mkp",
    solver: _Solver = "nnls",
    smooth: float | _Auto = 0.0,
    start: _Start = "off",
    sign: _Sign | None = None,
    offset: float | None = None,
    load_degree: int = 1,
    time: ArrayLike | None = None,
    load: ArrayLike | None = None,
    progress: _Progress = None,
) -> dict[str, Any]: ...
def prepare(
    recording: Recording | ArrayLike,
    output: ArrayLike | None = None,
    *,
    spikes: _Step = "auto",
    resample: _Step = "auto",
    low_pass: _Step = "auto",
    lag: _Step = "off",
    band: _Step = "auto",
    time: ArrayLike | None = None,
    load: ArrayLike | None = None,
    progress: _Progress = None,
) -> tuple[Recording, dict[str, Any]]: ...
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
def excitation(
    input: _Inputs, range: _Range, levels: int, *, operator: _Operator = "mkp"
) -> _Array: ...
def branches(input: ArrayLike, *, band: float | None = None) -> NDArray[int64]: ...
def remembered(input: ArrayLike) -> NDArray[int64]: ...

@final
class Learning:
    def __new__(cls, output: float, error: float, outcome: _Outcome, clipped: Literal[-1, 0, 1]) -> Learning: ...
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
class Adaptive:
    def __new__(
        cls,
        model: Model,
        *,
        method: _Method = "gradient",
        start: Literal["off", "on"] = "off",
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
    def step(self, input: float, measured: float) -> Learning: ...
    def run(self, input: ArrayLike, measured: ArrayLike) -> dict[str, Any]: ...
    def predict(self, input: float) -> float: ...
    def solve(self, target: float, *, heading: _Heading = None, band: float = 0.0) -> tuple[float, int]: ...
    def align(self) -> None: ...
    def model(self) -> Model: ...
    def reset(self, *, on: bool = False) -> None: ...
    def freeze(self, frozen: bool = True) -> None: ...
    def keep(self) -> None: ...
    def roll_back(self) -> None: ...
    def copy(self) -> Adaptive: ...
    def __copy__(self) -> Adaptive: ...
    def __deepcopy__(self, _memo: object) -> Adaptive: ...

@final
class Adapted:
    def __new__(cls, model: Model, table: dict[str, Any], comparison: dict[str, Any]) -> Adapted: ...
    @property
    def model(self) -> Model: ...
    @property
    def table(self) -> dict[str, Any]: ...
    @property
    def comparison(self) -> dict[str, Any]: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

def adapt(
    model: Model,
    recording: Recording | ArrayLike,
    output: ArrayLike | None = None,
    *,
    time: ArrayLike | None = None,
    method: _Method = "drift",
    start: _Start = "off",
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

@disjoint_base
class SimulatedPlant:
    @property
    def simulated(self) -> Literal[True]: ...
    @property
    def drives(self) -> _Range: ...
    @property
    def quantities(self) -> list[str]: ...
    def read(self) -> tuple[float, float | None]: ...
    def write(self, drive: float) -> None: ...
    def advance(self, dt_s: float) -> None: ...
    def truth(self) -> tuple[float, float | None]: ...
    def disturb(
        self,
        *,
        load_n: float | None = None,
        room_degc: float | None = None,
        predeformation_mm: float | None = None,
        stuck: bool | None = None,
        lost: bool | None = None,
    ) -> None: ...

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
class Pid:
    def __new__(cls, gain: float, *, integral_s: float = 0.0, derivative_s: float = 0.0) -> Pid: ...
    @staticmethod
    def from_oscillation(ultimate_gain: float, period_s: float) -> Pid: ...
    @staticmethod
    def from_step(output: ArrayLike, begin: int, step: float, interval_s: float) -> Pid: ...
    @property
    def gain(self) -> float: ...
    @property
    def integral_s(self) -> float: ...
    @property
    def derivative_s(self) -> float: ...
    def step(
        self,
        error: float,
        dt: float,
        *,
        bias: float = 0.0,
        limits: _Range | None = None,
        held: tuple[bool, bool] = (False, False),
    ) -> float: ...
    def hold(self, *, bias: float = 0.0, limits: _Range | None = None) -> float: ...
    def reset(self) -> None: ...

@final
class RelayTest:
    def __new__(cls, commands: _Range, middle: float, *, band: float = 0.0) -> RelayTest: ...
    @property
    def command(self) -> float: ...
    @property
    def done(self) -> bool: ...
    @property
    def outputs(self) -> _Range | None: ...
    def push(self, output: float) -> None: ...
    def oscillation(self, interval_s: float) -> _Range | None: ...
    def gains(self, interval_s: float) -> Pid: ...

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
    def input(self) -> float | None: ...
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

@final
class Controller:
    def __new__(
        cls,
        interval_s: float,
        commands: _Range,
        *,
        model: Model | Adaptive | None = None,
        pid: Pid | None = None,
        rest: Literal["hold", "anticipate"] = "hold",
        tolerance: float = 0.0,
        bias: float = 0.0,
        drives: _Range | None = None,
        inner: Pid | None = None,
        square_root: bool = False,
        filter_s: float = 0.0,
        stuck_s: float | None = None,
    ) -> Controller: ...
    @property
    def interval_s(self) -> float: ...
    @property
    def adaptive(self) -> Adaptive | None: ...
    def step(
        self, target: float, output: float, input: float | None = None, *, heading: _Heading = None
    ) -> Action: ...
    def step_command(self, command: float, output: float, input: float | None = None) -> Action: ...
    def run(
        self, device: object, reference: ArrayLike, *, events: Sequence[dict[str, Any]] | None = None
    ) -> Trace: ...

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
    def snapshots(self) -> list[dict[str, Any]]: ...
    def to_dict(self) -> dict[str, NDArray[Any]]: ...
    def to_csv(self, path: _Path) -> None: ...
    def __len__(self) -> int: ...

@final
class Comparison:
    @property
    def title(self) -> str: ...
    @property
    def simulated(self) -> Literal[True]: ...
    @property
    def controllers(self) -> list[str]: ...
    @property
    def scores(self) -> dict[str, Any]: ...
    @property
    def medians(self) -> list[dict[str, Any]]: ...
    @property
    def ratios(self) -> list[dict[str, Any]]: ...
    @property
    def traces(self) -> dict[str, Trace]: ...
    @property
    def model(self) -> Model: ...
    @property
    def pid(self) -> Pid | None: ...
    @property
    def inner_pid(self) -> Pid | None: ...
    def to_csv(self, path: _Path) -> None: ...

def track(scenario: _Path, *, seeds: int | None = None, progress: _Progress = None) -> Comparison: ...
def tune(scenario: _Path) -> tuple[Pid | None, Pid | None]: ...
def scenarios() -> dict[str, str]: ...
def headings(series: ArrayLike, band: float = 0.0) -> list[_Heading]: ...

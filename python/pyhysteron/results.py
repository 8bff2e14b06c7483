"""Results as frozen dataclasses: what `fit`, `evaluate`, `prepare` and others return.

Nobody makes these objects by hand. ``to_dict()`` gives plain dictionaries, as `dataclasses.asdict`
does. Two results are equal if all their fields are; NaN equals NaN.

>>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
>>> errors = model.evaluate([0.5, 1.0, 0.5], [4.0, 7.0, 5.5]).forward
>>> errors.max_abs, errors.samples
(0.5, 3)
>>> errors.to_dict()["max_abs"]
0.5
"""

import dataclasses
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypedDict

import numpy as np
from numpy.typing import NDArray

from . import _measured
from ._measured import (
    Candidate,
    Compared,
    ConfidenceSummary,
    ConstantSummary,
    CreepTerm,
    CutOff,
    DeadBand,
    Drift,
    Errors,
    HeldOut,
    Judged,
    LoadCurves,
    LoadSummary,
    LowPass,
    ModelSummary,
    OutcomeCounts,
    Outlier,
    RateDependence,
    Ratio,
    Repairs,
    RivalErrors,
    RivalScore,
    Sampling,
    SeenFile,
    SensorLag,
    SeriesSummary,
    Smooth,
    Smoothed,
    Spikes,
    StageSummary,
    ThermalBody,
    Uncertain,
    Validation,
    Worst,
)
from ._result import _Array, _make, _MaybeNone, _Result

__all__ = [
    "AdaptedComparison",
    "AdaptedTable",
    "BandTest",
    "CExport",
    "Candidate",
    "Compared",
    "Confidence",
    "ConfidenceSummary",
    "ConstantSummary",
    "CreepTerm",
    "CutOff",
    "DeadBand",
    "Doubt",
    "Drift",
    "Errors",
    "Evaluation",
    "Event",
    "FitSummary",
    "FleetFitted",
    "FmuExport",
    "Forward",
    "HeldOut",
    "InverseRun",
    "InverseTest",
    "Judged",
    "LearningTable",
    "LeftOut",
    "LoadCurves",
    "LoadSummary",
    "LowPass",
    "Median",
    "ModelSummary",
    "OutcomeCounts",
    "Outlier",
    "Preparation",
    "RateDependence",
    "Ratio",
    "RecordingSummary",
    "Repairs",
    "RivalErrors",
    "RivalScore",
    "Sampling",
    "SavedState",
    "ScoreTable",
    "SeenFile",
    "SensorLag",
    "SeriesSummary",
    "Smooth",
    "Smoothed",
    "Snapshot",
    "Spikes",
    "StageSummary",
    "Stuck",
    "ThermalBody",
    "TraceTable",
    "Uncertain",
    "Validation",
    "Verdict",
    "Worst",
]

for _name in _measured.__all__:
    getattr(_measured, _name).__module__ = __name__


@dataclass(frozen=True, eq=False, repr=False)
class FitSummary(_Result):
    """How a model was identified: `Model.fit`.

    Attributes
    ----------
    solver : {'nnls', 'ols'}
        How the weights were found.
    smooth : Smooth
        Strengths of the smoothness.
    ridge : float
        Ridge on the weights.
    start : {'off', 'on', 'rest', 'unknown'}
        State of the operators before each recording.
    open_at_start : int
        Number of operators whose state the first sample of a recording does not determine.
    samples : int
        Number of samples fitted.
    rmse : float
        Root mean squared error over them, in the output's unit.
    max_abs : float
        Largest absolute error, in the output's unit.
    nrmse_percent : float
        `rmse` in percent of the measured range.
    weights_not_zero : int
        Number of weights that are not zero.
    simulated : bool
        Whether the recordings came from a simulation.
    file : str or None
        The file fitted, the first of several; None for arrays.
    sha256 : str or None
        Checksum of its bytes.
    other_files : tuple of str
        The other files fitted.
    other_sha256 : tuple of str
        Checksums of their bytes.
    repeats : tuple of SeenFile
        Files that were not fitted, but widened the band.
    outliers : tuple of Outlier
        Readings that were left out of the fit. The errors do not count them.
    validation : Validation or None
        How levels and smoothness were chosen; None where neither was 'auto'.
    hold_out : HeldOut or None
        The errors over what was held out; None where nothing was.
    other : dict
        Further entries of the model file.
    """

    solver: Literal["nnls", "ols"]
    smooth: Smooth
    ridge: float
    start: Literal["off", "on", "rest", "unknown"]
    open_at_start: int
    samples: int
    rmse: float
    max_abs: float
    nrmse_percent: float
    weights_not_zero: int
    simulated: bool
    file: str | None = None
    sha256: str | None = None
    other_files: tuple[str, ...] = ()
    other_sha256: tuple[str, ...] = ()
    repeats: tuple[SeenFile, ...] = ()
    outliers: tuple[Outlier, ...] = ()
    validation: Validation | None = None
    hold_out: HeldOut | _MaybeNone = None
    other: dict[str, Any] = dataclasses.field(default_factory=dict)

    def _repr_html_(self) -> str:
        from . import _html

        return _html.fit(self)


@dataclass(frozen=True, eq=False, repr=False)
class Confidence(_Result):
    """How well the data determine the weights: `Model.confidence`.

    Attributes
    ----------
    levels : ndarray, shape (K,)
        Levels of the plane, in the input's unit.
    standard_error : ndarray, shape (K, K)
        Standard error of each weight, in the output's unit; NaN below the diagonal.
    offset_error : float
        Standard error of the offset, in the output's unit.
    excitation : ndarray, shape (K, K)
        What the input says about each operator, 0 to 3, as `pyhysteron.excitation` returns it.
    rank : int
        Number of combinations of weights that the data determine.
    unknowns : int
        Number of weights, and of initial states where these are unknown.
    condition : float
        Ratio of the best to the worst determined combination.
    noise : float
        Standard deviation of what the weights' uncertainty does not explain, in the output's unit:
        such that the band holds 95 % of the samples that fits left out.
    sensor : float
        Standard deviation of the white noise of the readings, in the output's unit.
    band_name : str
        For what the band holds: '95 % band within its session' or '95 % band of 3 sessions'.
    branches : int
        Branches of the input.
    replicates : int
        Replicates of the bootstrap.
    """

    levels: _Array
    standard_error: _Array
    offset_error: float
    excitation: _Array
    rank: int
    unknowns: int
    condition: float
    noise: float
    sensor: float
    band_name: str
    branches: int
    replicates: int


@dataclass(frozen=True, eq=False, repr=False)
class BandTest(_Result):
    """The 95 % band over a recording.

    Attributes
    ----------
    lower : ndarray, shape (n,)
        Lower end, in the output's unit.
    upper : ndarray, shape (n,)
        Upper end, in the output's unit.
    coverage_percent : float
        Share of the measured samples inside, in percent.
    name : str
        For what it holds: '95 % band within its session' or '95 % band of 3 sessions'.
    """

    lower: _Array
    upper: _Array
    coverage_percent: float
    name: str


@dataclass(frozen=True, eq=False, repr=False)
class InverseRun(_Result):
    """The inverse over the measured output, with one policy.

    Attributes
    ----------
    input_model : ndarray, shape (n,)
        Modelled input, in the input's unit; of a model with a thermal body, the temperature.
    all : Errors
        Over all samples.
    moving : Errors or None
        Over the samples where the output moves; None where it never does.
    dead_band : Errors or None
        Over the samples in the dead band; None where there are none.
    out_of_reach : int
        Number of targets that the model cannot reach.
    """

    input_model: _Array
    all: Errors
    moving: Errors | _MaybeNone
    dead_band: Errors | _MaybeNone
    out_of_reach: int


@dataclass(frozen=True, eq=False, repr=False)
class InverseTest(_Result):
    """The inverse test on a recording.

    Attributes
    ----------
    moving : ndarray of bool, shape (n,)
        Whether the measured output moves; False in the dead band.
    hold : InverseRun
        With the policy 'hold'.
    anticipate : InverseRun
        With the policy 'anticipate'.
    """

    moving: NDArray[np.bool_]
    hold: InverseRun
    anticipate: InverseRun


@dataclass(frozen=True, eq=False, repr=False)
class Verdict(_Result):
    """Whether a model is good enough, and if not, why: `Model.verdict`, `Evaluation.verdict`.

    `print` shows its sentences.

    Attributes
    ----------
    grade : str
        `good` (drive by the inverse alone), `usable` (beside a controller), `poor`, or `untested`
        where the model was tested only on what it was fitted to.
    basis : str
        What it was tested on: `other_recording`, `held_out`, `branches_left_out`, `parts_left_out`
        or `fitted`.
    rmse : float
        Error of the output there, in its unit.
    percent : float or None
        The same in percent of the range; None for an output that does not move.
    noise : float
        Standard deviation of the white noise of the readings, in the output's unit; 0 if unknown.
    inverse : Errors or None
        Errors of the inverse while the output moves; None where it was not tested.
    rival : tuple of str and float, or None
        The best simple predictor, and its error in percent.
    causes : tuple of (str, str)
        Why the model is not better: a word and a sentence each, the weightiest first.
    worst : Worst or None
        Where it errs most; None where no recording was looked at.
    text : str
        All of it in sentences, a line each.
    """

    grade: str
    basis: str
    rmse: float
    percent: float | None
    noise: float
    inverse: Errors | None
    rival: tuple[str, float] | None
    causes: tuple[tuple[str, str], ...]
    worst: Worst | None
    text: str

    def __str__(self) -> str:
        return self.text


@dataclass(frozen=True, eq=False, repr=False)
class Evaluation(_Result):
    """Forward and inverse tests on a recording: `Model.evaluate`.

    Attributes
    ----------
    output_model : ndarray, shape (n,)
        Modelled output, in the output's unit.
    forward : Errors
        Of the modelled output.
    verdict : Verdict
        Whether that is good enough.
    clipped : int
        Number of inputs outside the plane.
    estimated_from : int or None
        Samples at the beginning from which the start was estimated; None where it was given.
    rests : list of float or None
        Of each recording the drive at which the body was at rest before it, found from its
        beginning; None for that of the first sample, and for a model without a body.
    was_fitted : bool
        Whether the model was fitted to the file of this recording. Then the errors say how well it
        fits, not how well it predicts.
    seen_for_band : bool
        Whether the file of this recording was not fitted, but widened the band.
    band : BandTest or None
        The 95 % band; None for a model without confidence.
    inverse : InverseTest or None
        The inverse test; None where the model has no inverse.
    inverse_refused : str or None
        Why there is no inverse test.
    """

    output_model: _Array
    forward: Errors
    verdict: Verdict
    clipped: int
    estimated_from: int | None
    rests: list[float | None]
    was_fitted: bool
    seen_for_band: bool
    band: BandTest | _MaybeNone
    inverse: InverseTest | _MaybeNone
    inverse_refused: str | None


@dataclass(frozen=True, eq=False, repr=False)
class Forward(_Result):
    """A model that ran over the input of a recording: `compare`.

    Attributes
    ----------
    name : str
        Name of the model.
    errors : Errors
        Of the modelled output.
    was_fitted : bool
        Whether the model was fitted to the file of this recording. Then the errors say how well it
        fits, not how well it predicts.
    seen_for_band : bool
        Whether the file of this recording was not fitted, but widened the band.
    residual : ndarray, shape (n,)
        Measured output without the modelled one, in the output's unit.
    output_model : ndarray, shape (n,)
        Modelled output, in the output's unit.
    """

    name: str
    errors: Errors
    was_fitted: bool
    seen_for_band: bool
    residual: _Array
    output_model: _Array


@dataclass(frozen=True, eq=False, repr=False)
class FleetFitted(_Result):
    """What became of a fleet: `pyhysteron.fleet.fit_fleet`.

    Attributes
    ----------
    fitted : int
        Number of actuators in the table.
    resumed : int
        How many of them had been fitted by an earlier call that was ended.
    with_warnings : int
        How many of them have warnings, which are in the table.
    failed : dict of str
        Those that are not in the table, and why.
    notes : tuple of str
        What was assumed about the files.
    choice : str or None
        What the pilots chose for all, in words; None where each chose for itself.
    alone : dict of str
        Those that the choice of the pilots does not serve, so they chose for themselves: their errors on what
        is left out, in percent of their range, with that choice (None where no fit succeeds) and with their own.
    """

    fitted: int
    resumed: int
    with_warnings: int
    failed: dict[str, str]
    notes: tuple[str, ...]
    choice: str | None
    alone: dict[str, tuple[float | None, float]]


@dataclass(frozen=True, eq=False, repr=False)
class LeftOut(_Result):
    """The error on branches that were left out: `left_out`.

    Attributes
    ----------
    predicted : ndarray, shape (n,)
        Output at each sample, from the fit that did not see it, in the output's unit.
    fold : ndarray of int64, shape (n,)
        The group of branches that the sample was left out with.
    nrmse_percent : float
        Error on what was left out, in percent of the measured range.
    training_nrmse_percent : float
        Error over the samples fitted, in percent of the measured range.
    branches : int
        Number of branches of the input.
    chosen : tuple of (int, float)
        Levels and smoothness of each fold.
    """

    predicted: _Array
    fold: NDArray[np.int64]
    nrmse_percent: float
    training_nrmse_percent: float
    branches: int
    chosen: tuple[tuple[int, tuple[float, float]], ...]


@dataclass(frozen=True, eq=False, repr=False)
class Doubt(_Result):
    """A reason not to believe a recording. `prepare` refuses it, unless `believe` is set.

    Attributes
    ----------
    kind : str
        'frozen': a series stands still while the other moves. 'repeated': rows are the same as
        earlier ones. 'gap': the input turned where rows are missing. 'disagree': no model follows
        these rows and the others.
    rows : tuple of (int, int)
        First and last row of each stretch, counted from 1.
    text : str
        The same in words.
    """

    kind: str
    rows: tuple[tuple[int, int], ...]
    text: str


@dataclass(frozen=True, eq=False, repr=False)
class RecordingSummary(_Result):
    """A recording in short: `Recording.summary`.

    Attributes
    ----------
    samples : int
        Number of samples.
    segments : int
        Number of recordings: each has a history of its own.
    input : SeriesSummary
        The input.
    output : SeriesSummary
        The output.
    time : Sampling or None
        The sampling; None without time.
    levels : int
        Levels of the plane that `excited` is counted on.
    plane : tuple of float
        Its lowest and highest level, in the input's unit.
    operators : int
        Number of operators of that plane.
    excited : int
        Number of operators that the input moves. Nothing can be learned of the others.
    rank : int or None
        Number of combinations of their weights that the recording would determine without noise.
        Operators that move together count as one. None for more than 50 levels.
    determined : int or None
        Number of these combinations that the noise of the output leaves: their standard error is at
        most the weight that each operator has where all share the range of the output evenly.
    doubts : tuple of Doubt
        What is not to be believed unasked.
    """

    samples: int
    segments: int
    input: SeriesSummary
    output: SeriesSummary
    time: Sampling | None
    levels: int
    plane: tuple[float, float]
    operators: int
    excited: int
    rank: int | _MaybeNone
    determined: int | _MaybeNone
    doubts: tuple[Doubt, ...]


@dataclass(frozen=True, eq=False, repr=False)
class Preparation(_Result):
    """What `prepare` did. A step that was off, or not needed, is None.

    Attributes
    ----------
    samples_before : int
        Samples of the original recording.
    samples : int
        Samples of the result.
    input_noise : float
        Standard deviation of the input's noise, in its unit.
    output_noise : float
        Standard deviation of the output's noise, in its unit.
    spikes : Spikes or None
        Lost signs and isolated spikes.
    resampled : float or None
        The time step, s.
    low_pass : LowPass or None
        The low-pass.
    lag : SensorLag or None
        The sensor's lag.
    dead_band : DeadBand or None
        The dead band for reversals of the input.
    judged : tuple of Judged
        What each step that was left to the data gained. A step that was not kept has done nothing.
    rate : RateDependence or None
        How much the output depends on the rate of the input; None without time.
    rate_dependent : bool or None
        Whether that is more than a static model can follow.
    """

    samples_before: int
    samples: int
    input_noise: float
    output_noise: float
    spikes: Spikes | _MaybeNone
    resampled: float | None
    low_pass: LowPass | _MaybeNone
    lag: SensorLag | _MaybeNone
    dead_band: DeadBand | _MaybeNone
    judged: tuple[Judged, ...]
    rate: RateDependence | _MaybeNone
    rate_dependent: bool | None


@dataclass(frozen=True, eq=False, repr=False)
class Stuck(_Result):
    """Where a channel stood still while the other one moved: an entry of `AdaptedComparison.stuck`.

    Attributes
    ----------
    channel : str
        'input' or 'output'.
    start : int
        The first sample.
    end : int
        The sample after the last one.
    """

    channel: str
    start: int
    end: int


@dataclass(frozen=True, eq=False, repr=False)
class AdaptedComparison(_Result):
    """Errors with and without learning: `Adapted.comparison`.

    Attributes
    ----------
    whole : Compared
        Over the whole recording.
    thirds : tuple of Compared
        Over each third.
    late : Compared or None
        Over the last third, without readings that were rejected.
    worse : bool
        Whether the model that learned ended no better than the fixed one on the last third (a gain
        below 1 % counts as none), or errs 1 % of its range more on the first third without a gain
        of a tenth on the last.
    probation : int
        Samples at the end that the model did not take over, since no later samples confirm them.
    again : Errors
        Of the last weights, over the whole recording.
    again_late : Compared or None
        The same over the samples of `late`, beside the fixed model.
    again_first : Compared or None
        The same over the first third of the samples.
    late_spread : float
        The standard deviation of the measured output there: what a constant errs.
    counts : OutcomeCounts
        How often each outcome was.
    drift : Drift
        How far weights and offset moved.
    stuck : tuple of Stuck
        Where a channel stood still; what was learned from there is undone.
    cut_off : CutOff or None
        Where the output is cut off though the model goes on: a sensor at its end.
    start : str
        Where the operators began: of an unknown start, the one that was taken.
    covered : float
        The share of the plane's input range that the recordings cover, from 0 to 1.
    session : bool
        Whether the model is the one before with another offset, gain and shift, as of another
        session: from one loop at most, where that errs far less.
    one_load : bool
        Whether the model depended on a load before, and is for one load now: the recording's.
    """

    whole: Compared
    thirds: tuple[Compared, ...]
    late: Compared | None
    worse: bool
    probation: int
    again: Errors
    again_late: Compared | None
    again_first: Compared | None
    late_spread: float
    counts: OutcomeCounts
    drift: Drift
    stuck: tuple[Stuck, ...]
    cut_off: CutOff | None
    start: str
    covered: float
    session: bool
    one_load: bool


@dataclass(frozen=True, eq=False, repr=False)
class Snapshot(_Result):
    """The weights of a controller that adapts: an entry of `control.Trace.snapshots`.

    Attributes
    ----------
    time : float
        Time, s.
    offset : float
        Offset, in the output's unit.
    weights : ndarray, shape (K, K)
        Weights, in the output's unit; NaN below the diagonal.
    """

    time: float
    offset: float
    weights: _Array


@dataclass(frozen=True, eq=False, repr=False)
class Median(_Result):
    """Medians over the seeds, of one controller in one window. None where a value does not exist.

    Attributes
    ----------
    window : str
        The window.
    controller : str
        The controller, in words.
    name : str
        Its name in `Comparison.controllers`.
    rmse : float or None
        Root mean square of output less reference, in the output's unit.
    max_abs : float or None
        Its largest value, in the output's unit.
    prediction_rmse : float or None
        Root mean square of the model's output, before it learned, less the output.
    frozen_rmse : float or None
        The same without learning in the window.
    lag_s : float or None
        Lag after reversals of the reference, s.
    drive_travel : float or None
        Mean change of the drive from sample to sample, as a share of its range.
    saturated : float or None
        Share of samples with the drive at a limit.
    faults : float or None
        Share of samples without a valid reading.
    """

    window: str
    controller: str
    name: str
    rmse: float | None
    max_abs: float | None
    prediction_rmse: float | None
    frozen_rmse: float | None
    lag_s: float | None
    drive_travel: float | None
    saturated: float | None
    faults: float | None


@dataclass(frozen=True, eq=False, repr=False)
class CExport(_Result):
    """What `Model.export_c` wrote.

    Attributes
    ----------
    files : tuple of Path
        The files.
    name : str
        The model's name in C.
    inverse : bool
        Whether there is an inverse.
    rounding : float
        What a target may be missed by that the inverse reports as reached, in the output's unit.
    flash_bytes : int
        Constants, bytes.
    ram_bytes : int
        Memory of each state, bytes.
    step_loop : int
        Loop iterations of one step at most.
    inverse_halvings : int
        Halvings of one inverse step at most.
    controller_bytes : int or None
        Memory of a controller beside two states, bytes; None without one.
    """

    files: tuple[Path, ...]
    name: str
    inverse: bool
    rounding: float
    flash_bytes: int
    ram_bytes: int
    step_loop: int
    inverse_halvings: int
    controller_bytes: int | None


@dataclass(frozen=True, eq=False, repr=False)
class FmuExport(_Result):
    """What `Model.export_fmu` wrote.

    Attributes
    ----------
    name : str
        The block's name.
    token : str
        The token that identifies the model in the FMU.
    bytes : int
        Size of the file.
    inputs : tuple of str
        Names of the inputs.
    outputs : tuple of str
        Names of the outputs.
    parameters : tuple of str
        Names of the parameters.
    """

    name: str
    token: str
    bytes: int
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    parameters: tuple[str, ...]


class _Saved(TypedDict):
    turning_points: _Array
    input: float


class SavedState(_Saved, total=False):
    """A state as plain data: `State.save`, `Model.restore`.

    Attributes
    ----------
    turning_points : ndarray, shape (m,)
        Turning points as positions in ``[0, K]``.
    input : float
        The last input of the operators, in its unit.
    stages : ndarray
        For a model with stages: 0 or 1 for whether there was a sample, the temperature, and what
        each stage behind the operators remembers.
    """

    stages: _Array


class _At(TypedDict):
    at_s: float


class Event(_At, total=False):
    """What happens to a simulated plant in `control.Controller.run`. Only 'at_s' is needed.

    Attributes
    ----------
    at_s : float
        When, s.
    load_n : float
        Load, N.
    room_degc : float
        Room temperature, °C.
    predeformation_mm : float
        Pre-deformation, mm.
    gain : float
        Ageing: the share of its first stroke that the actuator still has.
    stuck : bool
        Whether the output's sensor stands still.
    lost : bool
        Whether the output's sensor reads nothing.
    """

    load_n: float
    room_degc: float
    predeformation_mm: float
    gain: float
    stuck: bool
    lost: bool


class LearningTable(TypedDict):
    """`Adaptive.run` as a table: arrays of shape (n,).

    Attributes
    ----------
    output : ndarray
        Output expected before learning, in its unit.
    error : ndarray
        Measured less expected, in the output's unit.
    outcome : ndarray of str
        As in `Learning`.
    clipped : ndarray of int8
        -1 or 1 where the input lay below or above the plane, else 0.
    """

    output: _Array
    error: _Array
    outcome: NDArray[np.str_]
    clipped: NDArray[np.int8]


class AdaptedTable(TypedDict):
    """`Adapted.table`: arrays of shape (n,).

    Attributes
    ----------
    input : ndarray
        Input, in its unit.
    output : ndarray
        Measured output, in its unit.
    output_model : ndarray
        Output expected before learning, in its unit.
    error : ndarray
        Measured less expected, in the output's unit.
    outcome : ndarray of str
        As in `Learning`.
    """

    input: _Array
    output: _Array
    output_model: _Array
    error: _Array
    outcome: NDArray[np.str_]


class ScoreTable(TypedDict):
    """`Comparison.scores`: a row for each controller, seed and window. NaN where a value does not exist.

    Attributes
    ----------
    controller : list of str
        Name of the controller.
    window : list of str
        The window.
    seed : ndarray of int64
        The seed, from 1.
    from_s : ndarray
        Begin of the window, s.
    to_s : ndarray
        End of the window, s.
    rmse : ndarray
        As in `Median`, as are the following.
    max_abs : ndarray
        As in `Median`.
    prediction_rmse : ndarray
        As in `Median`.
    frozen_rmse : ndarray
        As in `Median`.
    lag_s : ndarray
        As in `Median`.
    drive_travel : ndarray
        As in `Median`.
    saturated : ndarray
        As in `Median`.
    faults : ndarray
        As in `Median`.
    """

    controller: list[str]
    window: list[str]
    seed: NDArray[np.int64]
    from_s: _Array
    to_s: _Array
    rmse: _Array
    max_abs: _Array
    prediction_rmse: _Array
    frozen_rmse: _Array
    lag_s: _Array
    drive_travel: _Array
    saturated: _Array
    faults: _Array


class TraceTable(TypedDict):
    """`control.Trace.to_dict`: arrays of shape (n,), with the meaning of the attributes of `control.Trace`.

    Attributes
    ----------
    time : ndarray
        Time, s.
    reference : ndarray
        In the output's unit.
    output : ndarray
        In its unit.
    measured : ndarray
        In the output's unit.
    input : ndarray
        In its unit.
    command : ndarray
        In the input's unit.
    drive : ndarray
        In its unit.
    prediction : ndarray
        In the output's unit.
    saturated : ndarray of bool
        As in `control.Trace`.
    out_of_reach : ndarray of bool
        As in `control.Trace`.
    sensor_fault : ndarray of bool
        As in `control.Trace`.
    adapted : ndarray of bool
        As in `control.Trace`.
    rejected : ndarray of bool
        As in `control.Trace`.
    stuck : ndarray of bool
        As in `control.Trace`.
    """

    time: _Array
    reference: _Array
    output: _Array
    measured: _Array
    input: _Array
    command: _Array
    drive: _Array
    prediction: _Array
    saturated: NDArray[np.bool_]
    out_of_reach: NDArray[np.bool_]
    sensor_fault: NDArray[np.bool_]
    adapted: NDArray[np.bool_]
    rejected: NDArray[np.bool_]
    stuck: NDArray[np.bool_]

"""Results whose fields are those of a Rust type. Written by python/results: change the structs, or the tables there."""

from dataclasses import dataclass
from typing import Literal

from ._result import _Array, _MaybeNone, _Result

__all__ = [
    "Candidate",
    "Compared",
    "ConfidenceSummary",
    "ConstantSummary",
    "CreepTerm",
    "CutOff",
    "DeadBand",
    "Drift",
    "Errors",
    "HeldOut",
    "Judged",
    "LoadCurves",
    "LoadSummary",
    "LowPass",
    "ModelSummary",
    "OutcomeCounts",
    "Outlier",
    "RateDependence",
    "Ratio",
    "Repairs",
    "RivalErrors",
    "RivalScore",
    "Sampling",
    "SeenFile",
    "SensorLag",
    "SeriesSummary",
    "Smooth",
    "Smoothed",
    "Spikes",
    "StageSummary",
    "ThermalBody",
    "Uncertain",
    "Validation",
    "Worst",
]


@dataclass(frozen=True, eq=False, repr=False)
class Errors(_Result):
    """The differences between a measured and a modelled series.

    Attributes
    ----------
    rmse : float
        Root of the mean squared difference, in the unit of the series.
    max_abs : float
        Largest absolute difference, in the unit of the series.
    nrmse_percent : float or None
        `rmse` in percent of the measured range of the whole series, which wrong readings do not set; None
        where that range is zero.
    samples : int
        Number of samples compared.
    """

    rmse: float
    max_abs: float
    nrmse_percent: float | _MaybeNone
    samples: int


@dataclass(frozen=True, eq=False, repr=False)
class Smooth(_Result):
    """How strongly the weights of neighbours are pulled together, in two directions.

    With `ρ` the density of the weights, and `α`, `β` in units of the plane's width, the penalty is
    `along · ∫∫ (∂ρ/∂α + ∂ρ/∂β)² + across · ∫∫ |∇ρ|²`. It is added to the mean squared error. Both
    strengths have no unit, and their effect does not depend on the number of levels.

    *Along* the diagonal the width `β − α` of an operator stays the same. The density of most materials
    depends on the width more than on where an operator stands. In the limit of a large `along` it
    depends on the width alone, which is a Prandtl-Ishlinskii model. *Across* pulls neighbours in both
    directions together.

    Usual strengths are 1e-10 to 1e-4 along and 1e-10 to 1e-7 across; 0 is none.

    Attributes
    ----------
    along : float
        Strength along the diagonal, 0 to 1e6.
    across : float
        Strength in both directions, 0 to 1e6.
    """

    along: float
    across: float


@dataclass(frozen=True, eq=False, repr=False)
class Candidate(_Result):
    """How good one candidate is.

    Attributes
    ----------
    levels : int
        Number of levels.
    smooth : Smooth
        Strengths of the smoothness.
    rmse : float
        Root mean squared error in the output's unit: over all samples, each left out once. Where the
        evidence chose, over the samples fitted.
    log_evidence : float or None
        Logarithm of the evidence, up to a constant.
    """

    levels: int
    smooth: Smooth
    rmse: float
    log_evidence: float | None = None


@dataclass(frozen=True, eq=False, repr=False)
class RivalScore(_Result):
    """The error of a simple predictor.

    Attributes
    ----------
    name : str
        Its name, such as `straight line`.
    nrmse_percent : float
        Root mean squared error on what was left out, in percent of the measured range.
    """

    name: str
    nrmse_percent: float


@dataclass(frozen=True, eq=False, repr=False)
class Outlier(_Result):
    """A reading that does not belong to its recording. A fit that is robust gives it no weight.

    Attributes
    ----------
    recording : int
        Index of the recording, from 0.
    sample : int
        Index of the sample, from 0.
    by : float
        How far the output is from where its neighbours say, in its unit.
    """

    recording: int
    sample: int
    by: float


@dataclass(frozen=True, eq=False, repr=False)
class Validation(_Result):
    """How levels and smoothness were chosen.

    Attributes
    ----------
    criterion : {'left_out', 'evidence'}
        What chose.
    folds : int
        Number of folds: groups of branches, or of parts of branches, that were left out in turn.
    whole_branches : bool
        Whether whole branches were left out. With fewer than six branches, parts of branches were left out.
    rmse : float
        Error of the candidate that was chosen on what was left out, in the output's unit.
    nrmse_percent : float
        The same error in percent of the measured range.
    scores : tuple of Candidate
        All candidates that were tried.
    rivals : tuple of RivalScore
        Simple predictors on the same samples left out.
    """

    criterion: Literal["left_out", "evidence"]
    folds: int
    whole_branches: bool
    rmse: float
    nrmse_percent: float
    scores: tuple[Candidate, ...]
    rivals: tuple[RivalScore, ...] = ()


@dataclass(frozen=True, eq=False, repr=False)
class SeenFile(_Result):
    """A file that a fit has seen.

    Attributes
    ----------
    file : str
        Its path, as given by the caller.
    sha256 : str
        SHA-256 of its bytes, in hexadecimal.
    """

    file: str
    sha256: str


@dataclass(frozen=True, eq=False, repr=False)
class RivalErrors(_Result):
    """The errors of one simple predictor.

    Attributes
    ----------
    name : str
        Its name, such as `straight line`.
    rmse : float
        Root of the mean squared difference, in the unit of the series.
    max_abs : float
        Largest absolute difference, in the unit of the series.
    nrmse_percent : float or None
        `rmse` in percent of the measured range of the whole series, which wrong readings do not set; None
        where that range is zero.
    samples : int
        Number of samples compared.
    """

    name: str
    rmse: float
    max_abs: float
    nrmse_percent: float | None
    samples: int


@dataclass(frozen=True, eq=False, repr=False)
class HeldOut(_Result):
    """The errors over samples that took no part in a fit.

    Attributes
    ----------
    model : Errors
        Errors of the model.
    rivals : tuple of RivalErrors
        Errors of simple predictors, fitted to the same samples as the model.
    without_dynamics : bool
        Whether no dead time, ring, lag or body was looked for, because more than the end of a recording was
        held out.
    at_end : bool
        Whether a share of the branches was held out at the end, and not spread over each recording.
    """

    model: Errors
    rivals: tuple[RivalErrors, ...]
    without_dynamics: bool
    at_end: bool


@dataclass(frozen=True, eq=False, repr=False)
class ThermalBody(_Result):
    """A lumped thermal body: `T' = (T∞ − T)/τ` with `T∞ = ambient + gain · drive`. It has one time
    constant for heating (`T∞ > T`) and one for cooling.

    If no temperature was measured, gain and ambient temperature cannot be identified. They are then 1
    and 0, and the temperature is in units of the drive that holds it constant. The drive must be
    proportional to the heating power, as a duty cycle is. Of a current or a voltage, give the square.

    The drive of a sample is the one that was held since the sample before.

    Attributes
    ----------
    gain : float
        Temperature at rest per unit of the drive; above zero.
    tau_heating : float
        Time constant of heating in seconds; above zero.
    tau_cooling : float
        Time constant of cooling in seconds; above zero.
    ambient : float
        Temperature at rest without a drive.
    """

    gain: float
    tau_heating: float
    tau_cooling: float
    ambient: float = 0.0


@dataclass(frozen=True, eq=False, repr=False)
class CreepTerm(_Result):
    """One term of the creep: a first-order lag of the operators' sum, which is added to it.

    Attributes
    ----------
    coefficient : float
        Share of the operators' sum that creeps; 0 or more.
    tau : float
        Time constant in seconds; above zero.
    """

    coefficient: float
    tau: float


@dataclass(frozen=True, eq=False, repr=False)
class LoadCurves(_Result):
    """What a load does, as curves over the load: piecewise linear between the loads given.

    The load shifts and scales the axis of the operators, `x = a(σ) · T − s(σ)`, and changes stroke and
    offset, `y = offset + o(σ) ± g(σ) · Σ μ γ`. Under stress a shape-memory alloy transforms at a higher
    temperature (Clausius and Clapeyron), and its stroke grows. Weights alone cannot follow the first,
    because they do not move along the axis.

    A curve that is empty has no effect.

    Attributes
    ----------
    loads : ndarray, shape (m,)
        The loads, ascending.
    shifts : ndarray, shape (m,) or (0,)
        The shift `s` at each load, in the input's unit.
    scales : ndarray, shape (m,) or (0,)
        The scale `a` at each load, above zero.
    gains : ndarray, shape (m,) or (0,)
        The gain `g` at each load, above zero.
    offsets : ndarray, shape (m,) or (0,)
        The offset `o` at each load, in the output's unit.
    """

    loads: _Array
    shifts: _Array
    scales: _Array
    gains: _Array
    offsets: _Array


@dataclass(frozen=True, eq=False, repr=False)
class LoadSummary(_Result):
    """The load that the weights of a model depend on.

    Attributes
    ----------
    name : str
        Its name.
    unit : str or None
        Its unit.
    min : float
        Smallest load that the model was identified at.
    max : float
        Largest load that the model was identified at.
    order : int
        Order of the weights as a function of the load.
    """

    name: str
    unit: str | None
    min: float
    max: float
    order: int


@dataclass(frozen=True, eq=False, repr=False)
class Uncertain(_Result):
    """A weight and its standard error.

    Attributes
    ----------
    i : int
        Index `i` of the level of `α`, from 1.
    j : int
        Index `j` of the level of `β`, from `i`.
    weight : float
        The weight `μ_ij`.
    standard_error : float
        Its standard error.
    """

    i: int
    j: int
    weight: float
    standard_error: float


@dataclass(frozen=True, eq=False, repr=False)
class ConfidenceSummary(_Result):
    """Short form of `Confidence`: how well the data determine the weights.

    Attributes
    ----------
    excitation : dict of int
        Number of operators in each class, from the least known to the best known.
    rank : int
        Number of combinations of unknowns that the data determine.
    unknowns : int
        Number of unknowns.
    condition : float or None
        Condition number: ratio of the best to the worst determined combination.
    noise : float
        Standard deviation of the residuals, in the output's unit.
    replicates : int
        Number of bootstrap replicates.
    offset_error : float
        Standard error of the offset, in the output's unit.
    least_certain : tuple of Uncertain
        The weights with the largest standard errors, largest first.
    """

    excitation: dict[str, int]
    rank: int
    unknowns: int
    condition: float | None
    noise: float
    replicates: int
    offset_error: float
    least_certain: tuple[Uncertain, ...]


@dataclass(frozen=True, eq=False, repr=False)
class ConstantSummary(_Result):
    """A constant of a stage.

    Attributes
    ----------
    name : str
        Its name.
    unit : str or None
        The unit of its numbers; None for none, and where the model does not know it.
    numbers : tuple of float
        Its numbers.
    """

    name: str
    unit: str | None
    numbers: tuple[float, ...]


@dataclass(frozen=True, eq=False, repr=False)
class StageSummary(_Result):
    """A stage that a model has.

    Attributes
    ----------
    name : str
        Its name.
    about : str
        What it does, in one sentence.
    constants : tuple of ConstantSummary
        Its constants.
    """

    name: str
    about: str
    constants: tuple[ConstantSummary, ...]


@dataclass(frozen=True, eq=False, repr=False)
class ModelSummary(_Result):
    """Summary of a model.

    Attributes
    ----------
    levels : int
        Number of levels of the plane.
    plane : tuple of two float
        Lowest and highest level, in the unit of the operators' input.
    steps : tuple of two float
        Smallest and largest distance between neighbouring levels, in that unit.
    operators : int
        Number of operators.
    weights_not_zero : int
        Number of weights that are not zero.
    weights_below_zero : int
        Number of negative weights. If there are any, the model has no inverse.
    output : tuple of two float
        Output with every operator off, and with every operator on.
    widest_loop : float
        Width of the widest loop: the largest difference between the falling and the rising major branch, in
        the output's unit.
    widest_loop_at : float
        The input at which the loop is widest.
    load : LoadSummary or None
        The load that the weights depend on, if they do.
    stages : tuple of StageSummary
        Its stages, in the order of the signal.
    confidence : ConfidenceSummary or None
        Confidence in the weights, if the fit estimated it.
    delay_s : float or None
        Dead time of the actuator, s; absent where there is none.
    """

    levels: int
    plane: tuple[float, float]
    steps: tuple[float, float]
    operators: int
    weights_not_zero: int
    weights_below_zero: int
    output: tuple[float, float]
    widest_loop: float
    widest_loop_at: float
    load: LoadSummary | None
    stages: tuple[StageSummary, ...]
    confidence: ConfidenceSummary | None
    delay_s: float | None = None


@dataclass(frozen=True, eq=False, repr=False)
class Worst(_Result):
    """The sample with the largest error.

    Attributes
    ----------
    file : str or None
        The file of a recording that was held out; None in what was fitted or evaluated.
    recording : int
        Index of the recording, from 0.
    sample : int
        Index of the sample in it, from 0.
    time : float or None
        Its time in seconds; None without time.
    input : float
        The input there.
    measured : float
        The output measured.
    modelled : float
        The output of the model.
    """

    file: str | None
    recording: int
    sample: int
    time: float | None
    input: float
    measured: float
    modelled: float


@dataclass(frozen=True, eq=False, repr=False)
class SeriesSummary(_Result):
    """One series of a recording.

    Attributes
    ----------
    name : str
        Its name.
    unit : str or None
        Its unit.
    min : float
        Smallest value.
    max : float
        Largest value.
    reversals : int
        Number of turning points, without reversals up to 1 % of the range.
    reversals_of_any_size : int
        Number of turning points of any size. Many more than `reversals` indicate noise.
    """

    name: str
    unit: str | None
    min: float
    max: float
    reversals: int
    reversals_of_any_size: int


@dataclass(frozen=True, eq=False, repr=False)
class Sampling(_Result):
    """How a recording was sampled.

    Attributes
    ----------
    start : float
        Time of the first sample, in seconds.
    end : float
        Time of the last sample, in seconds. A clock that was set back may have it before the first.
    median_step : float
        Median time between samples of one recording, in seconds.
    longest_step : float
        Longest time between samples, in seconds.
    longest_step_before_sample : int
        The sample after the longest step, counted from 1.
    gaps : int
        Number of gaps: steps of more than three times the median.
    repeated : int
        Number of samples with the same time as the sample before.
    """

    start: float
    end: float
    median_step: float
    longest_step: float
    longest_step_before_sample: int
    gaps: int
    repeated: int


@dataclass(frozen=True, eq=False, repr=False)
class Judged(_Result):
    """What a step was worth. The errors are those of a small model on what it was not fitted to, in the
    unit of the output: mean distances from the output as measured, over the samples whose input the
    step changes, or whose output it does not change; for a low-pass, the root of the mean squared
    distance from the output of a simulated recording like this one, without its noise.

    Attributes
    ----------
    step : str
        The step, and the series that it changes.
    samples : int
        Number of samples that it changes.
    before : float or None
        The error without the step; None if no model can be fitted.
    after : float or None
        The error with the step; None if no model can be fitted.
    kept : bool
        Whether the step was taken.
    """

    step: str
    samples: int
    before: float | _MaybeNone
    after: float | _MaybeNone
    kept: bool


@dataclass(frozen=True, eq=False, repr=False)
class Repairs(_Result):
    """Repaired samples of one series.

    Attributes
    ----------
    signs : int
        Number of samples whose sign was restored.
    spikes : int
        Number of samples that were replaced by linear interpolation between their neighbours.
    first : tuple of int
        The first ten of both, counted from 1 in the recording before the preparation.
    """

    signs: int
    spikes: int
    first: tuple[int, ...]


@dataclass(frozen=True, eq=False, repr=False)
class Spikes(_Result):
    """Repaired signs and removed spikes.

    Attributes
    ----------
    deviations : float or None
        A sample is a spike if it is more than this many median absolute deviations from its neighbours;
        None if only signs were restored.
    input : Repairs
        Repairs of the input.
    output : Repairs
        Repairs of the output.
    """

    deviations: float | _MaybeNone
    input: Repairs
    output: Repairs


@dataclass(frozen=True, eq=False, repr=False)
class Smoothed(_Result):
    """The low-pass filter of one series.

    Attributes
    ----------
    cutoff : float
        The frequency at which its gain is ½.
    removed : float
        Root mean square of the part removed, in the unit of the series.
    """

    cutoff: float
    removed: float


@dataclass(frozen=True, eq=False, repr=False)
class LowPass(_Result):
    """The zero-phase low-pass filter.

    Attributes
    ----------
    input : Smoothed or None
        Filter of the input; None if there was too little noise.
    output : Smoothed or None
        Filter of the output; None if there was too little noise.
    in_hertz : bool
        Whether the cut-offs are in Hz; otherwise they are in cycles per sample.
    """

    input: Smoothed | None
    output: Smoothed | None
    in_hertz: bool


@dataclass(frozen=True, eq=False, repr=False)
class SensorLag(_Result):
    """The lag of the input's sensor.

    Attributes
    ----------
    undone : float or None
        The time constant that was undone, s; None if no lag improved the fit enough.
    estimate : float or None
        The time constant that gives the best fit of a static model, s, if it was estimated.
    rmse_before : float or None
        RMSE of the static model before, in the output's unit.
    rmse_after : float or None
        RMSE of the static model with the estimated lag undone, in the output's unit.
    one_speed : float or None
        The speed of the input per second, if a lag was estimated where all was recorded at about the same.
        A lag and a wider loop are then alike, so at other speeds it may be wrong.
    """

    undone: float | None
    estimate: float | None
    rmse_before: float | None
    rmse_after: float | None
    one_speed: float | None


@dataclass(frozen=True, eq=False, repr=False)
class DeadBand(_Result):
    """The dead band for reversals of the input.

    Attributes
    ----------
    size : float
        Largest reversal that is taken as noise, in the input's unit.
    false_reversals : int
        Number of reversals removed.
    samples_changed : int
        Number of samples changed.
    largest_change : float
        Largest change of a sample, in the input's unit.
    """

    size: float
    false_reversals: int
    samples_changed: int
    largest_change: float


@dataclass(frozen=True, eq=False, repr=False)
class RateDependence(_Result):
    """How much the output depends on the rate of the input, beyond what a static model can follow.

    Attributes
    ----------
    percent : float
        Root mean square of the residual that only rate explains, in percent of the output's range:
        `nrmse_percent · √(r2_time − r2_path)`.
    r2_time : float
        R² of the static model's residual, explained by lags in time.
    r2_path : float
        R² of the same residual, explained by lags over the path of the input.
    time_constant : float
        The time constant that explains most, s.
    nrmse_percent : float
        Error of the static model (20 levels), in percent of the output's range.
    """

    percent: float
    r2_time: float
    r2_path: float
    time_constant: float
    nrmse_percent: float


@dataclass(frozen=True, eq=False, repr=False)
class Compared(_Result):
    """Errors of the adapting model, taken before it learned from each sample, beside those of the fixed
    model.

    Attributes
    ----------
    adapting : Errors
        Errors of the adapting model.
    fixed : Errors
        Errors of the model that was not adapted.
    """

    adapting: Errors
    fixed: Errors


@dataclass(frozen=True, eq=False, repr=False)
class OutcomeCounts(_Result):
    """How often each `Outcome` occurred.

    Attributes
    ----------
    learned : int
        Samples that the estimator learned from.
    waiting : int
        Samples with an error within the dead zone, or with an increment that was not complete.
    at_rest : int
        Samples at which the input did not move.
    rolled_back : int
        Times that the last good weights were restored.
    rejected : int
        Readings rejected because they were too far from the expected output.
    stuck : int
        Samples at which a channel stood still while the other one moved.
    outside : int
        Inputs outside the plane, clipped to its end. They are also counted above.
    """

    learned: int
    waiting: int
    at_rest: int
    rolled_back: int
    rejected: int
    stuck: int
    outside: int


@dataclass(frozen=True, eq=False, repr=False)
class Drift(_Result):
    """How far the model has changed.

    Attributes
    ----------
    weights : tuple of two float
        Sum of the weights before and after. For MKP it is the stroke from all operators off to all on; for
        KP and relay the stroke is twice this sum.
    offset : tuple of two float
        Offset before and after.
    moved : float or None
        Sum of the absolute changes of the weights, over the sum before; infinite if that is zero.
    lift : float
        How far the output with all operators off moved, as a share of the range before.
    gain : float or None
        The stroke after over the stroke before, less 1.
    shift : float
        How far the operators moved along the input's axis, in the mean, as a share of the plane.
    """

    weights: tuple[float, float]
    offset: tuple[float, float]
    moved: float | None
    lift: float
    gain: float | None
    shift: float


@dataclass(frozen=True, eq=False, repr=False)
class CutOff(_Result):
    """Readings at an end of the output's range, which the output reaches again and again, and keeps to the
    last digit while the input goes on.

    Attributes
    ----------
    value : float
        The value, in the output's unit.
    times : int
        How often the output came there.
    samples : int
        Number of such readings.
    """

    value: float
    times: int
    samples: int


@dataclass(frozen=True, eq=False, repr=False)
class Ratio(_Result):
    """A controller beside the one that it has to be better than: medians over the seeds of the ratios.

    Attributes
    ----------
    window : str
        The window.
    controller : str
        The controller.
    name : str
        Its name in a scenario.
    compared_with : str
        What it is compared with.
    rmse : float or None
        Ratio of the tracking errors (RMSE).
    prediction_rmse : float or None
        Ratio of the prediction errors; NaN where one of them has no model.
    """

    window: str
    controller: str
    name: str
    compared_with: str
    rmse: float | None
    prediction_rmse: float | None

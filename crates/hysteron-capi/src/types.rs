//! Constants and structures of the interface, and their counterparts in the library.

use crate::codes::HYSTERON_VALUE;
use crate::fault::{Fault, Result};
use hysteron::{
    Adaptation, Clipped, Direction, Learning, Method, Operator, Outcome, Sign, Status, Target,
};

/// Operator: modified Krasnosel'skii-Pokrovskii, 0 to 1.
pub const HYSTERON_MKP: i32 = 0;
/// Operator: Krasnosel'skii-Pokrovskii, −1 to 1.
pub const HYSTERON_KP: i32 = 1;
/// Operator: relay of the classical Preisach model, −1 or 1.
pub const HYSTERON_RELAY: i32 = 2;

/// Policy of the inverse: hold. The input stands still while the target does.
pub const HYSTERON_HOLD: i32 = 0;
/// Policy of the inverse: the target rises next. The input crosses a dead band at once.
pub const HYSTERON_RISING: i32 = 1;
/// Policy of the inverse: the target falls next. The input crosses a dead band at once.
pub const HYSTERON_FALLING: i32 = -1;

/// The target is reached, or the input lies inside the plane.
pub const HYSTERON_INSIDE: i32 = 0;
/// The target lies below every output, or the input below the plane.
pub const HYSTERON_LOW: i32 = -1;
/// The target lies above every output, or the input above the plane.
pub const HYSTERON_HIGH: i32 = 1;
/// The target lies inside a jump of a relay model. The output lies beyond it.
pub const HYSTERON_PASSED: i32 = 2;
/// The model can give the target, but not in this sample: the input is at an end of its range, or
/// a stage is too slow. The input goes as far as it can.
pub const HYSTERON_LIMITED: i32 = 3;

/// Start of a state: as a new one. It is what the fit found before the first sample, or off.
pub const HYSTERON_START_FITTED: i32 = 0;
/// Start of a state: every operator off.
pub const HYSTERON_START_OFF: i32 = 1;
/// Start of a state: every operator on.
pub const HYSTERON_START_ON: i32 = 2;

/// Method of adaptation: normalised gradient on increments.
pub const HYSTERON_INCREMENTS: i32 = 1;
/// Method of adaptation: recursive least squares with regularised forgetting.
pub const HYSTERON_LEAST_SQUARES: i32 = 2;

/// Outcome of a sample: the weights moved.
pub const HYSTERON_LEARNED: i32 = 0;
/// Outcome of a sample: the error lies within the dead zone, or an increment is not finished.
pub const HYSTERON_WAITING: i32 = 1;
/// Outcome of a sample: the input did not move.
pub const HYSTERON_AT_REST: i32 = 2;
/// Outcome of a sample: the estimator is frozen.
pub const HYSTERON_FROZEN: i32 = 3;
/// Outcome of a sample: the last good weights are back.
pub const HYSTERON_ROLLED_BACK: i32 = 4;
/// Outcome of a sample: the reading is taken as an outlier.
pub const HYSTERON_REJECTED: i32 = 5;
/// Outcome of a sample: the output stands still while the input moves. What was learned since is
/// undone.
pub const HYSTERON_OUTPUT_STUCK: i32 = 6;
/// Outcome of a sample: the input stands still while the output moves. What was learned since is
/// undone.
pub const HYSTERON_INPUT_STUCK: i32 = 7;

/// Properties of a model.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct HysteronModelInfo {
    /// `HYSTERON_MKP`, `HYSTERON_KP` or `HYSTERON_RELAY`.
    pub operator_kind: i32,
    /// 1: the output rises with the input; −1: it falls.
    pub sign: i32,
    /// `K`, the number of levels.
    pub levels: usize,
    /// `N = K(K + 1)/2`, the number of operators.
    pub weights: usize,
    /// Lowest level, in the unit of the operators' input. That is the temperature with a thermal
    /// body; with levels at unequal distances the plane only numbers them.
    pub min: f64,
    /// Highest level, in the same unit.
    pub max: f64,
    /// One step below the lowest level, in the same unit. Every operator is off there.
    pub bottom: f64,
    /// Offset: what is added to the sum of the operators. Of a model that depends on a load, offset
    /// and outputs are those without its curves, at the middle of the load range.
    pub offset: f64,
    /// Output with every operator off.
    pub output_off: f64,
    /// Output with every operator on.
    pub output_on: f64,
    /// Default tolerance for reversals of a target: 1 % of the output's range.
    pub usual_tolerance: f64,
}

/// What a model needs beside its input, and in which ranges.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct HysteronModelNeeds {
    /// 1 if the model depends on time, so that samples need `dt`; else
    /// 0.
    pub time: i32,
    /// 1 if the model depends on a load, which samples then need; else 0.
    pub load: i32,
    /// 1 if the model has a thermal body, so that its input is a drive; else 0.
    pub body: i32,
    /// 1 if the fit found a state before the first sample, in which states start; else 0.
    pub fitted_start: i32,
    /// Smallest load, in its unit. NaN without a load.
    pub load_min: f64,
    /// Largest load. NaN without a load.
    pub load_max: f64,
    /// Lowest drive of the inverse, in the input's unit. `-INFINITY` without a thermal body.
    pub drive_min: f64,
    /// Highest drive of the inverse. `INFINITY` without a thermal body.
    pub drive_max: f64,
    /// Where the operators are at their lowest: the temperature with a thermal body, else the
    /// input; with a load, at the middle of its range.
    pub active_min: f64,
    /// Where the operators are at their highest.
    pub active_max: f64,
}

/// Options of adaptation. `hysteron_adaptation_default` writes the defaults.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct HysteronAdaptation {
    /// `HYSTERON_INCREMENTS` or `HYSTERON_LEAST_SQUARES`.
    pub method: i32,
    /// Samples learned from after which weights are compared with the last good ones, from 1.
    pub trial: u32,
    /// Increments: fraction of the error that an increment removes, above 0 and below 2.
    pub gain: f64,
    /// Increments: levels from the start of an increment to its end, 1/8 to 8.
    pub span: f64,
    /// Least squares: forgetting factor, above 0 and up to 1. 1 forgets nothing.
    pub forgetting: f64,
    /// Least squares: standard deviation of a reading's error, in the output's unit; above 0.
    pub noise: f64,
    /// Least squares: standard deviation of a weight from the off-line one, in the output's unit;
    /// above 0.
    pub spread: f64,
    /// Least squares: levels over which deviations of weights are correlated, from 0.
    pub correlation: f64,
    /// How freely the offset moves, relative to one weight, from 0.
    pub offset_share: f64,
    /// Errors up to this are noise, in the output's unit, from 0.
    pub dead_zone: f64,
    /// Fraction of the way that weights return to the off-line ones with each update, 0 to 1.
    pub leakage: f64,
    /// Levels between two samples that are learned from, from 0.
    pub movement: f64,
    /// Readings with a surprise above so many times the usual one are refused, from 2. 0: none is.
    pub gate: f64,
    /// So many refused readings in a row that agree are learned from, from 1.
    pub burst: u32,
}

/// Result of a step that learns.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct HysteronLearning {
    /// Output predicted before the estimator learned from the sample.
    pub output: f64,
    /// Measured output less predicted output.
    pub error: f64,
    /// Outcome: `HYSTERON_LEARNED` to `HYSTERON_INPUT_STUCK`.
    pub outcome: i32,
    /// Where the input lay: `HYSTERON_INSIDE`, `HYSTERON_LOW` or `HYSTERON_HIGH`.
    pub clipped: i32,
}

/// Fills in the usual options, of the method that `method` names.
///
/// Three cannot follow from a model here: `noise` is 0.01, `spread` 1 and `offset_share` 1. Set
/// them in the output's unit; `docs/options.md` says how the library chooses them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_adaptation_default(
    method: i32,
    options: *mut HysteronAdaptation,
) -> i32 {
    crate::fault::guard(|| {
        // SAFETY: the contract of the crate.
        let options = unsafe { crate::pointer::Arguments::default().out(options, "options")? };
        let usual = Adaptation::<f64>::default();
        let filled = HysteronAdaptation {
            method,
            trial: usual.trial,
            gain: 0.3,
            span: 1.0,
            forgetting: 0.999,
            noise: 0.01,
            spread: 1.0,
            correlation: 1.0,
            offset_share: usual.offset_share,
            dead_zone: usual.dead_zone,
            leakage: usual.leakage,
            movement: usual.movement,
            gate: usual.gate,
            burst: usual.burst,
        };
        filled.adaptation()?;
        options.set(filled);
        Ok(())
    })
}

impl HysteronAdaptation {
    pub(crate) fn adaptation(&self) -> Result<Adaptation<f64>> {
        let &Self {
            gain,
            span,
            forgetting,
            noise,
            spread,
            correlation,
            ..
        } = self;
        let method = match self.method {
            HYSTERON_INCREMENTS => Method::Increments { gain, span },
            HYSTERON_LEAST_SQUARES => Method::LeastSquares {
                forgetting,
                noise,
                spread,
                correlation,
            },
            _ => return Err(Fault::Call(HYSTERON_VALUE, "method")),
        };
        Ok(Adaptation {
            method,
            offset_share: self.offset_share,
            dead_zone: self.dead_zone,
            leakage: self.leakage,
            movement: self.movement,
            trial: self.trial,
            gate: self.gate,
            burst: self.burst,
        })
    }
}

impl From<Learning<f64>> for HysteronLearning {
    fn from(learning: Learning<f64>) -> Self {
        Self {
            output: learning.output,
            error: learning.error,
            outcome: match learning.outcome {
                Outcome::Learned => HYSTERON_LEARNED,
                Outcome::Waiting => HYSTERON_WAITING,
                Outcome::AtRest => HYSTERON_AT_REST,
                Outcome::Frozen => HYSTERON_FROZEN,
                Outcome::RolledBack => HYSTERON_ROLLED_BACK,
                Outcome::Rejected => HYSTERON_REJECTED,
                Outcome::OutputStuck => HYSTERON_OUTPUT_STUCK,
                Outcome::InputStuck => HYSTERON_INPUT_STUCK,
            },
            clipped: clipped(learning.clipped),
        }
    }
}

pub(crate) fn operator(value: i32) -> Result<Operator> {
    match value {
        HYSTERON_MKP => Ok(Operator::Mkp),
        HYSTERON_KP => Ok(Operator::Kp),
        HYSTERON_RELAY => Ok(Operator::Relay),
        _ => Err(Fault::Call(HYSTERON_VALUE, "operator_kind")),
    }
}

pub(crate) fn operator_kind(operator: Operator) -> i32 {
    match operator {
        Operator::Mkp => HYSTERON_MKP,
        Operator::Kp => HYSTERON_KP,
        Operator::Relay => HYSTERON_RELAY,
    }
}

pub(crate) fn sign(value: i32) -> Result<Sign> {
    match value {
        1 => Ok(Sign::Positive),
        -1 => Ok(Sign::Negative),
        _ => Err(Fault::Call(HYSTERON_VALUE, "sign")),
    }
}

pub(crate) fn target(output: f64, heading: i32, tolerance: f64) -> Result<Target<f64>> {
    let heading = match heading {
        HYSTERON_HOLD => None,
        HYSTERON_RISING => Some(Direction::Rising),
        HYSTERON_FALLING => Some(Direction::Falling),
        _ => return Err(Fault::Call(HYSTERON_VALUE, "heading")),
    };
    Ok(Target {
        output,
        heading,
        tolerance,
    })
}

pub(crate) fn heading(heading: Direction) -> i32 {
    match heading {
        Direction::Rising => HYSTERON_RISING,
        Direction::Falling => HYSTERON_FALLING,
    }
}

/// The numbers of `HYSTERON_INSIDE`, `HYSTERON_LOW`, `HYSTERON_HIGH`, `HYSTERON_PASSED` and
/// `HYSTERON_LIMITED`.
pub(crate) fn status(status: Status) -> i32 {
    status.number().into()
}

pub(crate) fn clipped(clipped: Option<Clipped>) -> i32 {
    match clipped {
        None => HYSTERON_INSIDE,
        Some(Clipped::Low) => HYSTERON_LOW,
        Some(Clipped::High) => HYSTERON_HIGH,
    }
}

/// A number that may be missing, which is NaN in C.
pub(crate) fn given(value: f64) -> Option<f64> {
    (!value.is_nan()).then_some(value)
}

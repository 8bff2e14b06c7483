//! Values of options: their types, ranges and messages.

use clap::ValueEnum;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use hysteron::Step;
use hysteron::control::Gains;

/// What is done or not, without a value.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum OnOff {
    On,
    Off,
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum Operator {
    /// Continuous, from 0 to 1
    Mkp,
    /// Continuous, from -1 to +1
    Kp,
    /// The classical Preisach relay, -1 or +1
    Relay,
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum Solver {
    /// Weights of zero and above: a monotone model, which has an inverse
    Nnls,
    /// Plain least squares: any weights, as a rule without an inverse
    Ols,
}

/// The start of a fit.
#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum FitStart {
    /// At rest, unless an unknown start predicts clearly better
    Auto,
    /// All off, as after the lowest input
    Off,
    /// All on, as after the highest input
    On,
    /// All off, then at rest at an input that is found
    Rest,
    /// Not known: estimated together with the weights
    Unknown,
}

impl From<FitStart> for hysteron::Choice<hysteron::Start> {
    fn from(start: FitStart) -> Self {
        match start {
            FitStart::Auto => Self::Auto,
            FitStart::Off => Self::Fixed(hysteron::Start::Off),
            FitStart::On => Self::Fixed(hysteron::Start::On),
            FitStart::Rest => Self::Fixed(hysteron::Start::Rest),
            FitStart::Unknown => Self::Fixed(hysteron::Start::Unknown),
        }
    }
}

/// What happens to outliers.
#[derive(Clone, Copy, PartialEq, ValueEnum)]
pub(crate) enum Robust {
    /// They are found and left out of the fit
    Auto,
    /// Every reading has the same weight
    Off,
}

/// The start of an adaptation.
#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum AdaptStart {
    /// The state that the model's fit found; all off if it found none
    Fitted,
    /// All off, as after the lowest input
    Off,
    /// All on, as after the highest input
    On,
    /// Found: all off, then at rest at one input or two, before the first sample; not with the
    /// method `load`
    Rest,
    /// The fitted one, unless the model as it is errs 1.5 times less from another of these
    Unknown,
}

/// The start of a model that runs.
#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum RunStart {
    /// The state that the model's fit found; all off if it found none
    Fitted,
    /// All off, as after the lowest input
    Off,
    /// All on, as after the highest input
    On,
}

/// The start of a model that is judged.
#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum Start {
    /// The state that the model's fit found; all off if it found none
    Fitted,
    /// All off, as after the lowest input
    Off,
    /// All on, as after the highest input
    On,
    /// All off, then at rest at the input that explains the beginning of the recording
    Rest,
    /// Not known: estimated from the beginning of the recording
    Unknown,
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum LoadLaw {
    /// A registration, or one of the others: what predicts loads left out best
    Auto,
    /// It shifts the axis of the operators, and weights and offset follow it with a low order
    Shift,
    /// Weights and offset only
    Weights,
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum Spacing {
    /// At equal distances
    Uniform,
    /// Close together where the output moves
    Auto,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Dynamics {
    /// A ring where the recording excites one and it predicts parts left out; else nothing
    Auto,
    /// Nothing
    Off,
    /// As --lag auto
    Lag,
    /// The best ring, excited or not
    Ring,
}

/// The order of the weights in the load, or the choice of one.
#[derive(Clone, Copy)]
pub(crate) enum Degree {
    Auto,
    Fixed(usize),
}

pub(super) fn parse_degree(text: &str) -> Result<Degree, String> {
    match (text.trim(), text.trim().parse()) {
        ("auto", _) => Ok(Degree::Auto),
        (_, Ok(degree)) if degree <= 5 => Ok(Degree::Fixed(degree)),
        _ => Err("`auto` or a whole number from 0 to 5 is needed".into()),
    }
}

/// What is held out of a fit.
#[derive(Clone)]
pub(crate) enum HoldOut {
    /// A part of each recording.
    Part(hysteron::HoldOut),
    /// Another recording.
    File(std::path::PathBuf),
}

pub(super) fn parse_hold_out(text: &str) -> Result<HoldOut, String> {
    // A number, a span or a word with a colon is no file, unless there is one.
    let is_part =
        |text: &str| text.contains(':') || text.chars().all(|c| "0123456789.-".contains(c));
    let is_file = text == "-" || std::path::Path::new(text).exists();
    match text.parse() {
        Ok(part) => Ok(HoldOut::Part(part)),
        Err(hysteron::Error::Fit(problem)) if is_part(text) && !is_file => Err(problem),
        Err(_) => Ok(HoldOut::File(text.into())),
    }
}

impl RunStart {
    /// The state that a model starts from.
    pub(crate) fn state(self, model: &hysteron::Model) -> hysteron::State {
        match self {
            Self::Fitted => model.start(),
            Self::Off => model.off(),
            Self::On => model.saturated(),
        }
    }
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum Thermal {
    /// One heat capacity, with a time constant for heating and one for cooling
    FirstOrder,
    /// The same, and heat that the transformation binds, where that predicts what is left out
    Auto,
}

impl From<Thermal> for hysteron::Thermal {
    fn from(thermal: Thermal) -> Self {
        match thermal {
            Thermal::FirstOrder => Self::FirstOrder,
            Thermal::Auto => Self::Auto,
        }
    }
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum Policy {
    /// The input rests while the target rests
    Hold,
    /// The input crosses the dead band as soon as the target is known to reverse
    Anticipate,
}

/// The learners by their names. One that is gone is refused with what to take.
pub(super) fn learners() -> impl TypedValueParser<Value = hysteron::Learner> {
    let known = hysteron::Learner::ALL
        .map(|learner| PossibleValue::new(learner.name()).help(learner.purpose()));
    let gone = PossibleValue::new("gradient").hide(true);
    let values = known.into_iter().chain([gone]);
    PossibleValuesParser::new(values).try_map(|name| name.parse::<hysteron::Learner>())
}

#[derive(Clone, Copy, ValueEnum)]
pub(crate) enum Sign {
    /// The better one
    Auto,
    /// The output rises with the input
    Positive,
    /// The output falls as the input rises, as a strain recovered on heating does
    Negative,
}

impl From<AdaptStart> for hysteron::Start {
    fn from(start: AdaptStart) -> Self {
        match start {
            AdaptStart::Fitted => Self::Fitted,
            AdaptStart::Off => Self::Off,
            AdaptStart::On => Self::On,
            AdaptStart::Rest => Self::Rest,
            AdaptStart::Unknown => Self::Unknown,
        }
    }
}

impl From<Start> for hysteron::Start {
    fn from(start: Start) -> Self {
        match start {
            Start::Fitted => Self::Fitted,
            Start::Off => Self::Off,
            Start::On => Self::On,
            Start::Rest => Self::Rest,
            Start::Unknown => Self::Unknown,
        }
    }
}

impl From<Operator> for hysteron::Operator {
    fn from(operator: Operator) -> Self {
        match operator {
            Operator::Mkp => Self::Mkp,
            Operator::Kp => Self::Kp,
            Operator::Relay => Self::Relay,
        }
    }
}

/// A number of levels, or the choice of one.
#[derive(Clone, Copy)]
pub(crate) enum Levels {
    Auto,
    Fixed(usize),
}

pub(super) fn parse_step(text: &str) -> Result<Step, String> {
    match text.trim() {
        "auto" => Ok(Step::Auto),
        "off" => Ok(Step::Off),
        number => match parse_finite(number) {
            Ok(value) if value >= 0.0 => Ok(Step::Value(value)),
            _ => Err("`auto`, `off` or a number from zero on is needed".into()),
        },
    }
}

/// Strengths of the smoothness, or the choice of them.
pub(crate) type Smooth = hysteron::Choice<hysteron::Smooth>;

pub(super) fn parse_smooth(text: &str) -> Result<Smooth, String> {
    let strength = |text: &str| match parse_finite(text) {
        Ok(value) if value >= 0.0 => Ok(value),
        _ => Err("`auto`, `off`, or one or two numbers from zero on are needed".to_owned()),
    };
    match (text.trim(), text.split_once(',')) {
        ("auto", _) => Ok(Smooth::Auto),
        ("off", _) => Ok(hysteron::Smooth::NONE.into()),
        (_, Some((along, across))) => Ok((strength(along)?, strength(across)?).into()),
        (along, None) => Ok(strength(along)?.into()),
    }
}

pub(super) fn parse_finite(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!("`{text}` is not a finite number")),
    }
}

/// Whole numbers from 0 to `most`.
pub(super) fn up_to<N: TryFrom<u64>>(
    most: u64,
) -> impl Fn(&str) -> Result<N, String> + Clone + Send + Sync + 'static {
    move |text| {
        let number = text.trim().parse().ok().filter(|number| *number <= most);
        let number = number.and_then(|number: u64| N::try_from(number).ok());
        number.ok_or_else(|| format!("a whole number from 0 to {most} is needed"))
    }
}

pub(super) fn parse_positive(text: &str) -> Result<f64, String> {
    match parse_finite(text)? {
        value if value > 0.0 => Ok(value),
        _ => Err("it must be above zero".into()),
    }
}

/// A number of bytes, with K, M or G for powers of 1024.
pub(super) fn parse_bytes(text: &str) -> Result<u64, String> {
    let text = text.trim();
    let units = [("K", 10), ("M", 20), ("G", 30)];
    let parts = units.into_iter().find_map(|(unit, power)| {
        let number = text
            .strip_suffix(unit)
            .or(text.strip_suffix(&unit.to_lowercase()))?;
        Some((number, power))
    });
    let (number, power) = parts.unwrap_or((text, 0));
    let bytes = number.trim().parse::<u64>().ok();
    let bytes = bytes.and_then(|bytes| bytes.checked_mul(1 << power));
    bytes
        .filter(|bytes| *bytes > 0)
        .ok_or_else(|| "a number of bytes is needed, such as 512M or 8G".into())
}

pub(super) fn parse_tolerance(text: &str) -> Result<f64, String> {
    let tolerance = parse_finite(text)?;
    if tolerance < 0.0 {
        return Err("it must not be below zero".into());
    }
    Ok(tolerance)
}

pub(super) fn parse_levels(text: &str) -> Result<usize, String> {
    let most = hysteron::MAX_LEVELS;
    match text.parse() {
        Ok(levels) if (2..=most).contains(&levels) => Ok(levels),
        _ => Err(format!("a plane has from 2 to {most} levels")),
    }
}

pub(super) fn parse_range(text: &str) -> Result<(f64, f64), String> {
    match parse_limits(text)? {
        (min, max) if min < max => Ok((min, max)),
        _ => Err("the first number must be below the second".into()),
    }
}

/// As a range, and both ends may be the same.
pub(super) fn parse_limits(text: &str) -> Result<(f64, f64), String> {
    match text.split_once(',') {
        Some((min, max)) => match (parse_finite(min)?, parse_finite(max)?) {
            (min, max) if min <= max => Ok((min, max)),
            _ => Err("the first number must not be above the second".into()),
        },
        None => Err("two numbers with a comma between are needed, such as 20,80".into()),
    }
}

/// Gain, integral time and derivative time; the last ones may be left out.
pub(super) fn parse_gains(text: &str) -> Result<Gains, String> {
    let numbers: Result<Vec<f64>, String> = text.split(',').map(parse_finite).collect();
    let numbers = numbers?;
    let at = |n: usize| numbers.get(n).copied().unwrap_or(0.0);
    let gains = Gains {
        gain: at(0),
        integral_s: at(1),
        derivative_s: at(2),
    };
    match numbers.len() {
        1..=3 => gains
            .check()
            .map(|()| gains)
            .map_err(|error| error.to_string()),
        _ => Err("a gain and two times in s are needed, such as 0.05,0.5,0".into()),
    }
}

pub(super) fn parse_levels_or_auto(text: &str) -> Result<Levels, String> {
    match text.trim() {
        "auto" => Ok(Levels::Auto),
        number => parse_levels(number)
            .map(Levels::Fixed)
            .map_err(|error| format!("{error}; or `auto`")),
    }
}

//! The learners, and the table of their options. Help, scenarios, Python and the reference page
//! read it.

use crate::adapt::window::Window;
use crate::error::{Error, Result};
use crate::model::Start;
use Learner::{Auto, Drift, Increments, LeastSquares, Load, Refit};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Which parameters are adapted, and by which method.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", try_from = "String")]
pub enum Learner {
    /// Fixed, refit, drift, least squares and increments side by side. Their mean is the model,
    /// each weighted by how well it has predicted lately (Herbster and Warmuth 1998).
    #[default]
    Auto,
    /// Nothing: the model stays as it is.
    Fixed,
    /// All weights by least squares over the last cycle of the input, again and again.
    Refit,
    /// The coefficients of [`crate::DriftBasis`] by recursive least squares.
    Drift,
    /// All weights by recursive least squares.
    LeastSquares,
    /// All weights by the normalised gradient on increments.
    Increments,
    /// The shift of the operators' axis alone, by a Kalman filter: a load that nobody measures.
    Load,
}

impl Learner {
    /// All learners.
    pub const ALL: [Self; 7] = [
        Self::Auto,
        Self::Fixed,
        Self::Refit,
        Self::Drift,
        Self::LeastSquares,
        Self::Increments,
        Self::Load,
    ];

    /// The name, as every surface writes it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Fixed => "fixed",
            Self::Refit => "refit",
            Self::Drift => "drift",
            Self::LeastSquares => "least-squares",
            Self::Increments => "increments",
            Self::Load => "load",
        }
    }

    /// What it does, in one sentence.
    #[must_use]
    pub fn purpose(self) -> &'static str {
        match self {
            Self::Auto => {
                "All of the others but `load` side by side, weighted by how well each has \
                 predicted lately"
            }
            Self::Fixed => "Nothing learns: the model stays as it is",
            Self::Refit => {
                "All weights, by least squares over the last cycle of the input, again and again"
            }
            Self::Drift => {
                "A few coefficients: the weights shifted along the plane, or the load dependence \
                 of a model with a load"
            }
            Self::LeastSquares => "All weights, by recursive least squares",
            Self::Increments => {
                "All weights, by the normalised gradient on increments of the output"
            }
            Self::Load => "The shift of the input axis alone: a load that nobody measures",
        }
    }

    /// The options that this learner has.
    pub fn options(self) -> impl Iterator<Item = &'static AdaptOption> {
        let has = move |option: &&AdaptOption| option.learners.contains(&self);
        ADAPT_OPTIONS.iter().filter(has)
    }
}

impl fmt::Display for Learner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Learner {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self> {
        let found = Self::ALL.into_iter().find(|learner| learner.name() == name);
        found.ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            Error::Fit(match name {
                "gradient" => "there is no learner `gradient` any more: take `increments`, which \
                               needs no more knowledge, or `auto`, the default"
                    .into(),
                _ => format!("there is no learner `{name}`: one of {names} is needed"),
            })
        })
    }
}

impl TryFrom<String> for Learner {
    type Error = Error;

    fn try_from(name: String) -> Result<Self> {
        name.parse()
    }
}

/// An option of a learner, as docs, help and pages show it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AdaptOption {
    /// Its name in Rust, Python and scenarios. The command writes hyphens: `--dead-zone`.
    pub name: &'static str,
    /// What its value is.
    pub kind: AdaptOptionKind,
    /// The learners that have it.
    pub learners: &'static [Learner],
    /// Its default, as `docs/options.md` says it.
    pub default: &'static str,
    /// What it may be.
    pub range: &'static str,
    /// What it is for.
    pub purpose: &'static str,
}

/// What the value of an [`AdaptOption`] is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AdaptOptionKind {
    /// A number.
    Number,
    /// A whole number from 0.
    Count,
    /// A [`Window`].
    Window,
}

/// The value of an [`AdaptOption`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AdaptValue {
    /// A number.
    Number(f64),
    /// A whole number from 0.
    Count(u32),
    /// The samples that a refit uses.
    Window(Window),
}

impl AdaptOptionKind {
    /// The value that a text says.
    ///
    /// # Errors
    /// [`Error::Fit`] for a text that is no finite number, no whole number or no window.
    pub fn parse(self, text: &str) -> Result<AdaptValue> {
        let needed = |what: &str| Error::Fit(format!("`{text}` is not {what}"));
        match self {
            Self::Number => {
                let number = text.parse().ok().filter(|number: &f64| number.is_finite());
                number
                    .map(AdaptValue::Number)
                    .ok_or_else(|| needed("a finite number"))
            }
            Self::Count => {
                let count = text.parse().map(AdaptValue::Count);
                count.map_err(|_| needed("a whole number from 0 to 4294967295"))
            }
            Self::Window => text.parse().map(AdaptValue::Window),
        }
    }
}

/// Types of options.
trait Value: Sized {
    const KIND: AdaptOptionKind;
    fn of(value: AdaptValue) -> Option<Self>;
}

macro_rules! value {
    ($($type:ty: $kind:ident),*) => {$(
        impl Value for $type {
            const KIND: AdaptOptionKind = AdaptOptionKind::$kind;
            fn of(value: AdaptValue) -> Option<Self> {
                match value {
                    AdaptValue::$kind(value) => Some(value),
                    _ => None,
                }
            }
        }
    )*};
}

value!(f64: Number, u32: Count, Window: Window);

const ALL: &[Learner] = &[Auto, Refit, Drift, LeastSquares, Increments, Load];
const ESTIMATORS: &[Learner] = &[Drift, LeastSquares, Increments];
const SQUARES: &[Learner] = &[Drift, LeastSquares];

macro_rules! options {
    ($($name:ident: $type:ty, $learners:expr, $default:literal, $range:literal, $purpose:literal;)*) => {
        /// The options of the learners. `docs/options.md` has the same table.
        pub const ADAPT_OPTIONS: [AdaptOption; [$(stringify!($name)),*].len()] = [$(AdaptOption {
            name: stringify!($name),
            kind: <$type as Value>::KIND,
            learners: $learners,
            default: $default,
            range: $range,
            purpose: $purpose,
        }),*];

        /// The options of [`crate::adapt()`] and of a model that learns in a loop. A field that is
        /// `None` has the default of [`ADAPT_OPTIONS`], which follows from the model and the
        /// recording. `Y` is the range of the recording's output or that of the model, whichever is
        /// larger; single readings far from all others do not count for it. `N` is the number of
        /// weights.
        #[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
        #[serde(default, deny_unknown_fields)]
        pub struct AdaptOptions {
            /// Which parameters are adapted, and by which method. Default `auto`.
            #[serde(rename = "method")]
            pub learner: Learner,
            /// State of the operators before the first sample of a recording. Default `unknown`:
            /// that of the fit, unless the unadapted model errs 1.5 times less with all off, all on
            /// or, but for [`Learner::Load`], from a rest before the first recording. What a start
            /// explains is not learned. A loop begins with all operators off, unless they are told
            /// to be on, and [`Learner::Auto`] waits there while another start would still make a
            /// difference.
            pub start: Start,
            $(
                #[doc = concat!($purpose, ". ", $range, ". Default: ", $default, ".")]
                pub $name: Option<$type>,
            )*
        }

        impl Default for AdaptOptions {
            fn default() -> Self {
                Self {
                    learner: Learner::default(),
                    start: Start::Unknown,
                    $($name: None,)*
                }
            }
        }

        impl AdaptOptions {
            /// Sets an option by its name in [`ADAPT_OPTIONS`].
            ///
            /// ```
            /// use hysteron::{AdaptOptions, AdaptValue};
            /// let mut options = AdaptOptions::default();
            /// options.set("ridge", AdaptValue::Number(0.2))?;
            /// assert_eq!(options.ridge, Some(0.2));
            /// # Ok::<(), hysteron::Error>(())
            /// ```
            ///
            /// # Errors
            /// [`Error::Fit`] for a name that is not in the table, or a value of another kind.
            pub fn set(&mut self, name: &str, value: AdaptValue) -> Result<()> {
                match name {
                    $(stringify!($name) => {
                        let value = <$type as Value>::of(value);
                        self.$name = Some(value.ok_or_else(|| {
                            Error::Fit(format!("`{name}` has a value of another kind"))
                        })?);
                    })*
                    _ => return Err(Error::Fit(format!("learners have no option `{name}`"))),
                }
                Ok(())
            }

            /// Refuses an option that is set and that the learner does not have.
            pub(super) fn refuse_unused(&self) -> Result<()> {
                let given = [$(self.$name.is_some()),*];
                let unused = ADAPT_OPTIONS.iter().zip(given).find(|(option, given)| {
                    *given && !option.learners.contains(&self.learner)
                });
                match unused {
                    None => Ok(()),
                    Some((option, _)) => {
                        let names: Vec<String> =
                            option.learners.iter().map(|name| format!("`{name}`")).collect();
                        Err(Error::Fit(format!(
                            "`{}` is an option of {}, not of `{}`: leave it out",
                            option.name, names.join(", "), self.learner
                        )))
                    }
                }
            }
        }
    };
}

options! {
    load: f64, &[Auto, Refit, Drift, Load], "middle of its range", "the model's",
        "load to start at, for a model that depends on a load";
    window: Window, &[Refit], "`cycles:1`", "`cycles:1` to `cycles:1000`, `samples:2` to `samples:65536`",
        "the samples to fit to, the last cycles of the input or the last samples";
    every: u32, &[Refit], "at each turning point, and where an eighth of the window is new", "from 1 on",
        "samples between two refits";
    ridge: f64, &[Refit], "0.1", "above 0, up to 1",
        "holds weights where they are, relative to the mean diagonal element of the window's matrix";
    gain: f64, &[Increments], "0.3", "above 0, below 2",
        "share of an increment's error that is removed";
    span: f64, &[Increments], "1", "1/8 to 8",
        "levels that the input travels between two updates";
    forgetting: f64, SQUARES, "0.999; `drift`: 0.9999", "above 0, up to 1",
        "what a sample counts relative to the next one";
    noise: f64, &[Drift, LeastSquares, Load],
        "the output's noise, and at least 2 % of `Y`; `drift`, `load`: 5 %", "above 0",
        "standard deviation of a reading's error, model error included, in the output's unit";
    spread: f64, &[Drift, LeastSquares, Load],
        "such that the sum of the weights may deviate by 0.3 `Y`; `drift`: 0.5; `load`: half of what it can reach",
        "above 0",
        "standard deviation of a weight or coefficient around its off-line value; `load`: of the shift, in the input's unit";
    correlation: f64, &[LeastSquares], "1", "from 0 on",
        "correlation length of the deviations, in levels";
    dead_zone: f64, &[Drift, LeastSquares, Increments, Load], "twice the output's noise", "from 0 on",
        "errors up to this are noise, in the output's unit";
    leakage: f64, ESTIMATORS, "0", "0 to 1",
        "share by which the weights return to the off-line weights with each update";
    offset_share: f64, ESTIMATORS,
        "`increments`: 0.2 √N; otherwise such that the offset may deviate by 0.3 `Y`", "from 0 on",
        "how freely the offset moves, relative to one weight or coefficient; with 0 it stays";
    movement: f64, ALL, "0.05", "from 0 on",
        "levels that the input has to move before the model learns again";
    trial: u32, ESTIMATORS, "256", "from 1 on",
        "samples after which the weights are compared with the last good ones";
    gate: f64, ALL, "12", "0, or from 2 on",
        "a reading whose error exceeds the usual one so many times is rejected; 0 rejects none, and takes no channel for stuck";
    burst: u32, ALL, "8", "from 1 on",
        "consecutive readings beyond the gate that agree, after which they are believed: the plant has jumped";
}

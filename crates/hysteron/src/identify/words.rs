//! The options of a fit as words: one table of their meaning, and a fit from a name and a text.

use crate::error::{Error, Result};
use crate::identify::fit::Fit;
use crate::identify::options::{Auto, Choice, Dynamics, LoadLaw, Spacing};
use crate::model::{Delay, Sign, Smooth, Solver, Start};
use hysteron_core::Operator;
use serde::Serialize;
use std::str::FromStr;

/// An option of a fit, as docs, help and pages show it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct FitOption {
    /// Its name in Rust and Python. The command writes hyphens: `--load-law`.
    pub name: &'static str,
    /// Its default, as `docs/options.md` says it.
    pub default: &'static str,
    /// What it may be.
    pub range: &'static str,
    /// What it is for.
    pub purpose: &'static str,
}

/// The options of a fit. `docs/options.md` has the same table.
pub const FIT_OPTIONS: [FitOption; 20] = [
    FitOption {
        name: "operator",
        default: "`mkp`",
        range: "`mkp`, `kp`, `relay`",
        purpose: "the elementary operator",
    },
    FitOption {
        name: "levels",
        default: "`auto`",
        range: "from 2 on",
        purpose: "number of levels `K`; `auto`: by the error on branches left out, or by \
                  the evidence",
    },
    FitOption {
        name: "range",
        default: "the active range is that of the input",
        range: "finite, in order",
        purpose: "lowest and highest level",
    },
    FitOption {
        name: "solver",
        default: "`nnls`",
        range: "`nnls`, `ols`",
        purpose: "how the weights are found",
    },
    FitOption {
        name: "sign",
        default: "the better one",
        range: "`positive`, `negative`",
        purpose: "direction of the output",
    },
    FitOption {
        name: "offset",
        default: "identified",
        range: "finite",
        purpose: "output with every operator off",
    },
    FitOption {
        name: "smooth",
        default: "`auto`",
        range: "0 to 1e6 each",
        purpose: "smoothness along and across the diagonal; `auto` as `levels`",
    },
    FitOption {
        name: "ridge",
        default: "1e-6",
        range: "0 to 1",
        purpose: "pulls weights that the data hardly move to zero",
    },
    FitOption {
        name: "robust",
        default: "`auto`",
        range: "`auto`, `off`",
        purpose: "finds outliers and leaves them out of the fit",
    },
    FitOption {
        name: "start",
        default: "`auto`",
        range: "`auto`, `off`, `on`, `rest`, `unknown`",
        purpose: "where the operators stand before each recording; `rest`: all off, then at an \
                  input that the fit finds; `auto`: at rest, unless unknown predicts clearly \
                  better",
    },
    FitOption {
        name: "load_law",
        default: "`auto`",
        range: "`auto`, `shift`, `weights`",
        purpose: "what a load changes, if there is one; `auto`: what predicts loads left out best, of \
                  a registration of the loops, a shift of the axis and weights",
    },
    FitOption {
        name: "load_degree",
        default: "`auto`",
        range: "0 to 5, `auto`",
        purpose: "order of weights and offset in the load; `auto`: by loads left out",
    },
    FitOption {
        name: "spacing",
        default: "`auto`",
        range: "`auto`, `uniform`",
        purpose: "where the levels are; `auto`: where the output moves, if that is better by 5 %",
    },
    FitOption {
        name: "delay",
        default: "`auto`",
        range: "`auto`, `off`, 1 to 1000",
        purpose: "with time: samples from an input to the output that answers it; `auto`: up to 60, if \
                  that is better by 10 % on parts left out",
    },
    FitOption {
        name: "creep",
        default: "`off`",
        range: "`off`, `auto`, 1 to 4",
        purpose: "number of creep terms after the operators",
    },
    FitOption {
        name: "lag",
        default: "`off`",
        range: "`off`, `auto`, seconds",
        purpose: "time constant of a lag of the output",
    },
    FitOption {
        name: "dynamics",
        default: "`auto`",
        range: "`auto`, `off`, `lag`, `ring`",
        purpose: "with time: a resonance of the output, a lag, or a thermal body in front; `auto`: \
                  where that is better by 10 %; `lag` is `lag auto`",
    },
    FitOption {
        name: "curve",
        default: "`off`",
        range: "`off`, `auto`, 1 to 100",
        purpose: "pieces of an output curve behind the operators",
    },
    FitOption {
        name: "bootstrap",
        default: "200, from 25 levels on 60, from 45 on 0",
        range: "up to 10,000",
        purpose: "replicates for standard errors and the band; 0 for none",
    },
    FitOption {
        name: "thermal",
        default: "none",
        range: "`first-order`, `auto`",
        purpose: "a thermal body in front of the operators; `auto`: one that may bind heat",
    },
];

impl Fit<'_> {
    /// The same fit with one option from a text, as the command takes it: `levels` and `20`,
    /// `smooth` and `1e-6,1e-8`. The names are those of [`FIT_OPTIONS`].
    ///
    /// ```
    /// use hysteron::Fit;
    /// let fit = Fit::new().with("levels", "12")?.with("spacing", "uniform")?;
    /// let refused = fit.with("levels", "many").unwrap_err();
    /// assert!(refused.to_string().contains("`levels`"));
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Fit`] for a name or a text that is not in the table.
    pub fn with(self, name: &str, text: &str) -> Result<Self> {
        let option = FIT_OPTIONS.iter().find(|option| option.name == name);
        let Some(option) = option else {
            return Err(Error::Fit(format!("there is no option `{name}`")));
        };
        let text = text.trim();
        self.taking(name, text).ok_or_else(|| {
            let range = option.range;
            Error::Fit(format!("`{name}` cannot be `{text}`: {range} is needed"))
        })
    }

    fn taking(self, name: &str, text: &str) -> Option<Self> {
        Some(match (name, text) {
            ("operator", "mkp") => self.operator(Operator::Mkp),
            ("operator", "kp") => self.operator(Operator::Kp),
            ("operator", "relay") => self.operator(Operator::Relay),
            ("levels", "auto") => self.levels(Auto),
            ("levels", text) => self.levels(number(text).filter(|levels| *levels >= 2)?),
            ("range", text) => {
                let (min, max) = pair(text)?;
                self.range(min, max)
            }
            ("solver", "nnls") => self.solver(Solver::Nnls),
            ("solver", "ols") => self.solver(Solver::Ols),
            ("sign", "positive") => self.sign(Sign::Positive),
            ("sign", "negative") => self.sign(Sign::Negative),
            ("offset", text) => self.offset(finite(text)?),
            ("smooth", "auto") => self.smooth(Auto),
            ("smooth", "off") => self.smooth(Smooth::NONE),
            ("smooth", text) => match pair(text) {
                Some((along, across)) if along >= 0.0 && across >= 0.0 => {
                    self.smooth((along, across))
                }
                Some(_) => return None,
                None => self.smooth(finite(text).filter(|along| *along >= 0.0)?),
            },
            ("ridge", text) => self.ridge(finite(text)?),
            ("robust", "auto") => self.robust(true),
            ("robust", "off") => self.robust(false),
            ("start", "auto") => self.start(Auto),
            ("start", "off") => self.start(Start::Off),
            ("start", "on") => self.start(Start::On),
            ("start", "rest") => self.start(Start::Rest),
            ("start", "unknown") => self.start(Start::Unknown),
            ("load_law", "auto") => self.load_law(LoadLaw::Auto),
            ("load_law", "shift") => self.load_law(LoadLaw::Shift),
            ("load_law", "weights") => self.load_law(LoadLaw::Weights),
            ("load_degree", "auto") => self.load_degree(Auto),
            ("load_degree", text) => self.load_degree(number(text)?),
            ("spacing", "auto") => self.spacing(Spacing::Auto),
            ("spacing", "uniform") => self.spacing(Spacing::Uniform),
            ("delay", "off") => self.delay(0),
            ("delay", "auto") => self.delay(Auto),
            ("delay", text) => self.delay(number(text).filter(|samples| *samples <= Delay::MOST)?),
            ("creep", "off") => self.creep(0),
            ("creep", "auto") => self.creep(Auto),
            ("creep", text) => self.creep(number(text)?),
            ("lag", "off") => self.lag(0.0),
            ("lag", "auto") => self.lag(Auto),
            ("lag", text) => self.lag(finite(text).filter(|seconds| *seconds >= 0.0)?),
            ("dynamics", "auto") => self.dynamics(Dynamics::Auto),
            ("dynamics", "off") => self.dynamics(Dynamics::Off),
            ("dynamics", "lag") => self.dynamics(Dynamics::Lag),
            ("dynamics", "ring") => self.dynamics(Dynamics::Ring),
            ("curve", "off") => self.curve(0),
            ("curve", "auto") => self.curve(Auto),
            ("curve", text) => self.curve(number(text)?),
            ("bootstrap", text) => self.bootstrap(Choice::Fixed(number(text)?)),
            ("thermal", "auto") => self.thermal(Auto),
            ("thermal", "first-order") => self.thermal(true),
            _ => return None,
        })
    }
}

fn number(text: &str) -> Option<usize> {
    usize::from_str(text).ok()
}

fn finite(text: &str) -> Option<f64> {
    f64::from_str(text).ok().filter(|value| value.is_finite())
}

fn pair(text: &str) -> Option<(f64, f64)> {
    let (a, b) = text.split_once(',')?;
    Some((finite(a.trim())?, finite(b.trim())?))
}

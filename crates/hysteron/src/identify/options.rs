//! The options of a fit.

use crate::identify::initial::Initial;
use crate::model::{LoadCurves, Sign, Smooth, Solver, Start};
use hysteron_core::Operator;

/// Let the data decide.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Auto;

/// A fixed value, or a choice left to the data. Both convert into it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Choice<T> {
    /// Let the data decide.
    Auto,
    /// Use this value.
    Fixed(T),
}

impl<T> From<Auto> for Choice<T> {
    fn from(_: Auto) -> Self {
        Self::Auto
    }
}

impl From<usize> for Choice<usize> {
    fn from(value: usize) -> Self {
        Self::Fixed(value)
    }
}

impl From<f64> for Choice<f64> {
    fn from(value: f64) -> Self {
        Self::Fixed(value)
    }
}

impl From<f64> for Choice<Smooth> {
    fn from(along: f64) -> Self {
        Self::Fixed(along.into())
    }
}

impl From<(f64, f64)> for Choice<Smooth> {
    fn from(strengths: (f64, f64)) -> Self {
        Self::Fixed(strengths.into())
    }
}

impl From<Start> for Choice<Start> {
    fn from(start: Start) -> Self {
        Self::Fixed(start)
    }
}

impl From<Smooth> for Choice<Smooth> {
    fn from(smooth: Smooth) -> Self {
        Self::Fixed(smooth)
    }
}

/// What a load changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LoadLaw {
    /// It moves the thresholds of rising and of falling input, each along a curve (a registration),
    /// or as one of the others: what predicts loads left out best.
    #[default]
    Auto,
    /// It shifts the axis of the operators, and weights and offset follow with a low order.
    Shift,
    /// It changes weights and offset only.
    Weights,
}

/// What is looked for between a drive that heats and the operators.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Thermal {
    /// Nothing: the input is the temperature.
    #[default]
    None,
    /// A body of the first order.
    FirstOrder,
    /// A body of the first order, and heat that the operators bind where that predicts parts of the
    /// recordings that were left out.
    Auto,
}

impl From<bool> for Thermal {
    /// Whether there is a body of the first order.
    fn from(body: bool) -> Self {
        match body {
            true => Self::FirstOrder,
            false => Self::None,
        }
    }
}

impl From<Auto> for Thermal {
    fn from(_: Auto) -> Self {
        Self::Auto
    }
}

/// What is looked for in recordings with time, beside creep.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Dynamics {
    /// A ring, where the recordings excite one; else a lag, where it predicts what was left out. Or
    /// a thermal body in front of the operators, where the whole model is better with it. Nothing
    /// where creep or a lag is asked for, or where there is a load; no lag behind a thermal body.
    Auto,
    /// Nothing.
    #[default]
    Off,
    /// A lag of the first order, as with an automatic `lag`.
    Lag,
    /// The best ring, excited or not.
    Ring,
}

/// Where the levels of the plane are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Spacing {
    /// At equal distances.
    #[default]
    Uniform,
    /// Close together where the output moves.
    Auto,
}

/// The options of a fit. [`FitOptions::plain`] leaves nothing to the data; the defaults, which are
/// those of [`Fit::new`](crate::Fit::new), leave to it what the table calls auto.
///
/// | field | plain; default | range | purpose |
/// | --- | --- | --- | --- |
/// | `operator` | MKP | MKP, KP, relay | the elementary operator |
/// | `levels` | 20; auto | 2 or more | number of levels `K` |
/// | `range` | from the data | finite, in order | the plane's lowest and highest level |
/// | `solver` | NNLS | NNLS, OLS | see [`Solver`] |
/// | `sign` | the better one | ± | direction of the output |
/// | `offset` | free | finite | output with every operator off |
/// | `smooth` | none; auto | 0 to 1e6 each | along and across the diagonal, see [`Smooth`] |
/// | `ridge` | 1e-6 | 0 to 1 | pulls weights that the data hardly move to zero |
/// | `robust` | off; auto | | whether outliers are found and left out of the fit |
/// | `start` | off; auto | off, on, rest, unknown | state of the operators before each recording |
/// | `load_law` | auto | auto, shift, weights | what a load changes, if there is one |
/// | `load_degree` | auto | 0 to 5 | order of the weights in the load; auto: by loads left out |
/// | `spacing` | uniform; auto | uniform, auto | where the levels are |
/// | `delay` | off (0); auto | auto, 0 to 1000 | dead time, in samples of the recording |
/// | `creep` | off (0) | auto, 0 to 4 | number of creep terms |
/// | `lag` | off (0) | auto, 0 or more | time constant of a lag of the whole, in seconds |
/// | `dynamics` | off; auto | off, auto, lag, ring | what happens in time, see [`Dynamics`] |
/// | `curve` | off (0) | auto, 1 to 100 | pieces of a curve behind the operators |
/// | `bootstrap` | 0; 200 | up to 10,000 | replicates for standard errors and band; 0 for none |
#[derive(Debug, Clone, PartialEq)]
pub struct FitOptions {
    /// The elementary operator.
    pub operator: Operator,
    /// Number of levels `K`. The Gram matrix takes `8 N²` bytes, with `N = K(K + 1)/2`.
    pub levels: usize,
    /// Lowest and highest level; `None` for the plane whose active range is the range of the input.
    pub range: Option<(f64, f64)>,
    /// Least squares with or without the constraint that weights are not negative.
    pub solver: Solver,
    /// Direction of the output; `None` to take the one that fits better.
    pub sign: Option<Sign>,
    /// Output with every operator off; `None` to identify it.
    pub offset: Option<f64>,
    /// Strengths of the smoothness of the weights' density, along and across the diagonal.
    pub smooth: Smooth,
    /// Ridge on the weights, relative to the mean diagonal element of the Gram matrix (after the
    /// offset was eliminated). Without it, operators that the data hardly move take any weight.
    pub ridge: f64,
    /// Whether outliers, which stand out from their neighbours, are found and left out of the fit.
    pub robust: bool,
    /// State of the operators before the first sample of each recording.
    pub start: Start,
    /// For [`Start::Rest`]: the two inputs at which the operators were before each recording, one
    /// after the other, in the unit of the input. `None` to find them.
    pub rest: Option<[f64; 2]>,
    /// What a load changes.
    pub load_law: LoadLaw,
    /// Gain and offset over the load, if they are known; the weights then do not depend on it.
    pub load_curves: Option<LoadCurves>,
    /// Order of the weights as a function of the load; `None` to choose it: by loads left out where
    /// there are three or more, otherwise 1.
    pub load_degree: Option<usize>,
    /// Where the levels are.
    pub spacing: Spacing,
    /// Dead time of the actuator, in samples of the recordings.
    pub delay: Choice<usize>,
    /// Number of creep terms.
    pub creep: Choice<usize>,
    /// Time constant of a lag of the whole, in seconds.
    pub lag: Choice<f64>,
    /// What is looked for behind the operators in recordings with time, beside creep.
    pub dynamics: Dynamics,
    /// Number of pieces of an output curve.
    pub curve: Choice<usize>,
    /// Number of bootstrap replicates.
    pub bootstrap: usize,
}

/// The usual ridge. A larger one costs accuracy where a scan is exact: at 1e-4, the next scan of a
/// magnet is predicted worse by half.
const RIDGE: f64 = 1e-6;

/// The smoothness of fits that only compare recordings or starts: too smooth to follow a single
/// reading, and not enough to blur a loop.
pub(crate) const SOME_SMOOTHNESS: Smooth = Smooth {
    along: 1e-8,
    across: 1e-8,
};

/// What is assumed about the weights before any data: the strengths of a Gaussian prior.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Prior {
    pub(crate) smooth: Smooth,
    pub(crate) ridge: f64,
}

impl Prior {
    /// Nothing is assumed.
    pub(crate) const NONE: Self = Self {
        smooth: Smooth::NONE,
        ridge: 0.0,
    };
}

impl FitOptions {
    /// Nothing is left to the data: 20 levels at equal distances, no smoothness, every operator off
    /// before the first sample, no search for outliers, no stages, no bootstrap.
    ///
    /// ```
    /// use hysteron::{Fit, FitOptions, Recording};
    /// let input: Vec<f64> = (0..200).map(|n| 30.0 - 30.0 * (f64::from(n) * 0.1).cos()).collect();
    /// let recording = Recording::new(input.clone(), input)?;
    /// let model = Fit::from(FitOptions { levels: 5, ..FitOptions::plain() }).run(&recording)?;
    /// assert_eq!(model.plane().levels(), 5);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    #[must_use]
    pub fn plain() -> Self {
        Self {
            operator: Operator::Mkp,
            levels: 20,
            range: None,
            solver: Solver::Nnls,
            sign: None,
            offset: None,
            smooth: Smooth::NONE,
            ridge: RIDGE,
            robust: false,
            start: Start::Off,
            rest: None,
            load_law: LoadLaw::Auto,
            load_curves: None,
            load_degree: None,
            spacing: Spacing::Uniform,
            delay: Choice::Fixed(0),
            creep: Choice::Fixed(0),
            lag: Choice::Fixed(0.0),
            dynamics: Dynamics::Off,
            curve: Choice::Fixed(0),
            bootstrap: 0,
        }
    }

    pub(crate) fn prior(&self) -> Prior {
        Prior {
            smooth: self.smooth,
            ridge: self.ridge,
        }
    }

    /// The state before each recording, of the operators whose state is known or does not matter:
    /// with an unknown start, off.
    pub(crate) fn initial(&self) -> Initial {
        match (self.start, self.rest) {
            (Start::On, _) => Initial::On,
            (Start::Rest, Some(rest)) => Initial::After(rest),
            _ => Initial::Off,
        }
    }

    /// Whether a start at rest is asked for, and where the rest was is left to the data.
    pub(crate) fn opens_rest(&self) -> bool {
        self.start == Start::Rest && self.rest.is_none()
    }

    /// Whether creep or a lag after the operators is asked for.
    pub(crate) fn asks_after(&self) -> bool {
        let has_lag = self.lag != Choice::Fixed(0.0) || self.dynamics == Dynamics::Lag;
        self.creep != Choice::Fixed(0) || has_lag
    }

    /// Whether a ring is looked for.
    pub(crate) fn looks_for_ring(&self) -> bool {
        match self.dynamics {
            Dynamics::Auto => !self.asks_after(),
            Dynamics::Ring => true,
            Dynamics::Off | Dynamics::Lag => false,
        }
    }

    /// Whether a lag is looked for that nobody asked for.
    pub(crate) fn looks_for_lag(&self) -> bool {
        self.dynamics == Dynamics::Auto && !self.asks_after()
    }

    /// Whether the recordings have to have time.
    pub(crate) fn needs_time(&self) -> bool {
        self.asks_after() || self.dynamics == Dynamics::Ring
    }

    /// Default number of bootstrap replicates: enough for standard errors of two digits, fewer for
    /// many levels. From 45 levels on there are none, because they would take long.
    #[must_use]
    pub fn usual_bootstrap(levels: usize) -> usize {
        match levels {
            0..=24 => 200,
            25..=44 => 60,
            _ => 0,
        }
    }
}

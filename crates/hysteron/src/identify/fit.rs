//! [`Fit`], the entry point of identification: options, choices left to the data, progress.

use crate::error::{Error, Result};
use crate::identify::choose::validate::{Candidates, cross_validate};
use crate::identify::options::FitOptions;
use crate::identify::stages::body::fit_body;
use crate::identify::weights::fit::fit_weights;
use crate::model::{Model, Sign, Solver, Start};
use crate::progress::Progress;
use crate::recording::Recording;
use crate::remedy::{Remedy, Setting};
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

/// Identifies a model from recordings. Set the options that differ from the defaults, then call
/// [`run`](Fit::run).
///
/// The defaults are those of [`FitOptions`], with one exception: [`Fit::new`] runs a bootstrap with
/// [`FitOptions::usual_bootstrap`] replicates, so the model has standard errors and a band.
///
/// The `n × N` matrix of operator states is never formed. The Gram matrix takes `O(N²)` memory and,
/// for inputs with few turning points at once, `O(n + N²)` time. The solver then takes about `p`
/// steps of `O(N p + p²)` each, where `p` is the number of weights that are not zero.
///
/// ```
/// use hysteron::{Auto, Fit, Recording};
/// let input: Vec<f64> = (0..200).map(|n| (1.0 - (f64::from(n) * 0.1).cos()) * 30.0).collect();
/// let output = input.iter().map(|t| 0.5 * t).collect(); // no hysteresis at all
/// let recording = Recording::new(input, output)?;
/// let model = Fit::new().levels(5).run(&recording)?;
/// assert!(model.fit.is_some_and(|fit| fit.nrmse_percent < 1e-6));
///
/// let chosen = Fit::new().levels(Auto).bootstrap(0).run(&recording)?;
/// assert!(chosen.fit.is_some_and(|fit| fit.validation.is_some()));
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Fit<'a> {
    options: FitOptions,
    auto_levels: bool,
    auto_smooth: bool,
    auto_bootstrap: bool,
    body: bool,
    progress: Progress<'a>,
}

impl Default for Fit<'_> {
    fn default() -> Self {
        Self {
            auto_bootstrap: true,
            ..FitOptions::default().into()
        }
    }
}

impl From<FitOptions> for Fit<'_> {
    /// Fixed options; nothing is left to the data.
    fn from(options: FitOptions) -> Self {
        Self {
            options,
            auto_levels: false,
            auto_smooth: false,
            auto_bootstrap: false,
            body: false,
            progress: Progress::NONE,
        }
    }
}

impl From<&FitOptions> for Fit<'_> {
    fn from(options: &FitOptions) -> Self {
        options.clone().into()
    }
}

impl<'a> Fit<'a> {
    /// A fit with the defaults.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The elementary operator.
    #[must_use]
    pub fn operator(mut self, operator: Operator) -> Self {
        self.options.operator = operator;
        self
    }

    /// Number of levels, 2 or more. [`Auto`] chooses it by cross-validation: the error on branches
    /// that were left out.
    #[must_use]
    pub fn levels(mut self, levels: impl Into<Choice<usize>>) -> Self {
        match levels.into() {
            Choice::Auto => self.auto_levels = true,
            Choice::Fixed(levels) => (self.options.levels, self.auto_levels) = (levels, false),
        }
        self
    }

    /// Strength of the smoothness, 0 or more. [`Auto`] chooses it by cross-validation, as for the
    /// levels.
    #[must_use]
    pub fn smooth(mut self, smooth: impl Into<Choice<f64>>) -> Self {
        match smooth.into() {
            Choice::Auto => self.auto_smooth = true,
            Choice::Fixed(smooth) => (self.options.smooth, self.auto_smooth) = (smooth, false),
        }
        self
    }

    /// Number of bootstrap replicates, up to 10,000; 0 for none. [`Auto`] takes
    /// [`FitOptions::usual_bootstrap`].
    #[must_use]
    pub fn bootstrap(mut self, replicates: impl Into<Choice<usize>>) -> Self {
        match replicates.into() {
            Choice::Auto => self.auto_bootstrap = true,
            Choice::Fixed(count) => (self.options.bootstrap, self.auto_bootstrap) = (count, false),
        }
        self
    }

    /// Lowest and highest level of the plane, in the input's unit.
    #[must_use]
    pub fn range(mut self, min: f64, max: f64) -> Self {
        self.options.range = Some((min, max));
        self
    }

    /// Least squares with or without the constraint that weights are not negative.
    #[must_use]
    pub fn solver(mut self, solver: Solver) -> Self {
        self.options.solver = solver;
        self
    }

    /// Direction of the output.
    #[must_use]
    pub fn sign(mut self, sign: Sign) -> Self {
        self.options.sign = Some(sign);
        self
    }

    /// Output with every operator off, in the output's unit.
    #[must_use]
    pub fn offset(mut self, offset: f64) -> Self {
        self.options.offset = Some(offset);
        self
    }

    /// State of the operators before the first sample of each recording.
    #[must_use]
    pub fn start(mut self, start: Start) -> Self {
        self.options.start = start;
        self
    }

    /// Order of the weights as a function of the load, 0 to 5, for recordings with a load.
    #[must_use]
    pub fn load_degree(mut self, degree: usize) -> Self {
        self.options.load_degree = degree;
        self
    }

    /// Whether a thermal body in front of the operators is identified together with the weights.
    ///
    /// The recordings need time. Their input is a drive that heats (squared current, squared
    /// voltage, duty cycle). For given time constants, finding the weights is a convex problem. So
    /// the search is over the time constants only (separable least squares, Golub and Pereyra
    /// 1973).
    #[must_use]
    pub fn thermal(mut self, body: bool) -> Self {
        self.body = body;
        self
    }

    /// A callback for the progress, which may cancel the work.
    #[must_use]
    pub fn progress(mut self, progress: Progress<'a>) -> Self {
        self.progress = progress;
        self
    }

    /// Identifies the model. Several recordings are parts of one experiment, each with its own
    /// initial state. If they have a load, the weights depend on it.
    ///
    /// # Errors
    /// - [`Error::Recording`] for an invalid recording or a constant input.
    /// - [`Error::Core`] for an invalid plane.
    /// - [`Error::Fit`] for options that contradict each other, and for automatic levels or
    ///   smoothness with a thermal body.
    /// - [`Error::Thermal`] for a thermal body without time.
    /// - The error that `progress` returns.
    pub fn run(&self, recordings: &(impl AsRef<[Recording]> + ?Sized)) -> Result<Model> {
        let recordings = recordings.as_ref();
        let mut options = self.options.clone();
        let mut validation = None;
        if self.auto_levels || self.auto_smooth {
            self.refuse_choice_behind_body()?;
            let candidates = Candidates::new(
                (!self.auto_levels).then_some(options.levels),
                (!self.auto_smooth).then_some(options.smooth),
            );
            let (chosen, found) = cross_validate(recordings, &options, &candidates, self.progress)?;
            options = chosen;
            validation = Some(found);
        }
        if self.auto_bootstrap {
            options.bootstrap = FitOptions::usual_bootstrap(options.levels);
        }
        let mut model = match self.body {
            false => fit_weights(recordings, &options, self.progress)?,
            true => fit_body(recordings, &options, self.progress)?,
        };
        if let Some(fit) = &mut model.fit {
            fit.validation = validation;
        }
        Ok(model)
    }

    fn refuse_choice_behind_body(&self) -> Result<()> {
        if !self.body {
            return Ok(());
        }
        let what = "with a thermal body, levels and smoothness cannot be chosen automatically";
        let settings = [Setting::any("levels"), Setting::any("smooth")];
        let remedy = Remedy::new("give {} and {} yourself", settings);
        Err(Error::Fit(what.into()).remedied(remedy))
    }
}

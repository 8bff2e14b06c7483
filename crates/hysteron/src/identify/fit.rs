//! [`Fit`], the entry point of identification: options, choices left to the data, progress.

use crate::error::Result;
use crate::identify::choose::validate::{Candidates, cross_validate};
use crate::identify::options::{Choice, FitOptions, LoadLaw, Spacing};
use crate::identify::stages;
use crate::model::{Model, Sign, Solver, Start, Validation};
use crate::progress::Progress;
use crate::recording::Recording;
use hysteron_core::Operator;

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

    /// Number of levels, 2 or more. [`Auto`](crate::Auto) chooses it by cross-validation: the error on branches
    /// that were left out.
    #[must_use]
    pub fn levels(mut self, levels: impl Into<Choice<usize>>) -> Self {
        match levels.into() {
            Choice::Auto => self.auto_levels = true,
            Choice::Fixed(levels) => (self.options.levels, self.auto_levels) = (levels, false),
        }
        self
    }

    /// Strength of the smoothness, 0 or more. [`Auto`](crate::Auto) chooses it by cross-validation, as for the
    /// levels.
    #[must_use]
    pub fn smooth(mut self, smooth: impl Into<Choice<f64>>) -> Self {
        match smooth.into() {
            Choice::Auto => self.auto_smooth = true,
            Choice::Fixed(smooth) => (self.options.smooth, self.auto_smooth) = (smooth, false),
        }
        self
    }

    /// Number of bootstrap replicates, up to 10,000; 0 for none. [`Auto`](crate::Auto) takes
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

    /// What a load changes, for recordings with a load.
    #[must_use]
    pub fn load_law(mut self, law: LoadLaw) -> Self {
        self.options.load_law = law;
        self
    }

    /// Order of the weights as a function of the load, 0 to 5, for recordings with a load. [`Auto`](crate::Auto)
    /// chooses it by loads that are left out.
    #[must_use]
    pub fn load_degree(mut self, degree: impl Into<Choice<usize>>) -> Self {
        self.options.load_degree = match degree.into() {
            Choice::Auto => None,
            Choice::Fixed(degree) => Some(degree),
        };
        self
    }

    /// Where the levels are.
    #[must_use]
    pub fn spacing(mut self, spacing: Spacing) -> Self {
        self.options.spacing = spacing;
        self
    }

    /// Number of creep terms, 0 to 4. [`Auto`](crate::Auto) takes creep only if it predicts parts of the
    /// recording that were left out. The recordings need time.
    #[must_use]
    pub fn creep(mut self, terms: impl Into<Choice<usize>>) -> Self {
        self.options.creep = terms.into();
        self
    }

    /// Time constant of a lag of the whole, in seconds. [`Auto`](crate::Auto) takes one only if it predicts parts
    /// of the recording that were left out. The recordings need time.
    #[must_use]
    pub fn lag(mut self, seconds: impl Into<Choice<f64>>) -> Self {
        self.options.lag = seconds.into();
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
    /// initial state. If they have a load, the model depends on it.
    ///
    /// # Errors
    /// - [`crate::Error::Recording`] for an invalid recording or a constant input.
    /// - [`crate::Error::Core`] for an invalid plane.
    /// - [`crate::Error::Fit`] for options that contradict each other.
    /// - [`crate::Error::Thermal`] for a thermal body, creep or a lag without time.
    /// - The error that `progress` returns.
    pub fn run(&self, recordings: &(impl AsRef<[Recording]> + ?Sized)) -> Result<Model> {
        let recordings = recordings.as_ref();
        let chosen =
            |recordings: &[Recording], options: &FitOptions| self.chosen(recordings, options);
        stages::fit(recordings, &self.options, self.body, &chosen, self.progress)
    }

    /// The options with levels, smoothness and replicates, for recordings as the operators see them.
    fn chosen(
        &self,
        recordings: &[Recording],
        options: &FitOptions,
    ) -> Result<(FitOptions, Option<Validation>)> {
        let mut options = options.clone();
        let mut validation = None;
        if self.auto_levels || self.auto_smooth {
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
        Ok((options, validation))
    }
}

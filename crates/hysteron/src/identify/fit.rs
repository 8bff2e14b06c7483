//! The one door to identification.

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

/// Left to the data.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Auto;

/// A value, or left to the data; made of either by `into`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Choice<T> {
    /// Left to the data.
    Auto,
    /// This value.
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

/// Identifies a model from recordings: say what differs from the defaults, then [`run`](Fit::run).
///
/// The defaults are those of [`FitOptions`], but for the bootstrap: [`Fit::new`] takes as many
/// replicates as [`FitOptions::usual_bootstrap`] has for the levels, so that the model says how
/// certain it is.
///
/// Never forms the `n × N` matrix of operator states. The Gram matrix takes `O(N²)` memory and
/// `O(n + N²)` time, for inputs with few turning points at once. The weights take `O(N p + p²)` for
/// each of some `p` steps, `p` being those not zero.
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
    /// These options, and nothing left to the data.
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

    /// Number of levels; [`Auto`] chooses it by the error on branches that were left out.
    #[must_use]
    pub fn levels(mut self, levels: impl Into<Choice<usize>>) -> Self {
        match levels.into() {
            Choice::Auto => self.auto_levels = true,
            Choice::Fixed(levels) => (self.options.levels, self.auto_levels) = (levels, false),
        }
        self
    }

    /// Strength of the smoothness; [`Auto`] chooses it as the levels.
    #[must_use]
    pub fn smooth(mut self, smooth: impl Into<Choice<f64>>) -> Self {
        match smooth.into() {
            Choice::Auto => self.auto_smooth = true,
            Choice::Fixed(smooth) => (self.options.smooth, self.auto_smooth) = (smooth, false),
        }
        self
    }

    /// Replicates of the bootstrap; [`Auto`] takes [`FitOptions::usual_bootstrap`].
    #[must_use]
    pub fn bootstrap(mut self, replicates: impl Into<Choice<usize>>) -> Self {
        match replicates.into() {
            Choice::Auto => self.auto_bootstrap = true,
            Choice::Fixed(count) => (self.options.bootstrap, self.auto_bootstrap) = (count, false),
        }
        self
    }

    /// Lowest and highest level.
    #[must_use]
    pub fn range(mut self, min: f64, max: f64) -> Self {
        self.options.range = Some((min, max));
        self
    }

    /// How the weights are found.
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

    /// Output with every operator off.
    #[must_use]
    pub fn offset(mut self, offset: f64) -> Self {
        self.options.offset = Some(offset);
        self
    }

    /// Where the operators stand before the first sample of each recording.
    #[must_use]
    pub fn start(mut self, start: Start) -> Self {
        self.options.start = start;
        self
    }

    /// Order of the weights as a function of the load, where the recordings have one.
    #[must_use]
    pub fn load_degree(mut self, degree: usize) -> Self {
        self.options.load_degree = degree;
        self
    }

    /// Whether a thermal body stands in front of the operators and is identified with the weights.
    ///
    /// The recordings need time. Their input is a drive that heats (current squared, voltage
    /// squared, duty). For given time constants the weights are a closed problem; the search is
    /// over the time constants only (separable least squares, Golub and Pereyra 1973).
    #[must_use]
    pub fn thermal(mut self, body: bool) -> Self {
        self.body = body;
        self
    }

    /// Who is told of the progress, and may end the work.
    #[must_use]
    pub fn progress(mut self, progress: Progress<'a>) -> Self {
        self.progress = progress;
        self
    }

    /// Identifies the model. Several recordings are one experiment, each from its own initial
    /// state; with a load in them, the weights depend on it.
    ///
    /// # Errors
    /// [`Error::Recording`] for a recording that cannot be worked with or whose input never
    /// changes; [`Error::Core`] for a plane that cannot be; [`Error::Fit`] for options that
    /// contradict each other, and for levels or smoothness left to the data behind a thermal body;
    /// [`Error::Thermal`] for a thermal body without time; what `progress` returns.
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
        let what = "behind a thermal body neither levels nor smoothness can be chosen";
        let settings = [Setting::any("levels"), Setting::any("smooth")];
        let remedy = Remedy::new("give {} and {} yourself", settings);
        Err(Error::Fit(what.into()).remedied(remedy))
    }
}

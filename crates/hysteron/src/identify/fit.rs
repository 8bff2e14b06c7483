//! [`Fit`], the entry point of identification: options, choices left to the data, progress.

use crate::error::{Error, Result};
use crate::identify::choose::start::{at_rest, usual_start};
use crate::identify::choose::{Open, is_worth};
use crate::identify::delay;
use crate::identify::doubt::sessions::widen;
use crate::identify::heated::{self, Again};
use crate::identify::kept;
use crate::identify::options::{Choice, Dynamics, FitOptions, LoadLaw, Spacing, Thermal};
use crate::identify::outliers;
use crate::identify::prior::WeightPrior;
use crate::identify::stages::{self, Asked, SpacingShape};
use crate::identify::weights::problem::check_options;
use crate::identify::weights::room::check_columns;
use crate::model::{Delay, Model, Sign, Smooth, Solver, Start};
use crate::progress::Progress;
use crate::recording::Recording;
use crate::remedy::{Remedy, Setting};
use hysteron_core::{Operator, Plane};
use std::borrow::Cow;
use std::sync::Arc;

/// Identifies a model from recordings. Set the options that differ from the defaults, then call
/// [`run`](Fit::run).
///
/// [`Fit::new`] leaves everything to the data: levels, smoothness, spacing, start, outliers. It
/// runs a bootstrap with [`FitOptions::usual_bootstrap`] replicates, so the model has standard
/// errors and a band. A fit made from [`FitOptions::plain`] leaves nothing to the data.
///
/// The `n × N` matrix of operator states is never formed. For inputs with few turning points at
/// once the Gram matrix takes `O(n + N²)` time, and from 300 unknowns on it is kept sparse. The
/// solver then takes about `p` steps of `O(N p + p²)` each, where `p` is the number of weights that
/// are not zero; with smoothness and a sparse matrix, about ten sparse factors.
///
/// ```
/// use hysteron::{Fit, Recording};
/// let input: Vec<f64> = (0..200).map(|n| (1.0 - (f64::from(n) * 0.1).cos()) * 30.0).collect();
/// let output = input.iter().map(|t| 0.5 * t).collect(); // no hysteresis at all
/// let recording = Recording::new(input, output)?;
/// let model = Fit::new().run(&recording)?;
/// assert!(model.fit.is_some_and(|fit| fit.nrmse_percent < 1e-3));
///
/// let plain = Fit::new().levels(5).smooth(0.0).bootstrap(0).run(&recording)?;
/// assert_eq!(plain.plane().levels(), 5);
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Fit<'a> {
    pub(super) options: FitOptions,
    pub(super) open: Open,
    pub(super) auto_start: bool,
    pub(super) auto_bootstrap: bool,
    /// What was said of a body; `None` for nothing. Then one may be looked for unasked.
    pub(super) thermal: Option<Thermal>,
    /// How the levels follow the output, where that was chosen before.
    pub(super) shape: Option<SpacingShape>,
    /// Whether the model is tested on what is left out, even if nothing is chosen by it.
    pub(super) tested: bool,
    repeats: Vec<Recording>,
    pub(super) prior: Option<Arc<WeightPrior>>,
    progress: Progress<'a>,
}

impl Default for Fit<'_> {
    fn default() -> Self {
        let options = FitOptions {
            robust: true,
            spacing: Spacing::Auto,
            delay: Choice::Auto,
            dynamics: Dynamics::Auto,
            ..FitOptions::plain()
        };
        Self {
            open: Open {
                levels: true,
                smooth: true,
            },
            auto_start: true,
            auto_bootstrap: true,
            ..options.into()
        }
    }
}

impl From<FitOptions> for Fit<'_> {
    /// Fixed options; nothing is left to the data.
    fn from(options: FitOptions) -> Self {
        Self {
            options,
            open: Open {
                levels: false,
                smooth: false,
            },
            auto_start: false,
            auto_bootstrap: false,
            thermal: None,
            shape: None,
            tested: false,
            repeats: Vec::new(),
            prior: None,
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

    /// Number of levels, 2 or more. [`Auto`](crate::Auto) chooses it by cross-validation: the error
    /// on branches that were left out.
    #[must_use]
    pub fn levels(mut self, levels: impl Into<Choice<usize>>) -> Self {
        match levels.into() {
            Choice::Auto => self.open.levels = true,
            Choice::Fixed(levels) => (self.options.levels, self.open.levels) = (levels, false),
        }
        self
    }

    /// Strengths of the smoothness, along the diagonal or a pair of along and across.
    /// [`Auto`](crate::Auto) chooses them together with the levels.
    #[must_use]
    pub fn smooth(mut self, smooth: impl Into<Choice<Smooth>>) -> Self {
        match smooth.into() {
            Choice::Auto => self.open.smooth = true,
            Choice::Fixed(smooth) => (self.options.smooth, self.open.smooth) = (smooth, false),
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

    /// State of the operators before the first sample of each recording. [`Auto`](crate::Auto)
    /// takes off or on, unless an unknown start predicts clearly better.
    #[must_use]
    pub fn start(mut self, start: impl Into<Choice<Start>>) -> Self {
        match start.into() {
            Choice::Auto => self.auto_start = true,
            Choice::Fixed(start) => (self.options.start, self.auto_start) = (start, false),
        }
        self
    }

    /// Ridge on the weights, 0 to 1, relative to the mean diagonal element of the Gram matrix.
    #[must_use]
    pub fn ridge(mut self, ridge: f64) -> Self {
        self.options.ridge = ridge;
        self
    }

    /// Whether outliers, which stand out from their neighbours, are found and left out of the fit.
    #[must_use]
    pub fn robust(mut self, robust: bool) -> Self {
        self.options.robust = robust;
        self
    }

    /// What a load changes, for recordings with a load.
    #[must_use]
    pub fn load_law(mut self, law: LoadLaw) -> Self {
        self.options.load_law = law;
        self
    }

    /// Order of the weights as a function of the load, 0 to 5, for recordings with a load.
    /// [`Auto`](crate::Auto) chooses it by loads that are left out.
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

    /// Dead time of the actuator, in samples of the recordings: so many samples an input takes
    /// until the output begins to answer it ([`Delay`](crate::Delay)). [`Auto`](crate::Auto) looks
    /// for up to 60 and takes them only if they predict parts of the recordings that were left out
    /// by a tenth better. It finds none in recordings without time at equal distances, with a load,
    /// and where creep or a lag is asked for, which would take their part.
    #[must_use]
    pub fn delay(mut self, samples: impl Into<Choice<usize>>) -> Self {
        self.options.delay = samples.into();
        self
    }

    /// Number of creep terms, 0 to 4. [`Auto`](crate::Auto) takes creep only if it predicts parts
    /// of the recording that were left out. The recordings need time.
    #[must_use]
    pub fn creep(mut self, terms: impl Into<Choice<usize>>) -> Self {
        self.options.creep = terms.into();
        self
    }

    /// Time constant of a lag of the whole, in seconds. [`Auto`](crate::Auto) takes one only if it
    /// predicts parts of the recording that were left out. The recordings need time.
    #[must_use]
    pub fn lag(mut self, seconds: impl Into<Choice<f64>>) -> Self {
        self.options.lag = seconds.into();
        self
    }

    /// Whether a dead time or a stage that depends on time is asked for.
    pub(crate) fn asks_for_time(&self) -> bool {
        let is_late = matches!(self.options.delay, Choice::Fixed(samples) if samples > 0);
        is_late || self.options.needs_time() || self.is_heated()
    }

    /// Whether a dead time, a ring, a lag or a body that nobody asked for is looked for in
    /// recordings with time and without a load.
    pub(crate) fn looks_for_dynamics(&self) -> bool {
        self.options.looks_for_ring() || self.options.delay == Choice::Auto
    }

    /// Whether a thermal body is asked for.
    pub(super) fn is_heated(&self) -> bool {
        self.thermal.unwrap_or_default() != Thermal::None
    }

    /// Whether a thermal body that nobody asked for is looked for.
    fn looks_for_body(&self) -> bool {
        let is_open = self.options.dynamics == Dynamics::Auto && !self.options.asks_after();
        // A rest is found for a model without a body.
        let finds_rest = !self.auto_start && self.options.opens_rest();
        is_open && self.thermal.is_none() && self.prior.is_none() && !finds_rest
    }

    /// The same fit, which looks for no dynamics that nobody asked for.
    pub(crate) fn without_auto_dynamics(mut self) -> Self {
        if self.options.dynamics == Dynamics::Auto {
            self.options.dynamics = Dynamics::Off;
        }
        if self.options.delay == Choice::Auto {
            self.options.delay = Choice::Fixed(0);
        }
        self
    }

    /// What is looked for behind the operators in recordings with time: by default a ring, a
    /// resonance of the second order, where the recordings excite one, else a lag. It is taken only
    /// if it predicts parts of them that were left out. By default a thermal body in front of the
    /// operators is looked for, too, where what was left out is predicted to no better than 1 % of
    /// the range ([`error_without_body`](crate::FitSummary::error_without_body)). Recordings with a
    /// load get none.
    #[must_use]
    pub fn dynamics(mut self, dynamics: Dynamics) -> Self {
        self.options.dynamics = dynamics;
        self
    }

    /// Number of pieces of an output curve behind the operators, 1 to 100; 0 for none.
    /// [`Auto`](crate::Auto) takes a curve only if it predicts parts of the recordings that were
    /// left out. Recordings with a load get none.
    #[must_use]
    pub fn curve(mut self, pieces: impl Into<Choice<usize>>) -> Self {
        self.options.curve = pieces.into();
        self
    }

    /// Whether a thermal body in front of the operators is identified together with the weights:
    /// `true` or `false`, or [`Auto`](crate::Auto) for a body that may bind heat ([`Thermal`]).
    /// With `false`, none is looked for unasked either.
    ///
    /// The recordings need time. Their input is a drive that heats (squared current, squared
    /// voltage, duty cycle). For given time constants, finding the weights is a convex problem. So
    /// the search is over the time constants only (separable least squares, Golub and Pereyra
    /// 1973).
    #[must_use]
    pub fn thermal(mut self, thermal: impl Into<Thermal>) -> Self {
        self.thermal = Some(thermal.into());
        self
    }

    /// Other recordings of the same actuator. The weights are not fitted to them. They widen the
    /// band to what changes between sessions.
    #[must_use]
    pub fn repeats(mut self, repeats: Vec<Recording>) -> Self {
        self.repeats = repeats;
        self
    }

    /// What is known from other actuators of the same kind. Plane, spacing, operator and sign are
    /// then those of the prior, and there is neither smoothness nor a bootstrap.
    #[must_use]
    pub fn prior(mut self, prior: impl Into<Arc<WeightPrior>>) -> Self {
        self.prior = Some(prior.into());
        self
    }

    /// A callback for the progress, which may cancel the work.
    #[must_use]
    pub fn progress(mut self, progress: Progress<'a>) -> Self {
        self.progress = progress;
        self
    }

    /// Checks the options by themselves, as [`Fit::run`] does. Nothing is computed.
    ///
    /// ```
    /// use hysteron::Fit;
    /// assert!(Fit::new().levels(20).bootstrap(200).check().is_ok());
    /// assert!(Fit::new().levels(1_000_000).check().is_err());
    /// assert!(Fit::new().bootstrap(99_999_999).check().is_err());
    /// ```
    ///
    /// # Errors
    /// [`crate::Error::Core`] and [`crate::Error::Fit`] for a value out of range, or levels that take
    /// too much memory.
    pub fn check(&self) -> Result<()> {
        let plane = Plane::new(0.0, 1.0, self.options.levels)?;
        check_columns(plane.operators())?;
        check_options(&self.options)
    }

    /// Identifies the model. Several recordings are parts of one experiment, each with its own
    /// initial state. If they have a load, the model depends on it.
    ///
    /// # Errors
    /// - [`crate::Error::Recording`] for an invalid recording or a constant input.
    /// - [`crate::Error::Core`] for an invalid plane.
    /// - [`crate::Error::Fit`] for options that contradict each other, for creep, a lag or a ring
    ///   without time, a delay without samples at equal distances, and a repeat that is among the
    ///   recordings.
    /// - [`crate::Error::Thermal`] for a thermal body without time.
    /// - The error that `progress` returns.
    pub fn run(&self, recordings: &(impl AsRef<[Recording]> + ?Sized)) -> Result<Model> {
        let recordings = recordings.as_ref();
        let again = |repeat: &Recording| recordings.iter().any(|one| one.has_samples_of(repeat));
        if self.repeats.iter().any(again) {
            let what =
                "a recording that should widen the band to other sessions is among those fitted";
            let remedy = Remedy::new(
                "take one of another session for {}",
                [Setting::any("repeat")],
            );
            return Err(Error::Fit(what.to_owned()).remedied(remedy));
        }
        let mut found = self.timed(recordings)?;
        if self.looks_for_body()
            && [recordings, &self.repeats]
                .into_iter()
                .all(heated::can_show)
        {
            let again = |recordings: &[Recording], again: Again, progress: Progress<'_>| {
                let mut fit = self.clone().progress(progress);
                fit.tested = true;
                if again != Again::Cold {
                    fit.thermal = Some(Thermal::Auto);
                }
                if again != Again::Warm {
                    (fit.auto_bootstrap, fit.options.bootstrap) = (false, 0);
                }
                fit.timed(recordings)
            };
            found = heated::or_cold(recordings, &self.options, found, &again, self.progress)?;
        }
        let (mut model, delay) = found;
        widen(&mut model, &delay.of_recordings(&self.repeats))?;
        Ok(model.with_delay(delay))
    }

    /// The model, and the dead time before it.
    fn timed(&self, recordings: &[Recording]) -> Result<(Model, Delay)> {
        Ok(match self.options.delay {
            Choice::Auto if !self.options.asks_after() => self.delayed(recordings)?,
            Choice::Auto => (self.acting(recordings)?, Delay::NONE),
            Choice::Fixed(samples) => {
                let delay = delay::fixed(samples, recordings)?;
                (self.acting(&delay.of_recordings(recordings))?, delay)
            }
        })
    }

    /// The model, and the dead time before it, where the whole model is better with it than without
    /// it on what was left out, or is about as good as one with a stage that comes late in its place.
    /// A coarse grid takes a narrow loop for a dead time.
    fn delayed(&self, recordings: &[Recording]) -> Result<(Model, Delay)> {
        let at_once = self.acting(recordings)?;
        // Outliers would hide a dead time. A body and it change places, so what is behind the body
        // tells.
        let mended = outliers::mended_by(recordings, &at_once);
        let behind = match self.is_heated() {
            false => mended,
            true => {
                let mended = at_once.all_rested(&mended)?;
                let behind = mended.iter().map(|r| at_once.behind_body(r));
                Cow::Owned(behind.map(|r| Ok(r?.into_owned())).collect::<Result<_>>()?)
            }
        };
        let mut options = self.options.clone();
        if options.opens_rest()
            && let Some(fit) = &at_once.fit
        {
            (options.start, options.rest) = (fit.start, fit.rest());
        }
        let delay = delay::find(&behind, &options, self.progress)?;
        if delay.is_none() {
            return Ok((at_once, delay));
        }
        let late = self.acting(&delay.of_recordings(recordings))?;
        // What was taken for a ring or a lag has to be the better one, and to follow what was fitted
        // no worse: undoing a dead time does not multiply noise.
        let is_timed = |model: &Model| model.without_body().is_timed();
        let error = |model: &Model| model.fit.as_ref().map_or(f64::INFINITY, |fit| fit.rmse);
        let is_late = match is_timed(&at_once) && !is_timed(&late) {
            true => error(&late) < error(&at_once) && !is_worth(&at_once, &late),
            false => is_worth(&late, &at_once),
        };
        Ok(match is_late {
            true => (late, delay),
            false => (at_once, Delay::NONE),
        })
    }

    /// The model of recordings whose inputs act at once, but for the repeats. A ring that nobody
    /// asked for is taken where the whole model is better with it than without it: few paths that
    /// are left out can be predicted better by a ring than by operators that are not determined.
    fn acting(&self, recordings: &[Recording]) -> Result<Model> {
        let found = self.staged(recordings, true)?;
        let rings = found
            .fit
            .as_ref()
            .is_some_and(|fit| fit.other.contains_key(stages::RING));
        if !rings || self.options.dynamics == Dynamics::Ring {
            return Ok(found);
        }
        let still = self.staged(recordings, false)?;
        Ok(match is_worth(&found, &still) {
            true => found,
            false => still,
        })
    }

    /// The model with its stages, among them a ring if that may be.
    fn staged(&self, recordings: &[Recording], rings: bool) -> Result<Model> {
        let mut options = self.options.clone();
        if options.dynamics == Dynamics::Lag && options.lag == Choice::Fixed(0.0) {
            options.lag = Choice::Auto;
        }
        if options.needs_time() {
            stages::check_time(recordings)?;
        }
        // A body and a load change what the operators see of the first sample.
        let plain =
            !self.is_heated() && recordings.iter().all(|recording| recording.load.is_none());
        if let (true, Some(prior)) = (self.auto_start, &self.prior) {
            options.start = prior.start();
        } else if self.auto_start {
            // Most recordings with a body or a load begin with all operators off.
            options.start = match plain {
                true => Start::Unknown,
                false => Start::Off,
            };
        }
        // Outliers are found first: one of them can move the rest across the range.
        let open_rest = options.opens_rest() && plain;
        if open_rest {
            options.start = Start::Unknown;
        }
        let (seen, outliers) = match options.robust {
            true => outliers::mended(recordings, &options, self.progress)?,
            false => (Cow::Borrowed(recordings), Vec::new()),
        };
        if open_rest {
            options = at_rest(&seen, &options)?;
        }
        if self.auto_start && self.prior.is_none() && options.start == Start::Unknown {
            options = usual_start(&seen, &options)?;
        }
        let mut model = match &self.prior {
            Some(prior) => prior.fit(&seen, &options, self.progress)?,
            None => {
                let asked = Asked {
                    thermal: self.thermal.unwrap_or_default(),
                    open: self.open,
                    auto_bootstrap: self.auto_bootstrap,
                    shape: self.shape,
                    tested: self.tested,
                    rings,
                    outliers: &outliers,
                };
                stages::fit(&seen, &options, asked, self.progress)?
            }
        };
        if let Some(fit) = &mut model.fit {
            fit.outliers = outliers;
        }
        let mut model = kept::with_start(model, &seen, &options)?;
        kept::tell_errors(&mut model, recordings, |_| true)?;
        kept::tell_left_out(&mut model);
        if self.prior.is_none() {
            kept::tell_different(&mut model, recordings);
            kept::tell_recorded(&mut model, recordings);
        }
        Ok(model)
    }
}

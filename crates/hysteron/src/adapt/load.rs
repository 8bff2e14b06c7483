//! A model that follows an unknown load while it runs, sample by sample.

use crate::error::{Error, Result};
use crate::model::{Model, Sample, Start, State, Wanted};
use hysteron_core::{Channel, Learning, ShiftEstimator, ShiftOptions, Solution, Stages};

/// A [`Model`] under a load that nobody measures, with its state.
///
/// When the weight on the hook changes, the operators' axis shifts. This follows the shift alone,
/// by [`ShiftEstimator`], and leaves the weights as they are. It runs any model: with a thermal
/// body each sample needs its time step. If the model depends on a load, the shift tells the load,
/// and offset, stroke and weights are those of that load.
///
/// ```
/// use hysteron::{AdaptiveLoad, Model, Operator, Plane, Sign};
/// let model = |low: f64| {
///     let plane = Plane::new(low, low + 60.0, 20)?;
///     Model::new(Operator::Mkp, plane, vec![1.0; 210], 0.0, Sign::Positive)
/// };
/// let mut adaptive = AdaptiveLoad::new(&model(20.0)?, None, None)?;
/// // The wire under a load: everything happens 8 K higher.
/// let (plant, mut state) = (model(28.0)?, model(28.0)?.start());
/// for n in 0..500 {
///     let input = 55.0 - 45.0 * (0.05 * f64::from(n)).cos();
///     adaptive.step(input, plant.step(&mut state, input)?.output)?;
/// }
/// assert!((adaptive.shift() - 8.0).abs() < 0.1);
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct AdaptiveLoad {
    offline: Model,
    /// The load that the shift departs from.
    told: Option<f64>,
    estimator: ShiftEstimator<f64>,
    state: State,
    /// State of the inverse, at the drives that it asked for.
    wanted: State,
    /// State of the model left alone.
    alone: State,
    /// The load that the weights are those of.
    placed: Option<f64>,
}

impl AdaptiveLoad {
    /// Follows the shift of `model`. It starts with all operators off, and, if the model depends on
    /// a load, at `load` or in the middle of its range. Without options it takes the usual ones
    /// ([`ShiftOptions::usual`]).
    ///
    /// # Errors
    /// [`Error::Core`] for options out of range; [`Error::Fit`] for a load outside the model's range
    /// or of a model without one, and for weights that are all zero.
    pub fn new(
        model: &Model,
        load: Option<f64>,
        options: impl Into<Option<ShiftOptions<f64>>>,
    ) -> Result<Self> {
        super::refuse_unusable(model)?;
        let told = match (&model.load, load) {
            (None, None) => None,
            (None, Some(_)) => return Err(crate::model::no_load()),
            (Some(dependence), load) => {
                let (low, high) = dependence.range();
                let load = load.unwrap_or(0.5 * (low + high));
                dependence.factors(load)?;
                Some(load)
            }
        };
        let options = options.into().unwrap_or_else(|| Self::usual_options(model));
        let core = &model.operators().core;
        let mut adaptive = Self {
            told,
            estimator: ShiftEstimator::new(options, core, &model.stages())?,
            state: model.off(),
            wanted: model.off(),
            alone: model.off(),
            placed: told,
            offline: model.clone(),
        };
        adaptive.reset();
        Ok(adaptive)
    }

    /// The usual options for `model`.
    #[must_use]
    pub fn usual_options(model: &Model) -> ShiftOptions<f64> {
        ShiftOptions::usual(&model.operators().core, &model.stages())
    }

    /// Moves to a sample, returns the output expected there, and learns from the output `measured`.
    /// The sample has no load: that is what is looked for.
    ///
    /// # Errors
    /// As [`Model::step`], and [`Error::Core`] for a measured output that is not finite. Then nothing
    /// is changed.
    pub fn step(&mut self, sample: impl Into<Sample>, measured: f64) -> Result<Learning<f64>> {
        let sample = self.under(sample.into())?;
        if !measured.is_finite() {
            return Err(hysteron_core::Error::InputNotFinite { index: 1 }.into());
        }
        let expected = self.offline.step(&mut self.alone, sample)?.output;
        self.estimator.expect(expected)?;
        let learning = self.with_state(|estimator, stages, core, state| {
            let State {
                operators,
                stages: memory,
                ..
            } = state;
            estimator.step(stages, core, operators, memory, sample, measured)
        })?;
        self.follow()?;
        Ok(learning)
    }

    /// Moves to a sample and returns the output expected there, without learning.
    ///
    /// # Errors
    /// As [`Model::step`].
    pub fn simulate(&mut self, sample: impl Into<Sample>) -> Result<f64> {
        let sample = self.under(sample.into())?;
        self.offline.step(&mut self.alone, sample)?;
        let output = self.with_state(|estimator, stages, core, state| {
            let State {
                operators,
                stages: memory,
                ..
            } = state;
            estimator.simulate(stages, core, operators, memory, sample)
        })?;
        Ok(output.output)
    }

    /// Finds the input for what is wanted at the present shift. The inverse moves there from its own
    /// state, because the reference and the plant are at different points.
    ///
    /// # Errors
    /// As [`crate::Inverse::step`].
    pub fn solve(&mut self, wanted: impl Into<Wanted>) -> Result<Solution<f64>> {
        let mut state = self.wanted.clone();
        let solution = self.solve_from(&mut state, wanted.into())?;
        self.wanted = state;
        Ok(solution)
    }

    /// Sets the state of the inverse to that of the measured input.
    pub fn align(&mut self) {
        self.wanted.clone_from(&self.state);
    }

    /// As [`AdaptiveLoad::solve`], from a `state` of the caller.
    ///
    /// # Errors
    /// As [`AdaptiveLoad::solve`].
    pub(crate) fn solve_from(&self, state: &mut State, wanted: Wanted) -> Result<Solution<f64>> {
        let model = &self.offline;
        // Refuses what the model cannot have: time, negative weights, a load.
        model.inverse()?;
        let sample = self.under(Sample {
            input: wanted.target.output,
            dt: wanted.dt,
            load: wanted.load,
        })?;
        let wanted = hysteron_core::Wanted {
            target: wanted.target,
            dt: wanted.dt,
            load: sample.load,
            drive: model.drive_range(),
            horizon: 0.0,
            temperature: wanted.temperature,
        };
        let run = |stages: &Stages<'_, f64>, core: &Core, state: &mut State| {
            let State {
                operators,
                stages: memory,
                ..
            } = state;
            let inverse = core.inverse()?;
            self.estimator
                .invert(stages, &inverse, operators, memory, wanted)
        };
        on_operators(model, self.placed, state, run)
    }

    /// The shift of the axis from the load that it started at, in the input's unit.
    #[must_use]
    pub fn shift(&self) -> f64 {
        self.estimator.shift()
    }

    /// Standard deviation of the shift, as the filter believes it.
    #[must_use]
    pub fn deviation(&self) -> f64 {
        self.estimator.variance().sqrt()
    }

    /// The load that the shift tells. `None` for a model whose shift says nothing of the load.
    /// Beyond the model's range it is the outermost load.
    #[must_use]
    pub fn load(&self) -> Option<f64> {
        let stages = self.offline.stages();
        self.estimator
            .load(&stages.axis.load, self.told)
            .ok()
            .flatten()
    }

    /// The current model: the one given, with its levels shifted, or at the load found.
    ///
    /// # Errors
    /// As [`Model::new`].
    pub fn model(&self) -> Result<Model> {
        self.offline.shifted(self.told, self.shift())
    }

    /// The model before adaptation.
    #[must_use]
    pub fn offline(&self) -> &Model {
        &self.offline
    }

    /// The channel that stands still while the other one moves: nothing is learned.
    #[must_use]
    pub fn stuck(&self) -> Option<Channel> {
        self.estimator.stuck()
    }

    /// The load that the shift departs from.
    #[must_use]
    pub fn told(&self) -> Option<f64> {
        self.told
    }

    /// The current state of operators and stages.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The options.
    #[must_use]
    pub fn options(&self) -> &ShiftOptions<f64> {
        self.estimator.options()
    }

    /// Turns every operator off, also in the state of the inverse. The shift stays.
    pub fn reset(&mut self) {
        self.begin(self.offline.off());
    }

    /// Turns every operator on, also in the state of the inverse. The shift stays.
    pub fn saturate(&mut self) {
        self.begin(self.offline.saturated());
    }

    /// Begins a recording, also in the state of the inverse. The shift stays.
    pub(super) fn start_from(&mut self, start: Start) {
        self.begin(self.offline.state_at(start));
    }

    /// While frozen, [`AdaptiveLoad::step`] returns the expected output but does not learn.
    pub fn freeze(&mut self, frozen: bool) {
        self.estimator.freeze(frozen);
    }

    fn begin(&mut self, state: State) {
        self.estimator.realign();
        self.alone.clone_from(&state);
        self.state = state;
        self.align();
    }

    /// The sample under the load that the shift departs from.
    fn under(&self, sample: Sample) -> Result<Sample> {
        match sample.load {
            Some(_) => {
                let what = "the load is what is looked for: leave it out";
                Err(Error::Fit(what.into()))
            }
            None => Ok(Sample {
                load: self.told,
                ..sample
            }),
        }
    }

    /// Lets the weights follow the load.
    fn follow(&mut self) -> Result<()> {
        if let (Some(placed), Some(dependence)) = (self.placed, &self.offline.load) {
            let stages = self.offline.stages();
            let load = &stages.axis.load;
            let range = dependence.range();
            let renewed = self.estimator.renewed(load, self.told, placed, range)?;
            self.placed = Some(renewed);
        }
        Ok(())
    }

    fn with_state<R>(
        &mut self,
        run: impl FnOnce(
            &mut ShiftEstimator<f64>,
            &Stages<'_, f64>,
            &Core,
            &mut State,
        ) -> std::result::Result<R, hysteron_core::Error>,
    ) -> Result<R> {
        let estimator = &mut self.estimator;
        let run = |stages: &Stages<'_, f64>, core: &Core, state: &mut State| {
            run(estimator, stages, core, state)
        };
        on_operators(&self.offline, self.placed, &mut self.state, run)
    }
}

type Core = hysteron_core::Model<f64, Vec<f64>>;

/// Runs on the operators and stages of `model` with the weights of the load `placed`.
fn on_operators<R>(
    model: &Model,
    placed: Option<f64>,
    state: &mut State,
    run: impl FnOnce(
        &Stages<'_, f64>,
        &Core,
        &mut State,
    ) -> std::result::Result<R, hysteron_core::Error>,
) -> Result<R> {
    let mut stages = model.stages();
    let done = match state.place(model, placed)? {
        None => run(&stages, &model.operators().core, state),
        Some(mixed) => {
            stages.offset = mixed.offset;
            let done = run(&stages, &mixed.core, state);
            state.mixed = Some(mixed);
            done
        }
    };
    done.map_err(|error| model.worded(error))
}

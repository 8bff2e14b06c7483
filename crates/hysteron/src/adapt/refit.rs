//! Windowed refit: non-negative least squares over the last samples, again and again while the
//! model runs.

use super::sums::Centred;
use super::window::{Samples, Window};
use crate::error::Result;
use crate::identify::{SparseForm, nnls, pivoting};
use crate::model::{Model, OperatorState};
use crate::progress::Progress;
use hysteron_core::{Gate, Learning, Operator, Outcome};
use serde::Serialize;

/// A model whose weights are written anew.
type Core = hysteron_core::Model<f64, Vec<f64>>;

/// Rounding left after centring, relative to the diagonal before it.
const ROUNDING: f64 = 1e-13;

/// By default a refit follows where so large a share of the window is new.
const NEW: usize = 8;

/// The options of a windowed refit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Refit {
    /// The samples that a refit uses.
    pub window: Window,
    /// Samples between two refits, from 1; `None`: at each turning point of the input, and where an
    /// eighth of the window is new.
    pub every: Option<u32>,
    /// Strength of the ridge that holds the weights where they are, relative to the mean diagonal
    /// element of the window's matrix; above 0 and up to 1.
    pub ridge: f64,
    /// Levels that the input has to move before a sample enters the window, from 0.
    pub movement: f64,
    /// As [`hysteron_core::Adaptation::gate`].
    pub gate: f64,
    /// As [`hysteron_core::Adaptation::burst`].
    pub burst: u32,
}

impl Refit {
    fn check(&self) -> Result<()> {
        let fits = [
            ("window", self.window.is_usable()),
            ("every", self.every != Some(0)),
            ("ridge", self.ridge > 0.0 && self.ridge <= 1.0),
            ("movement", self.movement >= 0.0 && self.movement.is_finite()),
            ("gate", self.gate == 0.0 || self.gate >= 2.0 && self.gate.is_finite()),
            ("burst", self.burst > 0),
        ];
        match fits.into_iter().find(|(_, fits)| !fits) {
            Some((option, _)) => Err(hysteron_core::Error::Adaptation { option }.into()),
            None => Ok(()),
        }
    }
}

/// The weights and the offset of the present, and the samples that the next refit uses.
#[derive(Debug, Clone)]
pub(super) struct Refitter {
    options: Refit,
    form: SparseForm,
    samples: Samples,
    /// Weights of states in `[0, 1]`: for MKP the model's, for KP and relay twice the model's.
    weights: Vec<f64>,
    /// The output with every state 0.
    offset: f64,
    good: (Vec<f64>, f64),
    gate: Gate<f64>,
    /// The outputs in the window are relative to this, so that their squares stay small.
    level: f64,
    /// The position of the last sample that entered the window.
    learned: f64,
    /// Number of samples since the last refit.
    new: usize,
    frozen: bool,
    /// A model's weight for one of a state in `[0, 1]`.
    factor: f64,
}

impl Refitter {
    pub(super) fn new(model: &Model, options: Refit) -> Result<Self> {
        options.check()?;
        let core = model.plain()?;
        let plane = *core.plane();
        let factor = match core.operator() {
            Operator::Mkp => 1.0,
            Operator::Kp | Operator::Relay => 0.5,
        };
        let weights: Vec<f64> = core.weights().iter().map(|mu| mu / factor).collect();
        let raw = model.sign().factor() * model.offset();
        let offset = raw - (1.0 - factor) * weights.iter().sum::<f64>();
        let (off, on) = model.output_range();
        Ok(Self {
            form: SparseForm::new(plane, core.operator())?,
            samples: Samples::new(options.window, plane.levels(), plane.operators()),
            good: (weights.clone(), offset),
            level: offset,
            weights,
            offset,
            gate: Gate::new((on - off).abs()),
            learned: f64::NEG_INFINITY,
            new: 0,
            frozen: false,
            factor,
            options,
        })
    }

    /// The model's weights.
    pub(super) fn weights(&self) -> Vec<f64> {
        self.weights.iter().map(|x| self.factor * x).collect()
    }

    /// The output with `H = 0`.
    pub(super) fn offset(&self) -> f64 {
        self.offset + (1.0 - self.factor) * self.weights.iter().sum::<f64>()
    }

    /// Moves `state` to `input`, predicts the output there, and takes the sample into the window.
    /// Refits `core` if that is due. As [`hysteron_core::Estimator::step`].
    pub(super) fn step(
        &mut self,
        core: &mut Core,
        state: &mut OperatorState,
        input: f64,
        measured: f64,
    ) -> Result<Learning<f64>> {
        if !measured.is_finite() {
            return Err(hysteron_core::Error::InputNotFinite { index: 1 }.into());
        }
        let sum = core.step(state, input)?;
        let output = sum.output + self.offset();
        let error = measured - output;
        let (mut outcome, due) = self.take(state, measured, error);
        if due && self.refit(core)? {
            core.rebase(state)?;
            outcome = Outcome::Learned;
        }
        if matches!(outcome, Outcome::Learned | Outcome::Waiting) {
            self.gate
                .settle(measured - core.output(state) - self.offset());
        }
        Ok(Learning {
            output,
            error,
            outcome,
            clipped: sum.clipped,
        })
    }

    /// Takes a sample into the window, unless the input is at rest or the gate refuses it. `error`
    /// is that of its prediction. Returns what became of it, and whether a refit is due.
    fn take(&mut self, state: &OperatorState, measured: f64, error: f64) -> (Outcome, bool) {
        self.samples.follow(state);
        if self.frozen {
            return (Outcome::Frozen, false);
        }
        let position = state.position();
        if (position - self.learned).abs() <= self.options.movement {
            return (Outcome::AtRest, false);
        }
        self.learned = position;
        let Refit { gate, burst, .. } = self.options;
        if !self.gate.believes(error, gate, burst) {
            return (Outcome::Rejected, false);
        }
        let turned = self
            .samples
            .push(&self.form, state, measured - self.level);
        self.new += 1;
        let due = match self.options.every {
            Some(every) => self.new >= every as usize,
            None => turned || NEW * self.new >= self.samples.len(),
        };
        (Outcome::Waiting, due)
    }

    /// Fits weights and offset to the window, and writes them to `core`. Returns whether they
    /// changed; they do not where nothing is new, or where numbers overflow.
    pub(super) fn refit(&mut self, core: &mut Core) -> Result<bool> {
        if std::mem::take(&mut self.new) == 0 {
            return Ok(false);
        }
        let Some(centred) = self.samples.sums().centred(&self.form) else {
            return Ok(false);
        };
        let Some(weights) = solve(&centred, &self.weights, self.options.ridge) else {
            return Ok(false);
        };
        let offset = self.level + centred.offset(&weights);
        let size: f64 = weights.iter().sum();
        if !(offset.is_finite() && (size + size).is_finite()) {
            return Ok(false);
        }
        (self.weights, self.offset) = (weights, offset);
        core.set_weights(&self.weights())?;
        Ok(true)
    }

    /// Others moved the state along its branches.
    pub(super) fn follow(&mut self, state: &OperatorState) {
        self.samples.follow(state);
    }

    pub(super) fn freeze(&mut self, frozen: bool) {
        self.frozen = frozen;
        if frozen {
            self.samples.break_off();
        }
    }

    /// Others set the state.
    pub(super) fn realign(&mut self) {
        self.samples.break_off();
        self.learned = f64::NEG_INFINITY;
    }

    pub(super) fn keep(&mut self) {
        self.good = (self.weights.clone(), self.offset);
    }

    /// Returns to the last good weights. The window is emptied, for the next refit would bring back
    /// what was learned from it.
    pub(super) fn roll_back(&mut self, core: &mut Core) -> Result<()> {
        (self.weights, self.offset) = self.good.clone();
        self.samples.clear();
        self.gate.restart();
        self.new = 0;
        Ok(core.set_weights(&self.weights())?)
    }
}

/// The weights `x ≥ 0` that minimise the squared error over the window plus a ridge towards
/// `before`. `None` where rounding leaves no answer.
fn solve(centred: &Centred, before: &[f64], ridge: f64) -> Option<Vec<f64>> {
    let count = before.len();
    let mut matrix = centred.gram.clone();
    let trace: f64 = (0..count).map(|n| matrix[n * (count + 1)]).sum();
    let strength = ridge * trace / count as f64 + ROUNDING * centred.largest;
    // Without a sample that moved an operator, only the offset is learned.
    if trace.is_nan() || trace <= ROUNDING * centred.largest {
        return Some(before.to_vec());
    }
    let mut right = centred.right.clone();
    for n in 0..count {
        matrix[n * (count + 1)] += strength;
        right[n] += strength * before[n];
    }
    let (mut x, exact) = pivoting::minimum(&matrix, &right, before);
    if !exact {
        nnls::solve(&matrix, &right, &mut x, Progress::NONE).ok()?;
    }
    Some(x)
}

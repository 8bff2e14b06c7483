//! Windowed refit: non-negative least squares over the last samples, again and again while the
//! model runs.

use super::sums::Centred;
use super::window::{Samples, Window};
use crate::error::{Error, Result};
use crate::identify::{SparseForm, pivoting};
use crate::model::{Model, OperatorState};
use crate::progress::Progress;
use hysteron_core::{
    Adaptation, Channel, Gate, Learning, Operator, Outcome, Reading, Verdict, Watch, Watched,
};
use serde::Serialize;

/// A model whose weights are written anew.
pub(super) type Core = hysteron_core::Model<f64, Vec<f64>>;

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

/// What [`crate::AdaptOptions`] has as defaults.
impl Default for Refit {
    fn default() -> Self {
        let guards = Adaptation::<f64>::default();
        Self {
            window: Window::default(),
            every: None,
            ridge: 0.1,
            movement: guards.movement,
            gate: guards.gate,
            burst: guards.burst,
        }
    }
}

impl Refit {
    fn check(&self) -> Result<()> {
        let own = [
            ("window", self.window.is_usable(), Window::RANGE),
            ("every", self.every != Some(0), "1 or more"),
            (
                "ridge",
                self.ridge > 0.0 && self.ridge <= 1.0,
                "above 0 and up to 1",
            ),
        ];
        if let Some((option, _, range)) = own.into_iter().find(|(_, fits, _)| !fits) {
            return Err(Error::Fit(format!("`{option}` must be {range}")));
        }
        let guards = Adaptation {
            movement: self.movement,
            gate: self.gate,
            burst: self.burst,
            ..Adaptation::default()
        };
        Ok(guards.check()?)
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
    watch: Watch<f64>,
    /// The model left alone, and a copy of the state for it.
    alone: Core,
    there: OperatorState,
    /// Weights and offset before the last piece of the watch in which the output moved, and before
    /// the present piece.
    trusted: (Vec<f64>, f64),
    pending: (Vec<f64>, f64),
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
            trusted: (weights.clone(), offset),
            pending: (weights.clone(), offset),
            alone: core.core.clone(),
            there: core.start(),
            watch: Watch::new((on - off).abs(), plane.levels() as f64),
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
        let before = self.watch.stuck();
        let (mut outcome, due) = self.take(state, measured, error)?;
        if outcome.is_stuck() && before.is_none() {
            self.undo(core)?;
            core.rebase(state)?;
        }
        if due && self.refit(core)? {
            core.rebase(state)?;
            outcome = Outcome::Learned;
        }
        if matches!(outcome, Outcome::Learned | Outcome::Waiting) || outcome.is_stuck() {
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

    /// Takes a sample into the window, unless the input is at rest, the gate refuses it or a channel
    /// stands still. `error` is that of its prediction. Returns what became of it, and whether a refit is due.
    fn take(
        &mut self,
        state: &OperatorState,
        measured: f64,
        error: f64,
    ) -> Result<(Outcome, bool)> {
        self.samples.follow(state);
        if self.frozen {
            return Ok((Outcome::Frozen, false));
        }
        let position = state.position();
        if (position - self.learned).abs() <= self.options.movement {
            return Ok((Outcome::AtRest, false));
        }
        self.learned = position;
        let Refit { gate, burst, .. } = self.options;
        let believed = self.gate.judge(error, gate, burst) != Verdict::Refused;
        if gate > 0.0
            && let Some(channel) = self.find_stuck(state, measured, believed)?
        {
            return Ok((channel.outcome(), false));
        }
        if !believed {
            return Ok((Outcome::Rejected, false));
        }
        let turned = self.samples.push(&self.form, state, measured - self.level);
        self.new += 1;
        let due = match self.options.every {
            Some(every) => self.new >= every as usize,
            None => turned || NEW * self.new >= self.samples.len(),
        };
        Ok((Outcome::Waiting, due))
    }

    /// The channel that stands still.
    fn find_stuck(
        &mut self,
        state: &OperatorState,
        measured: f64,
        believed: bool,
    ) -> Result<Option<Channel>> {
        self.there.clone_from(state);
        self.alone.rebase(&mut self.there)?;
        let reading = Reading {
            position: state.position(),
            expected: self.alone.output(&self.there),
            measured,
        };
        if let Watched::Piece { alive } = self.watch.look(reading, believed) {
            let now = (self.weights.clone(), self.offset);
            let before = std::mem::replace(&mut self.pending, now);
            if alive {
                self.trusted = before;
            }
        }
        Ok(self.watch.stuck())
    }

    /// Returns to what it had learned before a channel stood still. The window is emptied, for it has
    /// readings of that channel.
    fn undo(&mut self, core: &mut Core) -> Result<()> {
        self.good = self.trusted.clone();
        self.pending = self.trusted.clone();
        self.restore(core)
    }

    pub(super) fn stuck(&self) -> Option<Channel> {
        self.watch.stuck()
    }

    fn watch_anew(&mut self) {
        self.trusted = (self.weights.clone(), self.offset);
        self.pending = self.trusted.clone();
        self.watch.restart();
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
        let Some(weights) = solve(&centred, (&self.weights, &self.weights), self.options.ridge)
        else {
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
        self.watch.restart();
        if frozen {
            self.samples.break_off();
        }
    }

    /// Others set the state.
    pub(super) fn realign(&mut self) {
        self.samples.break_off();
        self.learned = f64::NEG_INFINITY;
        self.watch_anew();
    }

    pub(super) fn keep(&mut self) {
        self.good = (self.weights.clone(), self.offset);
        self.watch_anew();
    }

    /// Returns to the last good weights. The window is emptied, for the next refit would bring back
    /// what was learned from it.
    pub(super) fn roll_back(&mut self, core: &mut Core) -> Result<()> {
        self.restore(core)?;
        self.watch_anew();
        Ok(())
    }

    fn restore(&mut self, core: &mut Core) -> Result<()> {
        (self.weights, self.offset) = self.good.clone();
        self.samples.clear();
        self.gate.restart();
        self.new = 0;
        Ok(core.set_weights(&self.weights())?)
    }
}

/// The weights `x ≥ 0` that minimise the squared error over the window plus a ridge towards `prior`,
/// searched from `start`. `None` where rounding leaves no answer.
fn solve(centred: &Centred, (prior, start): (&[f64], &[f64]), ridge: f64) -> Option<Vec<f64>> {
    let strength = centred.strength(ridge)?;
    if strength == 0.0 {
        return Some(prior.to_vec());
    }
    let count = prior.len();
    let (mut matrix, mut right) = (centred.gram.clone(), centred.right.clone());
    for n in 0..count {
        matrix[n * (count + 1)] += strength;
        right[n] += strength * prior[n];
    }
    pivoting::nonnegative(&matrix, &right, start, Progress::NONE).ok()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::model::{Plane, Sign};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// A window over random strokes, the states of its samples and their outputs.
    fn window(rng: &mut ChaCha8Rng, operator: Operator) -> (Centred, Vec<Vec<f64>>, Vec<f64>) {
        let levels = rng.random_range(2..9);
        let plane = Plane::new(0.0, 1.0, levels).unwrap();
        let weights = vec![1.0; plane.operators()];
        let model = Model::new(operator, plane, weights, 0.0, Sign::Positive).unwrap();
        let form = SparseForm::new(plane, operator).unwrap();
        let mut samples = Samples::new(Window::Samples(200), levels, plane.operators());
        let (mut states, mut outputs) = (Vec::new(), Vec::new());
        let (core, mut state) = (model.plain().unwrap(), model.plain().unwrap().start());
        for _ in 0..rng.random_range(1..150) {
            core.step(&mut state, rng.random_range(-0.3..1.3)).unwrap();
            let y = rng.random_range(-1.0..3.0);
            samples.push(&form, &state, y);
            let of = |(i, j)| state.gamma(i, j).unwrap();
            states.push(hysteron_core::operators(levels).map(of).collect());
            outputs.push(y);
        }
        (samples.sums().centred(&form).unwrap(), states, outputs)
    }

    #[test]
    fn a_refit_is_the_minimum_from_any_start() {
        let mut rng = ChaCha8Rng::seed_from_u64(16);
        for round in 0..120 {
            let operator = [Operator::Mkp, Operator::Kp, Operator::Relay][round % 3];
            let (centred, states, outputs) = window(&mut rng, operator);
            let count = states[0].len();
            let mut random = |zeros: f64| -> Vec<f64> {
                let mut one = || match rng.random_bool(zeros) {
                    true => 0.0,
                    false => rng.random_range(0.0..2.0),
                };
                (0..count).map(|_| one()).collect()
            };
            let (prior, other) = (random(0.5), random(0.2));
            let ridge = [1.0, 1e-2, 1e-5][round / 3 % 3];
            let warm = solve(&centred, (&prior, &prior), ridge).unwrap();
            for start in [vec![0.0; count], other] {
                let cold = solve(&centred, (&prior, &start), ridge).unwrap();
                for (a, b) in warm.iter().zip(&cold) {
                    // The condition number is at most N over the ridge, 4e6; rounding of 1e-16 of
                    // sums of 150 products.
                    assert!((a - b).abs() < 1e-7, "round {round}: {a} {b}");
                }
            }
            // The conditions of Karush, Kuhn and Tucker, from the states themselves.
            let n = outputs.len() as f64;
            let strength = centred.strength(ridge).unwrap();
            let offset = centred.offset(&warm);
            let error = |(row, y): (&Vec<f64>, &f64)| {
                y - offset - row.iter().zip(&warm).map(|(g, x)| g * x).sum::<f64>()
            };
            let errors: Vec<f64> = states.iter().zip(&outputs).map(error).collect();
            // Each tolerance: 150 products of size ten, rounded.
            assert!(errors.iter().sum::<f64>().abs() < 1e-9 * n, "round {round}");
            for k in 0..count {
                let fall: f64 = states.iter().zip(&errors).map(|(row, e)| row[k] * e).sum();
                let fall = fall - strength * (warm[k] - prior[k]);
                let breach = if warm[k] > 0.0 {
                    fall.abs()
                } else {
                    fall.max(0.0)
                };
                assert!(warm[k] >= 0.0 && breach < 1e-7, "round {round}: {breach}");
            }
        }
    }
}

//! A mixture of learners: several learn side by side, and the model is their mean.
//!
//! All of them are over one plane, and their weights are zero or above. So the mean of their
//! weights, each by its share, is again such a model: one inverse, at the cost of one model.
//!
//! Shares come from errors at two horizons ([`Shares`]). The output *expected* at the next sample is
//! the mean by the errors of such expectations. The *model*, which an inverse uses and a file
//! keeps, is for the stroke to come: its shares come from the errors of weights as they were at the
//! last turning point of the input, and by a quarter from those of the next sample.

use super::expert::Expert;
use super::learner::Learner;
use super::learns::{Learns, writable};
use super::refit::{Core, Refit};
use super::shares::{Shares, mean};
use super::strokes::{LEAST, Strokes};
use super::unsure::Unsure;
use crate::error::Result;
use crate::model::{Model, OperatorState};
use hysteron_core::{Adaptation, Channel, Learning, Outcome, Reading, Watch, Watched};

/// The options of the learners that [`Learner::Auto`] mixes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AutoOptions {
    /// Of a few coefficients.
    pub drift: Adaptation<f64>,
    /// Of all weights, from increments.
    pub increments: Adaptation<f64>,
    /// Of all weights, by recursive least squares. `None` for a model with so many operators that a
    /// step takes longer than a loop has.
    pub least_squares: Option<Adaptation<f64>>,
    /// Of all weights, by refits, and their trend. `None` as before, and where no sample may take
    /// longer than the others.
    pub refit: Option<Refit>,
}

/// How far a model that settles goes on after the last cycle, in differences of the last two.
const TREND: f64 = 0.5;

/// What the next sample weighs in the shares of the model, beside the stroke to come. The experts
/// go on learning on the way there: one that follows each change may foretell a stroke badly, and
/// be the best all the same.
const NEXT: f64 = 0.25;

/// The shares of both horizons.
#[derive(Debug, Clone)]
struct Both {
    /// One sample ahead.
    near: Shares,
    /// A stroke ahead.
    far: Shares,
}

impl Both {
    /// The shares of what the model follows.
    fn of_model(&self) -> Vec<f64> {
        self.far.beside(&self.near, NEXT)
    }
}

/// The part of the way to what the experts know that the model goes at a sample between turning
/// points. All of it would be feedback of each reading to the next drive, at any frequency: it
/// shakes a resonance that the model does not have.
const FOLLOWED: f64 = 1.0 / 3.0;

/// What is returned to: shares, trend and model as they were when all was well.
#[derive(Debug, Clone)]
struct Good {
    shares: Both,
    trend: Option<(Vec<f64>, f64)>,
    model: (Vec<f64>, f64),
}

/// Learners side by side, the one that learns nothing first.
#[derive(Debug, Clone)]
pub(super) struct Mixture {
    experts: Vec<Expert>,
    /// The places of the refit, and of its trend.
    trend: Option<(usize, usize)>,
    shares: Both,
    /// Finds the pieces of the run in which the output moved.
    watch: Watch<f64>,
    /// The shares before the last such piece, and before the present one. What a channel that
    /// stands still has said is undone by them.
    trusted: Both,
    pending: Both,
    good: Good,
    /// What follows the mean of the experts by the model's shares.
    weights: Vec<f64>,
    offset: f64,
    strokes: Strokes,
    /// A state for weights of the past.
    there: OperatorState,
    /// Of a mixture that has just begun: the model stays as it is, and nobody is judged by what the
    /// start explains.
    unsure: Option<Unsure>,
    frozen: bool,
}

impl Mixture {
    /// A mixture of `learners` of `model`, and of the model as it is. A refit has its trend beside
    /// it.
    pub(super) fn new(
        model: &Model,
        mut learners: Vec<(&'static str, (Core, Learns))>,
    ) -> Result<(Core, Self)> {
        let (core, state) = (writable(model)?, model.within().plain()?.start());
        learners.insert(0, (Learner::Fixed.name(), Learns::nothing(model)?));
        let refit = learners
            .iter()
            .position(|(_, (_, learns))| matches!(learns, Learns::Refitter(_)));
        if refit.is_some() {
            let (_, nothing) = Learns::nothing(model)?;
            learners.push(("trend", (core.clone(), nothing)));
        }
        let trend = refit.map(|refit| (refit, learners.len() - 1));
        let experts = learners.into_iter();
        let experts = experts.map(|(name, own)| Expert::new(name, own, &core, &state));
        let experts: Vec<Expert> = experts.collect::<Result<_>>()?;
        let (low, high) = core.output_range();
        let shares = || Shares::new(experts.len(), high - low);
        let shares = Both {
            near: shares(),
            far: shares(),
        };
        let level = experts[0].learns.level();
        let levels = model.plane().levels();
        let on = model.within().plain()?.saturated();
        let mixture = Self {
            watch: Watch::new(high - low, levels as f64),
            trusted: shares.clone(),
            pending: shares.clone(),
            good: Good {
                shares: shares.clone(),
                trend: trend.map(|_| (model.weights().to_vec(), level)),
                model: (model.weights().to_vec(), level),
            },
            shares,
            trend,
            weights: model.weights().to_vec(),
            offset: level,
            strokes: Strokes::new(levels),
            there: state,
            unsure: Some(Unsure::new(on, levels)),
            frozen: false,
            experts,
        };
        Ok((core, mixture))
    }

    /// The experts, each with its share of what the model follows.
    pub(super) fn shares(&self) -> Vec<(&'static str, f64)> {
        let names = self.experts.iter().map(|expert| expert.name);
        names.zip(self.shares.of_model()).collect()
    }

    pub(super) fn weights(&self) -> &[f64] {
        &self.weights
    }

    pub(super) fn offset(&self) -> f64 {
        self.offset
    }

    /// The channel that one of the experts finds stuck.
    pub(super) fn stuck(&self) -> Option<Channel> {
        let mut found = self
            .experts
            .iter()
            .filter_map(|expert| expert.learns.stuck());
        let first = found.next()?;
        let output = found.any(|channel| channel == Channel::Output);
        Some(if output { Channel::Output } else { first })
    }

    /// As [`hysteron_core::Estimator::step`].
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
        let from = state.position();
        let step = core.step(state, input)?;
        let distance = (state.position() - from).abs();
        let part = if self.frozen {
            LEAST
        } else {
            self.strokes.go(distance)
        };
        let (mut outputs, mut outcomes, mut fell_silent) = (Vec::new(), Vec::new(), false);
        for expert in &mut self.experts {
            let Expert {
                core,
                state,
                learns,
                ..
            } = expert;
            let before = learns.stuck();
            let learning = learns.step(core, state, input, measured)?;
            fell_silent |= before.is_none() && learns.stuck().is_some();
            outputs.push(learning.output);
            outcomes.push(learning.outcome);
        }
        self.look_at_start()?;
        let output = mean(self.shares.near.all(), outputs.iter().copied());
        let outcome = joint(&outcomes);
        let believed = matches!(
            outcome,
            Outcome::Learned | Outcome::Waiting | Outcome::RolledBack
        );
        if !matches!(outcome, Outcome::AtRest | Outcome::Frozen) {
            let (position, expected) = (state.position(), outputs[0]);
            let reading = Reading {
                position,
                expected,
                measured,
            };
            if let Watched::Piece { alive } = self.watch.look(reading, believed) {
                let before = std::mem::replace(&mut self.pending, self.shares.clone());
                if alive {
                    self.trusted = before;
                }
            }
        }
        if fell_silent {
            self.undo()?;
        } else if believed && self.unsure.is_none() {
            self.judge(state, &outputs, measured, part)?;
        }
        let turned = !self.frozen && self.strokes.turned(state.position());
        if turned {
            self.turn()?;
        }
        let learns = turned || !matches!(outcome, Outcome::AtRest | Outcome::Frozen);
        if learns && self.unsure.is_none() {
            // What was forgotten is gone at once.
            let whole = turned || fell_silent || outcomes.contains(&Outcome::RolledBack);
            self.mix(core, if whole { 1.0 } else { FOLLOWED });
            core.rebase(state)?;
        }
        Ok(Learning {
            output,
            error: measured - output,
            outcome,
            clipped: step.clipped,
        })
    }

    /// Judges the experts by what they expected now, and by what they had expected of now.
    /// The latter count as `part` of a sample.
    fn judge(
        &mut self,
        state: &OperatorState,
        outputs: &[f64],
        measured: f64,
        part: f64,
    ) -> Result<()> {
        let errors: Vec<f64> = outputs.iter().map(|y| measured - y).collect();
        self.shares.near.judge(&errors, 1.0);
        self.there.clone_from(state);
        let there = &mut self.there;
        let late = self.experts.iter();
        let late = late.map(|expert| Ok(measured - expert.kept[0].output(there)?));
        let late: Vec<f64> = late.collect::<Result<_>>()?;
        self.shares.far.judge(&late, part);
        Ok(())
    }

    /// Each expert uses what has come since its last refit. Returns whether one changed.
    fn refit_all(&mut self) -> Result<bool> {
        let mut changed = false;
        for expert in &mut self.experts {
            changed |= expert.refit()?;
        }
        Ok(changed)
    }

    /// The input has turned: what is known now is kept for a judgement in strokes to come.
    fn turn(&mut self) -> Result<()> {
        self.refit_all()?;
        self.extrapolate()?;
        for Expert { learns, kept, .. } in &mut self.experts {
            kept.swap(0, 1);
            kept[0].take(learns);
        }
        Ok(())
    }

    /// Sets the trend: the refit, and so far beyond it as it has moved over the last cycle.
    fn extrapolate(&mut self) -> Result<()> {
        let Some((refit, trend)) = self.trend else {
            return Ok(());
        };
        let Expert {
            learns,
            kept: [_, past],
            ..
        } = &self.experts[refit];
        let beyond = |now: f64, past: f64| now + TREND * (now - past);
        let now = learns.weights();
        let pairs = now.iter().zip(&past.weights);
        let weights: Vec<f64> = pairs
            .map(|(now, past)| beyond(*now, *past).max(0.0))
            .collect();
        let offset = beyond(learns.level(), past.offset);
        self.experts[trend].set(weights, offset)
    }

    /// Takes `part` of the way to the mean of the experts, and writes that to `core`, unless its
    /// weights cannot be summed.
    fn mix(&mut self, core: &mut Core, part: f64) {
        let shares = self.shares.of_model();
        let on = |from: f64, to: f64| from + part * (to - from);
        let levels = self.experts.iter().map(|expert| expert.learns.level());
        let level = mean(&shares, levels);
        let offset = on(self.offset, level);
        let each = self.experts.iter().map(|expert| expert.learns.weights());
        let each: Vec<Vec<f64>> = each.collect();
        let mixed = |n: usize| mean(&shares, each.iter().map(|weights| weights[n]));
        // Rounding may take a mean of zeros and small numbers below zero.
        let weights = self.weights.iter().enumerate();
        let weights: Vec<f64> = weights
            .map(|(n, weight)| on(*weight, mixed(n)).max(0.0))
            .collect();
        if core.set_weights(&weights).is_ok() {
            (self.weights, self.offset) = (weights, offset);
        }
    }

    /// Forgets what a channel that stands still has said. Each expert does so itself, when it finds
    /// that out.
    fn undo(&mut self) -> Result<()> {
        self.shares = self.trusted.clone();
        self.begin_anew()
    }

    /// What the experts know now is all that they are judged by.
    fn begin_anew(&mut self) -> Result<()> {
        self.strokes.restart();
        (self.trusted, self.pending) = (self.shares.clone(), self.shares.clone());
        if let Some((refit, _)) = self.trend {
            let Expert { learns, kept, .. } = &mut self.experts[refit];
            kept[1].take(learns);
            self.extrapolate()?;
        }
        for Expert { learns, kept, .. } in &mut self.experts {
            for kept in kept {
                kept.take(learns);
            }
        }
        Ok(())
    }

    /// Whether it still matters how the operators began. The first expert is the model as it was,
    /// and as long as it matters, as it is.
    fn look_at_start(&mut self) -> Result<()> {
        let Expert { core, state, .. } = &self.experts[0];
        if let Some(unsure) = &mut self.unsure
            && !unsure.step(core, state)?
        {
            self.unsure = None;
        }
        Ok(())
    }

    /// Others moved the state along its branches.
    pub(super) fn follow(&mut self, state: &OperatorState) -> Result<()> {
        for expert in &mut self.experts {
            expert.move_to(state)?;
            expert.learns.follow(&expert.state)?;
        }
        self.look_at_start()
    }

    /// Others set the state, and know it.
    pub(super) fn realign(&mut self, state: &OperatorState) -> Result<()> {
        self.unsure = None;
        for expert in &mut self.experts {
            expert.move_to(state)?;
            expert.learns.realign(&expert.state)?;
        }
        self.strokes.restart();
        self.trust();
        Ok(())
    }

    /// The present shares are trusted.
    fn trust(&mut self) {
        (self.trusted, self.pending) = (self.shares.clone(), self.shares.clone());
        self.watch.restart();
    }

    pub(super) fn freeze(&mut self, frozen: bool) {
        self.frozen = frozen;
        self.watch.restart();
        self.experts
            .iter_mut()
            .for_each(|expert| expert.learns.freeze(frozen));
    }

    pub(super) fn keep(&mut self) {
        let trend = self.trend.map(|(_, trend)| {
            let learns = &self.experts[trend].learns;
            (learns.weights(), learns.level())
        });
        self.good = Good {
            shares: self.shares.clone(),
            trend,
            model: (self.weights.clone(), self.offset),
        };
        self.trust();
        self.experts
            .iter_mut()
            .for_each(|expert| expert.learns.keep());
    }

    pub(super) fn roll_back(&mut self, core: &mut Core) -> Result<()> {
        let Good {
            shares,
            trend: kept,
            model,
        } = self.good.clone();
        self.shares = shares;
        self.experts.iter_mut().try_for_each(Expert::roll_back)?;
        self.begin_anew()?;
        if let (Some((_, trend)), Some((weights, offset))) = (self.trend, kept) {
            self.experts[trend].set(weights, offset)?;
        }
        core.set_weights(&model.0)?;
        (self.weights, self.offset) = model;
        Ok(())
    }

    pub(super) fn refit(&mut self, core: &mut Core) -> Result<bool> {
        self.refit_all()?;
        let mixes = !self.frozen && self.unsure.is_none();
        if mixes {
            self.mix(core, 1.0);
        }
        Ok(mixes)
    }
}

/// What a mixture did with a sample, by what its experts did.
fn joint(outcomes: &[Outcome]) -> Outcome {
    let order = [
        Outcome::OutputStuck,
        Outcome::InputStuck,
        Outcome::Learned,
        Outcome::RolledBack,
        Outcome::Waiting,
        Outcome::Rejected,
        Outcome::AtRest,
    ];
    let found = order.into_iter().find(|outcome| outcomes.contains(outcome));
    found.unwrap_or(Outcome::Frozen)
}

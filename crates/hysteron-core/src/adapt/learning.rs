//! How an estimator learns from a sample.

use super::estimator::Estimator;
use super::gate::Verdict;
use super::increments::Increment;
use super::least_squares::{self, Law};
use super::trial::{Errors, Trial};
use super::vector::dot;
use super::watch::{Channel, Reading, Watched};
use super::{Adaptation, Method, Outcome, parameters};
use crate::branch::Turn;
use crate::memory::Memory;
use crate::plane::operator_count;
use crate::scalar::Real;
use crate::state::State;

impl<T: Real, M: Memory<T>> Estimator<T, M> {
    /// Learns from a reading, if the input moved and the gate accepts the reading. `above` is the
    /// measured output less `H`; `error` is that less the offset.
    pub(super) fn judge<S>(
        &mut self,
        state: &State<T, S>,
        measured: T,
        (above, error): (T, T),
    ) -> Outcome
    where
        S: Memory<Turn<T>>,
    {
        let position = state.position();
        let moved = self.moves(position);
        if self.frozen {
            return Outcome::Frozen;
        }
        let ends = self.increment_ends(position);
        if !(moved || ends) {
            return Outcome::AtRest;
        }
        let Adaptation { gate, burst, .. } = self.options;
        let believed = self.gate.judge(error, gate, burst) != Verdict::Refused;
        if gate > T::ZERO
            && let Some(channel) = self.find_stuck(state, measured, believed)
        {
            return channel.outcome();
        }
        if !believed {
            // An increment from before a jump to after it would take the jump for a slope.
            self.increment = None;
            return Outcome::Rejected;
        }
        let gain = match self.options.method {
            Method::Increments { gain, .. } => gain,
            Method::LeastSquares {
                forgetting, noise, ..
            } => {
                let variance = noise * noise;
                let law = Law {
                    forgetting,
                    variance,
                };
                return self.learn(state, measured, error, law);
            }
        };
        let wrong_level = moved && self.learn_level(measured, above, gain);
        let outcome = match ends {
            true => self.learn_slope(position, measured, gain),
            false => Outcome::Waiting,
        };
        match outcome {
            _ if wrong_level => Outcome::RolledBack,
            Outcome::Waiting if !moved => Outcome::AtRest,
            outcome => outcome,
        }
    }

    /// The channel that stands still. If one begins to, the parameters from before return; the
    /// model's table is not written.
    fn find_stuck<S>(&mut self, state: &State<T, S>, measured: T, believed: bool) -> Option<Channel>
    where
        S: Memory<Turn<T>>,
    {
        let already = self.watch.stuck().is_some();
        let reading = Reading {
            position: state.position(),
            expected: self.expected(state),
            measured,
        };
        let slices = self.layout.cut(self.memory.as_mut());
        match self.watch.look(reading, believed) {
            Watched::Moving => return None,
            Watched::Piece { alive } => {
                if alive {
                    slices.trusted.copy_from_slice(slices.pending);
                }
                slices.pending.copy_from_slice(slices.theta);
                return None;
            }
            Watched::Stuck(channel) if already => return Some(channel),
            Watched::Stuck(_) => {}
        }
        slices.good.copy_from_slice(slices.trusted);
        slices.pending.copy_from_slice(slices.trusted);
        self.take_back();
        self.gate.restart();
        (self.increment, self.undone) = (None, true);
        self.watch.stuck()
    }

    /// The output expected by the parameters that the estimator began with, but for a constant.
    fn expected<S>(&mut self, state: &State<T, S>) -> T
    where
        S: Memory<Turn<T>>,
    {
        let mut slices = self.layout.cut(self.memory.as_mut());
        if slices.tables.is_empty() {
            return self.expected;
        }
        parameters::regressor(&mut slices, self.operator, self.levels, T::ZERO, state);
        dot(slices.offline, slices.phi)
    }

    /// Learns from a sample by least squares.
    fn learn<S>(&mut self, state: &State<T, S>, measured: T, error: T, law: Law<T>) -> Outcome
    where
        S: Memory<Turn<T>>,
    {
        let options = self.options;
        let mut slices = self.layout.cut(self.memory.as_mut());
        let share = options.offset_share;
        parameters::regressor(&mut slices, self.operator, self.levels, share, state);
        let rest = measured - self.offset;
        let errors = Errors {
            now: error,
            candidate: rest - dot(slices.candidate, slices.phi),
            good: rest - dot(slices.good, slices.phi),
        };
        let mut contest = slices.contest(0..self.layout.parameters);
        let length = options.trial;
        if self.trial.judge(&mut contest, errors, measured, length) {
            least_squares::restart(&mut slices);
            return Outcome::RolledBack;
        }
        let counted = options.beyond(rest - dot(slices.estimate, slices.phi));
        if counted == T::ZERO {
            return Outcome::Waiting;
        }
        law.update(&mut slices, counted, options.leakage);
        least_squares::project(&mut slices);
        Outcome::Learned
    }

    /// Whether the input moved since the last sample learned from. If not, the sample would be the
    /// same equation again.
    fn moves(&mut self, position: T) -> bool {
        let way = position - self.learned;
        let moved = way.max(-way) > self.options.movement;
        if moved {
            self.learned = position;
        }
        moved
    }

    /// Whether an increment ends at `position`, or the first one begins there.
    fn increment_ends(&mut self, position: T) -> bool {
        let Method::Increments { span, .. } = self.options.method else {
            return false;
        };
        let least = span.max(self.options.movement);
        match &mut self.increment {
            Some(increment) => increment.extend(position, least),
            None => true,
        }
    }

    /// Learns the weights from a finished increment, and starts the next one.
    fn learn_slope(&mut self, position: T, measured: T, gain: T) -> Outcome {
        let (operator, levels, options) = (self.operator, self.levels, self.options);
        let start = Increment::start(measured, position);
        let mut slices = self.layout.cut(self.memory.as_mut());
        let Some(increment) = self.increment else {
            slices.anchor.copy_from_slice(slices.gamma);
            self.increment = Some(start);
            return Outcome::Waiting;
        };
        self.increment = Some(start);
        let finished = increment.finish(&slices, operator, levels, measured);
        let errors = finished.errors;
        let mut contest = slices.contest(0..self.layout.parameters - 1);
        let length = options.trial;
        let worse = self.trial.judge(&mut contest, errors, measured, length);
        let counted = options.beyond(errors.now);
        let outcome = if worse {
            Outcome::RolledBack
        } else if counted == T::ZERO {
            Outcome::Waiting
        } else {
            let law = (gain, options.leakage);
            finished.update(&mut slices, operator, levels, counted, law);
            Outcome::Learned
        };
        finished.close(&mut slices, levels);
        outcome
    }

    /// Learns the offset from the error of the output, by a normalised gradient.
    /// Increments have no information about it. Returns whether a trial took the offset back.
    fn learn_level(&mut self, measured: T, above: T, gain: T) -> bool {
        let (options, fixed) = (self.options, self.offset);
        let share = options.offset_share;
        let norm = share * share + T::from_index(operator_count(self.levels));
        let mut slices = self.layout.cut(self.memory.as_mut());
        let n = slices.theta.len() - 1;
        let error = |parameter: T| above - fixed - share * parameter;
        let errors = Errors {
            now: error(slices.theta[n]),
            candidate: error(slices.candidate[n]),
            good: error(slices.good[n]),
        };
        let mut contest = slices.contest(n..n + 1);
        let length = options.trial;
        if self.level.judge(&mut contest, errors, measured, length) {
            return true;
        }
        let moved = slices.theta[n] + gain * options.beyond(errors.now) * share / norm;
        if (moved * share).is_finite() {
            slices.theta[n] = moved;
        }
        false
    }

    /// Returns to the last good parameters. The model's table is not written.
    pub(super) fn take_back(&mut self) {
        let mut slices = self.layout.cut(self.memory.as_mut());
        slices.contest(0..self.layout.parameters).roll_back();
        least_squares::restart(&mut slices);
        (self.trial, self.level) = (Trial::default(), Trial::default());
    }
}

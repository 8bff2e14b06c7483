//! What a sample teaches, and what comes of it.

use super::estimator::Estimator;
use super::increments::Increment;
use super::least_squares::{self, Law};
use super::trial::{self, Errors, Trial};
use super::vector::dot;
use super::{Method, gradient, parameters};
use crate::plane::operator_count;
use crate::state::{State, Turn};
use crate::{Clipped, Real};

/// What a sample taught.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Learning<T> {
    /// Output that was expected before anything was learned from the sample.
    pub output: T,
    /// Measured less expected.
    pub error: T,
    /// What was done with it.
    pub outcome: Outcome,
    /// Whether the input lay outside the plane, and at which end.
    pub clipped: Option<Clipped>,
}

/// What an estimator did with a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The weights moved.
    Learned,
    /// The error was within the dead zone, or an increment is not finished.
    Waiting,
    /// The input did not move: no excitation.
    AtRest,
    /// The estimator is frozen.
    Frozen,
    /// The weights did far worse than the last good ones, or were no numbers any more: these are back.
    RolledBack,
}

impl<T: Real, M: AsRef<[T]> + AsMut<[T]>> Estimator<T, M> {
    /// What an error beyond the dead zone counts.
    fn beyond(&self, error: T) -> T {
        let zone = self.options.dead_zone;
        error - error.limited(-zone, zone)
    }

    pub(super) fn learn<S>(&mut self, state: &State<T, S>, measured: T, error: T) -> Outcome
    where
        S: AsRef<[Turn<T>]> + AsMut<[Turn<T>]>,
    {
        let counted = self.beyond(error);
        let (options, floor) = (self.options, self.floor);
        let mut slices = self.layout.cut(self.memory.as_mut());
        let share = options.offset_share;
        parameters::regressor(&mut slices, self.operator, self.levels, share, state);
        let rest = measured - self.offset;
        let errors = Errors {
            now: error,
            candidate: rest - dot(slices.candidate, slices.phi),
            good: rest - dot(slices.good, slices.phi),
        };
        let length = options.trial;
        if self.trial.judge(&mut slices, errors, measured, length) {
            self.take_back();
            return Outcome::RolledBack;
        }
        if counted == T::ZERO {
            return Outcome::Waiting;
        }
        match options.method {
            Method::LeastSquares {
                forgetting, noise, ..
            } => {
                let law = Law {
                    forgetting,
                    variance: noise * noise,
                };
                law.update(&mut slices, counted, options.leakage);
                least_squares::project(&mut slices);
            }
            Method::Gradient { gain } | Method::Increments { gain, .. } => {
                gradient::update(&mut slices, counted, (gain, options.leakage), floor);
                gradient::project(slices.theta);
            }
        }
        Outcome::Learned
    }

    pub(super) fn learn_increment(
        &mut self,
        position: T,
        moved: bool,
        measured: T,
        error: T,
        (gain, span): (T, T),
    ) -> Outcome {
        let (operator, levels, options) = (self.operator, self.levels, self.options);
        if moved {
            self.learn_level(error, gain);
        }
        let start = Some(Increment::start(measured, position));
        let mut slices = self.layout.cut(self.memory.as_mut());
        let Some(increment) = &mut self.increment else {
            slices.anchor.copy_from_slice(slices.gamma);
            self.increment = start;
            return Outcome::Waiting;
        };
        if !increment.extend(position, span.larger(options.movement)) {
            return if moved {
                Outcome::Waiting
            } else {
                Outcome::AtRest
            };
        }
        let finished = increment.finish(&slices, operator, levels, measured);
        self.increment = start;
        let worse = self
            .trial
            .judge(&mut slices, finished.errors, measured, options.trial);
        let zone = options.dead_zone;
        let counted = finished.errors.now - finished.errors.now.limited(-zone, zone);
        if !worse && counted != T::ZERO {
            let law = (gain, options.leakage);
            finished.update(&mut slices, operator, levels, counted, law);
        }
        finished.close(&mut slices, levels);
        if worse {
            self.take_back();
            Outcome::RolledBack
        } else if counted != T::ZERO {
            Outcome::Learned
        } else {
            Outcome::Waiting
        }
    }

    /// The offset follows the error of the level, as in the gradient with every operator on.
    fn learn_level(&mut self, error: T, gain: T) {
        let counted = self.beyond(error);
        let share = self.options.offset_share;
        let norm = share * share + T::from_index(operator_count(self.levels));
        let slices = self.slices();
        let n = slices.theta.len() - 1;
        let moved = slices.theta[n] + gain * counted * share / norm;
        if (moved * share).is_finite() {
            slices.theta[n] = moved;
        }
    }

    pub(super) fn take_back(&mut self) {
        let slices = &mut self.slices();
        trial::roll_back(slices);
        slices.covariance.copy_from_slice(slices.start);
        self.trial = Trial::default();
    }
}

//! What comes next in a reference: how far the temperature may be from the targets ahead, so that
//! the drive starts early enough.

use crate::error::Result;
use crate::model::inverse::{Inverse, Wanted};
use crate::model::policy::Policy;
use crate::model::{Model, Sign, State, Surroundings};
use hysteron_core::{Decay, Solution, Status};
use std::collections::VecDeque;

/// Bounds the temperature by the targets of the next seconds. A body heats and cools no faster than
/// its drive allows. So to be at a temperature in time, it has to be on the way before.
///
/// A plan runs ahead: the inverse without preview, from the same start. Where its drive is at an end
/// of its range and the target is missed, the temperature that the target needs is a bound for the
/// samples before.
#[derive(Clone)]
pub(crate) struct Preview<'m> {
    plan: Inverse<'m>,
    /// The inverse without the body: it tells the temperature that a target needs.
    needed: Inverse<'m>,
    state: State,
    body: hysteron_core::Body<f64>,
    /// Whether the output rises with the temperature.
    rises: bool,
    /// Temperatures at rest with the lowest and with the highest drive.
    rest: (f64, f64),
    seconds: f64,
    ahead: VecDeque<Planned>,
    /// Time from the first sample that waits to the last one.
    span: f64,
}

/// Near the ends of its range the output hardly moves, but the temperature does. On the way back
/// from there the body would be late. So targets keep this share of the output's range from its
/// ends.
const MARGIN: f64 = 0.01;

/// For the sake of later targets the output may be off its present target by this share of its range,
/// no more: a target that no drive reaches must not cost those before it.
const GIVEN_UP: f64 = 0.1;

#[derive(Clone)]
struct Planned {
    /// What the drive is to do.
    wanted: Wanted,
    /// The output that was asked for.
    asked: f64,
    dt: f64,
    /// How far the body has forgotten the sample before.
    decay: Decay<f64>,
    /// The temperature that this sample needs and the plan does not reach.
    missed: Option<f64>,
    /// The heat that is bound at this sample's output, in degrees.
    bound: f64,
}

impl<'m> Preview<'m> {
    /// A preview of `seconds`, for an inverse with this range of drives of a `model` with a body.
    /// `inner` is the same model without the body. The state is the one that the inverse starts
    /// from.
    pub(crate) fn new(
        model: &'m Model,
        inner: &'m Model,
        drive: (f64, f64),
        seconds: f64,
        state: State,
    ) -> Result<Self> {
        let body = model.thermal.unwrap_or_default().core();
        Ok(Self {
            plan: model.inverse()?.drive_range(drive.0, drive.1)?,
            needed: inner.inverse()?,
            state,
            body,
            rises: model.sign() == Sign::Positive,
            rest: (body.rest(drive.0), body.rest(drive.1)),
            seconds,
            ahead: VecDeque::new(),
            span: 0.0,
        })
    }

    /// Takes the next sample and returns those whose preview is complete, each with the output that
    /// was asked for.
    pub(crate) fn push(&mut self, wanted: Wanted) -> Result<Vec<(Wanted, f64)>> {
        let planned = self.planned(wanted)?;
        let mut there = self.state.clone();
        self.needed.step(&mut there, planned)?;
        let found = self.plan.step(&mut self.state, planned)?;
        let (cold, hot) = self.rest;
        let needed = there.temperature().clamp(cold, hot);
        let dt = wanted.dt.unwrap_or_default();
        if !self.ahead.is_empty() {
            self.span += dt;
        }
        let missed = (found.status == Status::Limited).then_some(needed);
        let asked = wanted.target.output;
        let wanted = planned;
        self.ahead.push_back(Planned {
            wanted,
            asked,
            dt,
            decay: self.body.decay(dt),
            missed,
            bound: self.bound(&wanted)?,
        });
        let mut ready = Vec::new();
        while self.span > self.seconds {
            ready.extend(self.next());
        }
        Ok(ready)
    }

    /// The same with bounds that cost little now: no more of the output than `GIVEN_UP`.
    pub(crate) fn allowed(&self, state: &State, wanted: Wanted) -> Result<Wanted> {
        let (low, high) = wanted.temperature;
        let everywhere = (f64::NEG_INFINITY, f64::INFINITY);
        let free = Wanted {
            temperature: everywhere,
            ..wanted
        };
        let mut there = state.clone();
        self.needed.step(&mut there, free)?;
        let needed = there.temperature();
        if (low..=high).contains(&needed) {
            return Ok(wanted);
        }
        let cooler = needed > high;
        let (off, on) = self.plan.output_range(wanted.load)?;
        let given_up = GIVEN_UP * (on - off).abs();
        let mut target = wanted.target;
        target.output += if cooler == self.rises {
            -given_up
        } else {
            given_up
        };
        let mut edge = state.clone();
        self.needed.step(&mut edge, Wanted { target, ..free })?;
        let edge = edge.temperature();
        let temperature = match cooler {
            true => (f64::NEG_INFINITY, high.max(edge.min(needed))),
            false => (low.min(edge.max(needed)), f64::INFINITY),
        };
        Ok(Wanted {
            temperature,
            ..wanted
        })
    }

    /// The heat that is bound at the wanted output, in degrees.
    fn bound(&self, wanted: &Wanted) -> Result<f64> {
        let (off, on) = self.plan.output_range(wanted.load)?;
        match self.plan.model.latent() {
            latent if latent > 0.0 && on != off => {
                Ok(latent * (wanted.target.output - off) / (on - off))
            }
            _ => Ok(0.0),
        }
    }

    fn planned(&self, wanted: Wanted) -> Result<Wanted> {
        let (off, on) = self.plan.output_range(wanted.load)?;
        let (low, high) = (off.min(on), off.max(on));
        let mut target = wanted.target;
        let margin = MARGIN * (high - low);
        target.output = target.output.clamp(low + margin, high - margin);
        // What is given up here counts as an error.
        let given_up = (wanted.target.output - target.output).abs();
        target.tolerance = (target.tolerance - given_up).max(0.0);
        Ok(Wanted { target, ..wanted })
    }

    /// Moves `state` by a sample that is due, and returns its solution: one that misses the output
    /// `asked` for is not `ok`.
    pub(crate) fn step(
        &self,
        inverse: &Inverse<'_>,
        state: &mut State,
        wanted: Wanted,
        asked: f64,
    ) -> Result<Solution<f64>> {
        let wanted = self.allowed(state, wanted)?;
        let mut solution = inverse.step(state, wanted)?;
        let missed = (asked - wanted.target.output).abs() > wanted.target.tolerance;
        if solution.status == Status::Ok && missed {
            solution.status = Status::Limited;
        }
        Ok(solution)
    }

    /// The next sample that waits, with the bounds of its temperature.
    pub(crate) fn next(&mut self) -> Option<(Wanted, f64)> {
        let (cold, hot) = self.rest;
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        let before: Vec<f64> = self.ahead.iter().map(|planned| planned.bound).collect();
        for (planned, before) in self.ahead.iter().skip(1).zip(before).rev() {
            if let Some(needed) = planned.missed {
                low = low.max(needed);
                high = high.min(needed);
            }
            let decay = planned.decay;
            // Where nothing was bound on the way.
            let (lowest, highest) = (low + planned.bound - before, high + planned.bound - before);
            // The highest temperature from which it still cools down to `high`, and so on.
            high = cold + (highest - cold) / decay.cooling;
            low = hot + (lowest - hot) / decay.heating;
        }
        let first = self.ahead.pop_front()?;
        self.span -= self.ahead.front().map_or(self.span, |next| next.dt);
        let bounds = (low.min(high), high);
        let wanted = Wanted {
            temperature: bounds,
            ..first.wanted
        };
        Some((wanted, first.asked))
    }
}

impl Inverse<'_> {
    /// As [`Inverse::series_in`], for a reference that is known ahead: the drive of a model with a
    /// thermal body may start up to `seconds` before a target. Earlier targets are missed by up to a
    /// tenth of the range for that, and targets at the very ends of the range by 1 %.
    ///
    /// # Errors
    /// As [`Inverse::series_in`].
    pub fn previewed(
        &self,
        state: &mut State,
        targets: &[f64],
        policy: Policy,
        tolerance: f64,
        surroundings: Surroundings<'_>,
        seconds: f64,
    ) -> Result<Vec<Solution<f64>>> {
        if self.model.thermal.is_none() || seconds <= 0.0 {
            return self.series_in(state, targets, policy, tolerance, surroundings);
        }
        let inner = self.model.without_body();
        self.model.rest_at(state, surroundings)?;
        let ahead = state.clone();
        let mut preview = Preview::new(self.model, &inner, self.drive, seconds, ahead)?;
        let mut headings = policy.headings(targets, tolerance).into_iter();
        let mut found = Vec::with_capacity(targets.len());
        for (_, sample) in surroundings.samples(self.model, targets)? {
            let heading = headings.next().flatten();
            for (wanted, asked) in preview.push(Wanted::new(sample, heading, tolerance))? {
                found.push(preview.step(self, state, wanted, asked)?);
            }
        }
        while let Some((wanted, asked)) = preview.next() {
            found.push(preview.step(self, state, wanted, asked)?);
        }
        Ok(found)
    }

    /// As [`Inverse::step`], for a reference that is known ahead: `next` has the targets after this
    /// one, each with its time step. The drive of a model with a thermal body may start before they
    /// are due, as with [`Inverse::previewed`]. A model without a body takes no notice of them.
    ///
    /// A step costs as many steps as there are targets ahead, and memory for them.
    ///
    /// ```
    /// use hysteron::{FirstOrder, Model, Operator, Plane, Sign, Status, Target, Wanted};
    /// let plane = Plane::new(40.0, 60.0, 2)?;
    /// let mut model = Model::new(Operator::Mkp, plane, vec![1.0; 3], 0.0, Sign::Positive)?;
    /// model.thermal = Some(FirstOrder { gain: 100.0, ..FirstOrder::default() });
    /// let inverse = model.inverse()?.drive_range(0.0, 1.0)?;
    /// let wanted = |output| Wanted { dt: Some(0.2), ..Target::new(output).into() };
    /// let (mut blind, mut sees) = (model.start(), model.start());
    /// let held = inverse.step(&mut blind, wanted(0.0))?;
    /// let early = inverse.step_ahead(&mut sees, wanted(0.0), &[wanted(0.0), wanted(2.9)])?;
    /// assert!(early.input > held.input);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Inverse::step`], also for a target ahead. The state then stays as it is.
    pub fn step_ahead(
        &self,
        state: &mut State,
        wanted: impl Into<Wanted>,
        next: &[Wanted],
    ) -> Result<Solution<f64>> {
        let wanted = wanted.into();
        if self.model.thermal.is_none() || next.is_empty() {
            return self.step(state, wanted);
        }
        let inner = self.model.without_body();
        let ahead = state.clone();
        let mut preview = Preview::new(self.model, &inner, self.drive, f64::INFINITY, ahead)?;
        for wanted in std::iter::once(&wanted).chain(next) {
            preview.push(*wanted)?;
        }
        match preview.next() {
            Some((wanted, asked)) => preview.step(self, state, wanted, asked),
            None => self.step(state, wanted),
        }
    }
}

//! What comes next in a reference: how far the temperature may be from the targets ahead, so that
//! the drive starts early enough.

use crate::error::Result;
use crate::model::inverse::{Inverse, Wanted};
use crate::model::{Model, State};
use std::collections::VecDeque;

/// Bounds the temperature by the targets of the next seconds. A body heats and cools no faster than
/// its drive allows. So to be at a temperature in time, it has to be on the way before.
///
/// The temperatures ahead are those of a plan: the inverse without the body, from the same start.
pub(crate) struct Preview<'m> {
    plan: Inverse<'m>,
    state: State,
    body: hysteron_core::Body<f64>,
    /// Temperatures at rest with the lowest and with the highest drive.
    rest: (f64, f64),
    seconds: f64,
    ahead: VecDeque<Planned>,
    /// Time from the first sample that waits to the last one.
    span: f64,
}

struct Planned {
    wanted: Wanted,
    dt: f64,
    temperature: f64,
}

impl<'m> Preview<'m> {
    /// A preview of `seconds`, for an inverse of a model whose `inner` model has no body. The state
    /// is the one that the inverse starts from.
    pub(crate) fn new(
        inner: &'m Model,
        body: hysteron_core::Body<f64>,
        drive: (f64, f64),
        seconds: f64,
        state: State,
    ) -> Result<Self> {
        Ok(Self {
            plan: inner.inverse()?,
            state,
            body,
            rest: (body.rest(drive.0), body.rest(drive.1)),
            seconds,
            ahead: VecDeque::new(),
            span: 0.0,
        })
    }

    /// Takes the next sample and returns those whose preview is complete.
    pub(crate) fn push(&mut self, wanted: Wanted) -> Result<Vec<Wanted>> {
        self.plan.step(&mut self.state, wanted)?;
        let dt = wanted.dt.unwrap_or_default();
        if !self.ahead.is_empty() {
            self.span += dt;
        }
        let temperature = self.state.temperature();
        self.ahead.push_back(Planned {
            wanted,
            dt,
            temperature,
        });
        let mut ready = Vec::new();
        while self.span > self.seconds {
            ready.extend(self.next());
        }
        Ok(ready)
    }

    /// The next sample that waits, with the bounds of its temperature.
    pub(crate) fn next(&mut self) -> Option<Wanted> {
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for planned in self.ahead.iter().skip(1).rev() {
            low = low.max(planned.temperature);
            high = high.min(planned.temperature);
            let decay = self.body.decay(planned.dt);
            let (cold, hot) = self.rest;
            // The highest temperature from which it still cools down to `high`, and so on.
            high = cold + (high - cold) / decay.cooling;
            low = hot + (low - hot) / decay.heating;
        }
        let first = self.ahead.pop_front()?;
        self.span -= self.ahead.front().map_or(self.span, |next| next.dt);
        let bounds = (low.min(high), high);
        Some(Wanted {
            temperature: bounds,
            ..first.wanted
        })
    }
}

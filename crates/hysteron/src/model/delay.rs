//! The dead time of an actuator: how long an input takes until the output begins to answer it.

use crate::error::{Error, Result};
use crate::recording::{Recording, gaps};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::collections::VecDeque;

/// A dead time in samples of an interval. The output of a sample then answers the input of so many
/// samples before; before the first sample, the input stood where it is first.
///
/// A row of a recording holds the input that has acted up to its reading. The drive that a
/// controller gives at a sample acts from then on, so the first reading that answers it comes
/// `1 + delay` samples later.
///
/// Only what sees a whole series takes account of it: fits, evaluations, tables, controllers. A
/// [`State`](crate::State) is stepped with the inputs as they act.
///
/// ```
/// use hysteron::Delay;
/// let delay = Delay::new(3, 0.002)?; // 6 ms
/// assert_eq!(delay.at(Some(0.001)), 6);
/// assert_eq!(delay.at(None), 3); // without a time, of the same interval
/// assert_eq!(delay.acting(&[1.0, 2.0, 3.0, 4.0, 5.0], None)[..], [1.0, 1.0, 1.0, 1.0, 2.0]);
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an object in braces")]
pub struct Delay {
    samples: usize,
    interval_s: f64,
}

impl Delay {
    /// The longest delay, in samples.
    pub const MOST: usize = 1000;

    /// No dead time.
    pub const NONE: Self = Self {
        samples: 0,
        interval_s: 0.0,
    };

    /// A delay by `samples` that are `interval_s` seconds apart.
    ///
    /// # Errors
    /// [`Error::Fit`] for more than [`Delay::MOST`] samples, and for an interval that is not finite
    /// or not above zero.
    pub fn new(samples: usize, interval_s: f64) -> Result<Self> {
        let delay = Self {
            samples,
            interval_s,
        };
        match delay.fault() {
            None if samples == 0 => Ok(Self::NONE),
            None => Ok(delay),
            Some(what) => Err(Error::Fit(what)),
        }
    }

    /// What no delay can have.
    pub(crate) fn fault(&self) -> Option<String> {
        if self.samples > Self::MOST {
            let most = Self::MOST;
            return Some(format!(
                "a delay of {} samples: at most {most} can be",
                self.samples
            ));
        }
        let positive = self.interval_s > 0.0 && self.interval_s.is_finite();
        (self.samples > 0 && !positive).then(|| {
            let interval = self.interval_s;
            format!("samples of a delay that are {interval} s apart: a time above zero is needed")
        })
    }

    /// Samples.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// Seconds.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.samples as f64 * self.interval_s
    }

    /// Whether there is no delay.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.samples == 0
    }

    /// The delay in samples of another interval (s); `None` where it is the same or not known. At
    /// most [`Delay::MOST`].
    #[must_use]
    pub fn at(&self, interval_s: Option<f64>) -> usize {
        match interval_s.filter(|interval| *interval > 0.0) {
            Some(interval) => (self.seconds() / interval).round().min(Self::MOST as f64) as usize,
            None => self.samples,
        }
    }

    /// The delay in samples of a clock, by the median of its steps.
    #[must_use]
    pub fn on(&self, time: Option<&[f64]>) -> usize {
        match self.is_none() {
            true => 0,
            false => self.at(time.and_then(gaps).map(|(interval, _)| interval)),
        }
    }

    /// The inputs that act at each sample of a series, from those given there.
    #[must_use]
    pub fn acting<'i>(&self, input: &'i [f64], time: Option<&[f64]>) -> Cow<'i, [f64]> {
        self.acting_after(None, input, time)
    }

    /// As [`Delay::acting`], where another input than the first one was held before.
    pub(crate) fn acting_after<'i>(
        &self,
        rest: Option<f64>,
        input: &'i [f64],
        time: Option<&[f64]>,
    ) -> Cow<'i, [f64]> {
        let (late, Some(&first)) = (self.on(time), input.first()) else {
            return Cow::Borrowed(input);
        };
        if late == 0 {
            return Cow::Borrowed(input);
        }
        let before = std::iter::repeat_n(rest.unwrap_or(first), late);
        Cow::Owned(
            before
                .chain(input.iter().copied())
                .take(input.len())
                .collect(),
        )
    }

    /// The inputs to give at each sample so that `input` acts there: earlier by the delay. At the
    /// end of the series the last one is held, because nothing is wanted after it.
    ///
    /// ```
    /// use hysteron::Delay;
    /// let delay = Delay::new(2, 0.1)?;
    /// let given = delay.giving(vec![1.0, 2.0, 3.0, 4.0], None);
    /// assert_eq!(given, [3.0, 4.0, 4.0, 4.0]);
    /// assert_eq!(delay.acting(&given, None)[2..], [3.0, 4.0]);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    #[must_use]
    pub fn giving<T: Clone>(&self, mut input: Vec<T>, time: Option<&[f64]>) -> Vec<T> {
        let (early, Some(last)) = (self.on(time), input.last().cloned()) else {
            return input;
        };
        let count = input.len();
        input.drain(..early.min(count));
        input.resize(count, last);
        input
    }

    /// The recording with the inputs that act.
    pub(crate) fn of_recording<'r>(&self, recording: &'r Recording) -> Cow<'r, Recording> {
        match self.acting(&recording.input, recording.time.as_deref()) {
            Cow::Borrowed(_) => Cow::Borrowed(recording),
            Cow::Owned(input) => Cow::Owned(Recording {
                input,
                ..recording.clone()
            }),
        }
    }

    /// The recordings with the inputs that act.
    pub(crate) fn of_recordings<'r>(&self, recordings: &'r [Recording]) -> Cow<'r, [Recording]> {
        match self.is_none() {
            true => Cow::Borrowed(recordings),
            false => {
                let each = recordings.iter();
                Cow::Owned(each.map(|r| self.of_recording(r).into_owned()).collect())
            }
        }
    }
}

/// Values under way, which arrive so many samples after they were given. Before all of them, the
/// first one arrives.
#[derive(Debug, Clone, Default)]
pub(crate) struct UnderWay<T> {
    late: usize,
    values: VecDeque<T>,
}

impl<T: Clone> UnderWay<T> {
    pub(crate) fn new(late: usize) -> Self {
        Self {
            late,
            values: VecDeque::new(),
        }
    }

    /// Whether nothing is under way: no value has been given, or each arrives at once.
    pub(crate) fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// The value that arrives when this one is given.
    pub(crate) fn push(&mut self, value: T) -> T {
        while self.values.len() < self.late {
            self.values.push_back(value.clone());
        }
        match self.values.pop_front() {
            Some(first) => {
                self.values.push_back(value);
                first
            }
            None => value,
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn what_is_given_early_acts_in_time() {
        for (count, samples) in (1..40).flat_map(|count| (0..60).map(move |late| (count, late))) {
            let input: Vec<f64> = (0..count).map(|n| f64::from(n * n % 7) - 0.1).collect();
            let delay = Delay::new(samples, 0.1).unwrap();
            let given = delay.giving(input.clone(), None);
            let acting = delay.acting(&given, None);
            assert_eq!(acting.len(), input.len());
            let from = samples.min(input.len());
            assert_eq!(acting[from..], input[from..]);
        }
    }

    #[test]
    fn a_delay_is_the_same_time_on_any_clock() {
        for (samples, times) in (1..50).flat_map(|n| (1..8).map(move |times| (n, times))) {
            let delay = Delay::new(samples, 0.01).unwrap();
            assert_eq!(delay.at(Some(0.01 / times as f64)), samples * times);
            let clock: Vec<f64> = (0..9).map(|n| 0.01 * f64::from(n)).collect();
            assert_eq!(delay.on(Some(&clock)), samples);
        }
    }

    #[test]
    fn no_delay_can_be_of_no_time_or_without_end() {
        for (samples, interval) in [(1, 0.0), (1, -1.0), (1, f64::NAN), (1001, 1.0)] {
            assert!(Delay::new(samples, interval).is_err());
        }
        assert_eq!(Delay::new(1, 1e-300).unwrap().at(Some(1e300)), 0);
        assert_eq!(Delay::new(1, 1e300).unwrap().at(Some(1e-300)), Delay::MOST);
    }
}

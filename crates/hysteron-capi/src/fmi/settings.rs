//! The parameters of the controller block.

use super::lines::{Lines, Parsed};
use hysteron_core::control::{Safety, Terms, clamp};

/// Parameters of the loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Settings {
    pub(crate) terms: Terms,
    pub(crate) drives: (f64, f64),
    /// Of the drive per second; 0 for no limit.
    pub(crate) slew: f64,
    /// Until the drive is the safe one, s; 0 for never.
    pub(crate) lost_s: f64,
    pub(crate) stuck_s: f64,
    /// What deviates by less is never held back; 0 for no gate.
    pub(crate) gate: f64,
    /// Time constant of the filter, s; 0 for none.
    pub(crate) filter_s: f64,
}

/// How many numbers they are.
pub(crate) const SETTINGS: usize = 10;

impl Settings {
    /// In the order of the variables, and of the line in the model's text.
    pub(crate) fn numbers(&mut self) -> [&mut f64; SETTINGS] {
        let Terms {
            gain,
            integral_s,
            derivative_s,
        } = &mut self.terms;
        let (low, high) = (&mut self.drives.0, &mut self.drives.1);
        let times = (&mut self.lost_s, &mut self.stuck_s);
        [
            gain,
            integral_s,
            derivative_s,
            low,
            high,
            &mut self.slew,
            times.0,
            times.1,
            &mut self.gate,
            &mut self.filter_s,
        ]
    }

    pub(crate) fn of(numbers: [f64; SETTINGS]) -> Self {
        let [
            gain,
            integral_s,
            derivative_s,
            low,
            high,
            slew,
            lost_s,
            stuck_s,
            gate,
            filter_s,
        ] = numbers;
        Self {
            terms: Terms {
                gain,
                integral_s,
                derivative_s,
            },
            drives: (low, high),
            slew,
            lost_s,
            stuck_s,
            gate,
            filter_s,
        }
    }

    /// What no loop can run with.
    pub(crate) fn fault(&self) -> Option<&'static str> {
        let from_zero = |value: f64| value >= 0.0 && value.is_finite();
        let (low, high) = self.drives;
        let times = [self.terms.integral_s, self.terms.derivative_s];
        let others = [
            self.slew,
            self.lost_s,
            self.stuck_s,
            self.gate,
            self.filter_s,
        ];
        match () {
            () if !self.terms.gain.is_finite() => Some("the gain must be a finite number"),
            () if !times.into_iter().chain(others).all(from_zero) => {
                Some("times, slew and gate must be finite and from zero on")
            }
            // Written so that NaN fails the comparison.
            () if !(low < high && (high - low).is_finite()) => {
                Some("the limits of the drive must be finite, the lower one first")
            }
            () => None,
        }
    }

    pub(crate) fn safety(&self) -> Safety {
        let some = |time: f64| (time > 0.0).then_some(time);
        Safety {
            lost_s: some(self.lost_s),
            stuck_s: some(self.stuck_s),
        }
    }

    pub(crate) fn rest(&self) -> f64 {
        clamp(0.0, self.drives.0, self.drives.1)
    }
}

/// What the text of a model has of its loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Control {
    pub(crate) settings: Settings,
    /// The usual tolerance.
    pub(crate) tolerance: f64,
    /// Of the model's output.
    pub(crate) range: f64,
}

impl Control {
    /// Of the other blocks.
    pub(crate) const NONE: Self = Self {
        settings: Settings {
            terms: Terms {
                gain: 0.0,
                integral_s: 0.0,
                derivative_s: 0.0,
            },
            drives: (0.0, 1.0),
            slew: 0.0,
            lost_s: 0.0,
            stuck_s: 0.0,
            gate: 0.0,
            filter_s: 0.0,
        },
        tolerance: 0.0,
        range: 0.0,
    };

    /// Reads its line.
    pub(crate) fn read(lines: &mut Lines<'_>) -> Parsed<Self> {
        let numbers = lines.numbers("control")?;
        let Some(([tolerance, range], settings)) = numbers.split_first_chunk() else {
            return lines.fault("`control` and 12 numbers are expected");
        };
        let Ok(settings) = <[f64; SETTINGS]>::try_from(settings) else {
            return lines.fault("`control` and 12 numbers are expected");
        };
        let settings = Settings::of(settings);
        match settings.fault() {
            None if *tolerance >= 0.0 && *range >= 0.0 => Ok(Self {
                settings,
                tolerance: *tolerance,
                range: *range,
            }),
            None => lines.fault("tolerance and range from zero on are expected"),
            Some(fault) => lines.fault(fault),
        }
    }
}

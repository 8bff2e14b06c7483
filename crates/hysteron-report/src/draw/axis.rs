//! Ranges, ticks and tick labels.

use super::text;
use crate::number::{fixed, magnitude, power_of_ten};
use crate::quantity::Labelled;

/// Values beyond this are not drawn: their differences would overflow.
const LARGEST: f64 = 1e300;
/// Values below this are drawn as zero: steps between them would lose their digits.
const SMALLEST: f64 = 1e-300;

/// Pixels between ticks, at least.
const CLOSEST: f64 = 16.0;

/// The range that an axis covers. Never empty, always finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Span {
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl Span {
    /// The range of the finite values; a constant series gets room on both sides, an empty one
    /// `0…1`.
    pub(crate) fn covering<'a>(values: impl IntoIterator<Item = &'a f64>) -> Self {
        let drawable = values.into_iter().filter(|value| value.abs() <= LARGEST);
        let (low, high) = drawable.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| {
            (low.min(v), high.max(v))
        });
        if low > high {
            return Self {
                low: 0.0,
                high: 1.0,
            };
        }
        let largest = low.abs().max(high.abs());
        // Below this the values differ by rounding only, and no tick label could tell them apart.
        if high - low > (1e-9 * largest).max(SMALLEST) {
            return Self { low, high };
        }
        let room = if largest > SMALLEST {
            0.1 * largest
        } else {
            1.0
        };
        Self {
            low: low - room,
            high: high + room,
        }
    }

    /// The range of the finite values with zero in it, as a scale of colours needs; `0…1` where all
    /// are zero.
    pub(crate) fn from_zero(values: impl IntoIterator<Item = f64>) -> Self {
        let drawable = values.into_iter().filter(|value| value.abs() <= LARGEST);
        let (low, high) = drawable.fold((0.0_f64, 0.0_f64), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        let high = if low < high { high } else { 1.0 };
        Self { low, high }
    }

    /// The largest magnitude.
    pub(crate) fn largest(self) -> f64 {
        self.high.max(-self.low)
    }

    /// Room for the line's width and some air, `share` of the range on each side.
    pub(crate) fn padded(self, share: f64) -> Self {
        let room = share * (self.high - self.low);
        Self {
            low: self.low - room,
            high: self.high + room,
        }
    }

    /// The same from `low` on.
    pub(crate) fn from(self, low: f64) -> Self {
        Self { low, ..self }
    }

    /// The smallest range that holds both.
    pub(crate) fn with(self, value: f64) -> Self {
        Self {
            low: self.low.min(value),
            high: self.high.max(value),
        }
    }
}

/// An axis: what it shows, from where to where.
#[derive(Debug, Clone)]
pub(crate) struct Axis {
    quantity: Labelled,
    /// Tells quantities apart that have the same label.
    told_apart: &'static str,
    pub(crate) span: Span,
    /// Tick labels are in units of `10^exponent`.
    exponent: i32,
    /// In place of numbers, a name at each of 0, 1, 2 and so on.
    names: Vec<String>,
    /// Whether the label stands elsewhere, for several panels together.
    unlabelled: bool,
}

/// Where a tick stands and what it says.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tick {
    pub(crate) value: f64,
    pub(crate) label: String,
}

impl Axis {
    pub(crate) fn new(quantity: &Labelled, span: Span) -> Self {
        let largest = span.low.abs().max(span.high.abs());
        let exponent = match magnitude(largest) {
            plain @ -2..=6 if plain < 6 || largest <= 1.2e6 => 0,
            other => other.div_euclid(3) * 3,
        };
        Self {
            quantity: quantity.clone(),
            told_apart: "",
            span,
            exponent,
            names: Vec::new(),
            unlabelled: false,
        }
    }

    /// An axis with `names` at 0, 1, 2 and so on.
    pub(crate) fn named(quantity: &Labelled, names: Vec<String>) -> Self {
        let high = names.len() as f64 - 0.5;
        Self {
            names,
            ..Self::new(quantity, Span { low: -0.5, high })
        }
    }

    /// The same axis without its label, which stands elsewhere.
    pub(crate) fn unlabelled(self) -> Self {
        Self {
            unlabelled: true,
            ..self
        }
    }

    /// Name and unit.
    pub(crate) fn label(&self) -> String {
        if self.unlabelled {
            return String::new();
        }
        let factor = (self.exponent != 0).then(|| power_of_ten(self.exponent));
        self.quantity.axis(factor.as_deref())
    }

    /// The same axis of a quantity that is another one than its label says.
    pub(crate) fn told_apart(self, told_apart: &'static str) -> Self {
        Self { told_apart, ..self }
    }

    /// What the quantity is; axes with the same key show the same.
    pub(crate) fn key(&self) -> String {
        format!("{}{}", self.told_apart, self.whole_label())
    }

    /// Name and unit, without a factor and also where the label stands elsewhere.
    pub(crate) fn whole_label(&self) -> String {
        self.quantity.axis(None)
    }

    /// Ticks for a horizontal axis of `length` pixels: as many as their labels leave room for.
    pub(crate) fn ticks_across(&self, length: f64) -> Vec<Tick> {
        self.ticks(length, |ticks| {
            ticks
                .iter()
                .map(|tick| text::width(&tick.label, super::style::TICK))
                .fold(0.0, f64::max)
                + 24.0
        })
    }

    /// Ticks for a vertical axis of `length` pixels.
    pub(crate) fn ticks_up(&self, length: f64) -> Vec<Tick> {
        let ticks = self.ticks(length, |_| (0.25 * length).clamp(22.0, 44.0));
        if ticks.len() > 1 {
            return ticks;
        }
        // A single tick tells no scale: as close as the labels allow.
        self.ticks(length, |_| CLOSEST)
    }

    /// The finest ticks at steps of 1, 2 or 5 · 10ⁿ that are at least `room` pixels apart.
    fn ticks(&self, length: f64, room: impl Fn(&[Tick]) -> f64) -> Vec<Tick> {
        let range = self.span.high - self.span.low;
        if !self.names.is_empty() {
            let tick = |(n, name): (usize, &String)| Tick {
                value: n as f64,
                label: name.clone(),
            };
            return self.names.iter().enumerate().map(tick).collect();
        }
        let finest = magnitude(range) - 2;
        for exponent in finest..finest + 5 {
            for leading in [1.0, 2.0, 5.0] {
                let step = leading * 10f64.powi(exponent);
                let spacing = step / range * length;
                if spacing < CLOSEST {
                    continue;
                }
                let ticks = self.at_steps_of(step, exponent);
                if spacing >= room(&ticks) {
                    return ticks;
                }
            }
        }
        Vec::new()
    }

    fn at_steps_of(&self, step: f64, exponent: i32) -> Vec<Tick> {
        let decimals = (self.exponent - exponent).max(0) as usize;
        let first = (self.span.low / step - 1e-9).ceil();
        let count = ((self.span.high / step + 1e-9).floor() - first).max(-1.0) as usize + 1;
        (0..count.min(200))
            .map(|k| (first + k as f64) * step)
            .map(|value| Tick {
                value,
                label: fixed(value / 10f64.powi(self.exponent), decimals),
            })
            .collect()
    }
}

/// Time runs from edge to edge.
pub(crate) fn time_axis(label: &Labelled, span: Span) -> Axis {
    Axis::new(label, span.padded(0.005))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(low: f64, high: f64) -> Axis {
        Axis::new(
            &Labelled {
                name: "x".into(),
                unit: Some("m".into()),
            },
            Span { low, high },
        )
    }

    fn labels(ticks: &[Tick]) -> Vec<&str> {
        ticks.iter().map(|tick| tick.label.as_str()).collect()
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(
            labels(&axis(18.0, 83.0).ticks_up(300.0)),
            ["20", "30", "40", "50", "60", "70", "80"]
        );
        assert_eq!(
            labels(&axis(-0.5, 0.5).ticks_up(200.0)),
            ["−0.5", "0.0", "0.5"]
        );
    }

    #[test]
    fn small_and_large_values_share_a_power_of_ten() {
        let small = axis(0.0, 5e-6);
        assert_eq!(small.label(), "x [10⁻⁶ m]");
        assert_eq!(
            labels(&small.ticks_up(300.0)),
            ["0", "1", "2", "3", "4", "5"]
        );
        assert_eq!(axis(0.0, 3.2e7).label(), "x [10⁶ m]");
    }

    #[test]
    fn a_constant_or_absent_series_still_has_an_axis() {
        for values in [
            &[][..],
            &[0.0],
            &[5.0, 5.0],
            &[f64::NAN],
            &[1e16, 1e16 + 2.0],
            &[f64::MAX, f64::MIN],
            &[1e-310],
        ] {
            let span = Span::covering(values);
            assert!(
                span.low < span.high && (span.high - span.low).is_finite(),
                "{values:?}: {span:?}"
            );
            let ticks = axis(span.low, span.high).ticks_across(500.0);
            assert!((2..30).contains(&ticks.len()), "{values:?}: {ticks:?}");
        }
    }
}

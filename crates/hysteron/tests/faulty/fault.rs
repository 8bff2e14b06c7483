//! Faults of measured recordings, put into clean ones.

use hysteron::{Recording, range};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::ops::{Range, RangeInclusive};

/// A class of faults.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// Single readings far off, of either sign, in both series.
    Spikes,
    /// The same, several in a row.
    Bursts,
    /// A channel reads zero for a while.
    Zeros,
    /// A channel holds its last value for a while.
    Held,
    /// Rows are missing.
    Missing,
    /// The output stands still for long.
    FrozenOutput,
    /// The input stands still for long.
    FrozenInput,
    /// The clock steps forward.
    ClockForward,
    /// The clock steps back.
    ClockBack,
    /// A coarse converter.
    Quantised,
    /// Columns are exchanged in many rows.
    Swapped,
    /// Blocks of rows come twice.
    Repeated,
    /// The output moves to another zero, from one row on.
    Slipped,
    /// Many inputs are in °F instead of °C.
    InputUnit,
    /// Many outputs are in inches instead of mm.
    OutputUnit,
    /// White noise on both series.
    Noise,
    /// Spikes, bursts, zeros, missing rows and noise together.
    Everything,
}

/// All classes.
pub const FAULTS: [Fault; 17] = [
    Fault::Spikes,
    Fault::Bursts,
    Fault::Zeros,
    Fault::Held,
    Fault::Missing,
    Fault::FrozenOutput,
    Fault::FrozenInput,
    Fault::ClockForward,
    Fault::ClockBack,
    Fault::Quantised,
    Fault::Swapped,
    Fault::Repeated,
    Fault::Slipped,
    Fault::InputUnit,
    Fault::OutputUnit,
    Fault::Noise,
    Fault::Everything,
];

impl Fault {
    /// Its name in a table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Spikes => "3 to 30 spikes of either sign",
            Self::Bursts => "2 to 8 bursts of 4 to 8 readings",
            Self::Zeros => "2 to 4 dropouts to zero, 5 to 20 readings",
            Self::Held => "2 to 4 dropouts that hold the value, 5 to 20 readings",
            Self::Missing => "rows missing, 2 to 6 times 1 to 20",
            Self::FrozenOutput => "output frozen for a sixteenth to a third, noise up to 0.3 %",
            Self::FrozenInput => "input frozen for a sixteenth to a third, noise up to 0.3 %",
            Self::ClockForward => "clock steps forward by a tenth",
            Self::ClockBack => "clock steps back by a tenth",
            Self::Quantised => "readings in steps of 0.5 to 1 % of the range",
            Self::Swapped => "columns exchanged in a sixteenth to a third of the rows",
            Self::Repeated => "1 to 3 blocks of 20 to 60 rows twice",
            Self::Slipped => "output moved by 5 to 50 % of its range, from a row on",
            Self::InputUnit => "a twelfth to a half of the inputs in °F",
            Self::OutputUnit => "a twelfth to a half of the outputs in inches",
            Self::Noise => "noise of 0.5 to 1 % of the range on both",
            Self::Everything => "spikes, bursts, zeros, missing rows and noise",
        }
    }

    /// Whether readings carry noise after it, which no preparation takes away altogether.
    pub fn is_noisy(self) -> bool {
        matches!(self, Self::Quantised | Self::Noise | Self::Everything)
    }

    /// The recording with this fault.
    pub fn put_into(self, clean: &Recording, rng: &mut ChaCha8Rng) -> Recording {
        let mut dirty = clean.clone();
        let len = clean.len();
        let mut spans = |counts: RangeInclusive<usize>, lengths: RangeInclusive<usize>| {
            let count = rng.random_range(counts);
            let span = |_| {
                let length = rng.random_range(lengths.clone());
                let start = rng.random_range(20..len - 20 - length);
                start..start + length
            };
            (0..count).map(span).collect::<Vec<Range<usize>>>()
        };
        let large = len / 16..=len / 3;
        let of_units = len / 12..=len / 2;
        match self {
            Self::Spikes | Self::Bursts => {
                let spans = match self {
                    Self::Spikes => spans(3..=30, 1..=1),
                    _ => spans(2..=8, 4..=8),
                };
                for (n, span) in spans.into_iter().enumerate() {
                    let series = series(&mut dirty, n % 2 == 0);
                    let (low, high) = range(match n % 2 == 0 {
                        true => &clean.input,
                        false => &clean.output,
                    });
                    let side = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
                    let height = side * rng.random_range(0.3..1.5) * (high - low);
                    series[span].iter_mut().for_each(|value| *value += height);
                }
            }
            Self::Zeros => {
                for (n, span) in spans(2..=4, 5..=20).into_iter().enumerate() {
                    series(&mut dirty, n % 2 == 0)[span].fill(0.0);
                }
            }
            Self::Held => {
                for (n, span) in spans(2..=4, 5..=20).into_iter().enumerate() {
                    let series = series(&mut dirty, n % 2 == 0);
                    let value = series[span.start];
                    series[span].fill(value);
                }
            }
            Self::Missing => {
                let gone = spans(2..=6, 1..=20);
                let kept = |n: usize| !gone.iter().any(|span| span.contains(&n));
                dirty = clean.only(kept).unwrap_or(dirty);
            }
            Self::FrozenOutput | Self::FrozenInput => {
                let span = spans(1..=1, large).remove(0);
                let series = series(&mut dirty, self == Self::FrozenInput);
                let (low, high) = range(series);
                let noise = rng.random_range(0.0..0.003) * (high - low);
                let value = series[span.start];
                let read = |_| value + noise * gaussian(rng);
                let read: Vec<f64> = span.clone().map(read).collect();
                series[span].copy_from_slice(&read);
            }
            Self::ClockForward | Self::ClockBack => {
                let at = spans(1..=1, 1..=1).remove(0).start;
                let sign = if self == Self::ClockBack { -1.0 } else { 1.0 };
                if let Some(time) = &mut dirty.time {
                    let step = sign * 0.1 * (time[len - 1] - time[0]);
                    time[at..].iter_mut().for_each(|t| *t += step);
                }
            }
            Self::Quantised => {
                let share = rng.random_range(0.005..0.01);
                for values in [&mut dirty.input, &mut dirty.output] {
                    let (low, high) = range(values);
                    let step = share * (high - low);
                    values
                        .iter_mut()
                        .for_each(|v| *v = (*v / step).round() * step);
                }
            }
            Self::Swapped => {
                let span = spans(1..=1, large).remove(0);
                dirty.input[span.clone()].copy_from_slice(&clean.output[span.clone()]);
                dirty.output[span.clone()].copy_from_slice(&clean.input[span]);
            }
            Self::Repeated => {
                let mut rows: Vec<usize> = (0..len).collect();
                let mut blocks = spans(1..=3, 20..=60);
                blocks.sort_by_key(|block| std::cmp::Reverse(block.start));
                for block in blocks {
                    rows.splice(block.end..block.end, block);
                }
                let pick = |values: &[f64]| rows.iter().map(|n| values[*n]).collect();
                dirty.input = pick(&clean.input);
                dirty.output = pick(&clean.output);
                // The logger goes on counting.
                dirty.time = clean.time.as_ref().map(|time| {
                    let step = (time[len - 1] - time[0]) / (len - 1) as f64;
                    (0..rows.len()).map(|n| time[0] + step * n as f64).collect()
                });
            }
            Self::Slipped => {
                let at = spans(1..=1, large).remove(0).start;
                let (low, high) = range(&clean.output);
                let side = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
                let step = side * rng.random_range(0.05..0.5) * (high - low);
                dirty.output[at..].iter_mut().for_each(|y| *y += step);
            }
            Self::InputUnit | Self::OutputUnit => {
                let span = spans(1..=1, of_units).remove(0);
                let convert: fn(&mut f64) = match self {
                    Self::InputUnit => |t| *t = 1.8 * *t + 32.0,
                    _ => |y| *y /= 25.4,
                };
                let series = series(&mut dirty, self == Self::InputUnit);
                series[span].iter_mut().for_each(convert);
            }
            Self::Noise => {
                let share = rng.random_range(0.005..0.01);
                for values in [&mut dirty.input, &mut dirty.output] {
                    let (low, high) = range(values);
                    let sigma = share * (high - low);
                    values.iter_mut().for_each(|v| *v += sigma * gaussian(rng));
                }
            }
            Self::Everything => {
                for fault in [
                    Self::Noise,
                    Self::Spikes,
                    Self::Bursts,
                    Self::Zeros,
                    Self::Missing,
                ] {
                    dirty = fault.put_into(&dirty, rng);
                }
            }
        }
        dirty
    }
}

/// Twelve uniform numbers make a Gaussian one.
fn gaussian(rng: &mut ChaCha8Rng) -> f64 {
    (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0
}

fn series(recording: &mut Recording, input: bool) -> &mut Vec<f64> {
    match input {
        true => &mut recording.input,
        false => &mut recording.output,
    }
}

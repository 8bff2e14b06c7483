//! What the output is to follow.

use hysteron::{Columns, Recording, Repair, Result};
use serde::Deserialize;
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

/// A reference over time, in the output's unit. Parts are added, so that several sines make a
/// multi-sine.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Reference {
    /// A constant.
    Constant {
        /// Its value.
        value: f64,
    },
    /// `amplitude · sin(2π t/period_s + phase)`.
    Sine {
        /// Half the way from the lowest to the highest value.
        amplitude: f64,
        /// Period, s.
        period_s: f64,
        /// Phase at time 0, in degrees. −90 sets out from the lowest value.
        #[serde(default)]
        phase_deg: f64,
    },
    /// From `low` to `high` in `ramp_s`, rest there, and back, rest there, again and again.
    Trapezoid {
        /// Value at time 0.
        low: f64,
        /// Value after the first ramp.
        high: f64,
        /// Duration of a ramp, s.
        ramp_s: f64,
        /// Duration of a rest, s.
        rest_s: f64,
    },
    /// Values held from their times on.
    Steps {
        /// `[time_s, value]`, times in order.
        points: Vec<(f64, f64)>,
    },
    /// Straight lines between the points, level before the first and after the last.
    Ramps {
        /// `[time_s, value]`, times in order.
        points: Vec<(f64, f64)>,
    },
    /// Columns of a table, straight lines between its rows.
    Csv {
        /// The file; from the folder of the scenario where it is not absolute.
        file: PathBuf,
        /// Column of time, s.
        time: String,
        /// Column of the values.
        column: String,
    },
}

impl Reference {
    /// A column of a table becomes [`Reference::Ramps`]; `folder` is that of the scenario.
    ///
    /// # Errors
    /// As [`Recording::read`].
    pub(super) fn read(self, folder: &Path) -> Result<Self> {
        let Self::Csv { file, time, column } = &self else {
            return Ok(self);
        };
        let columns = Columns::new(time, column);
        let (table, _) = Recording::read(&folder.join(file), columns, Repair::Refuse)?;
        let points = table.input.into_iter().zip(table.output).collect();
        Ok(Self::Ramps { points })
    }

    /// The value at `time`, s. 0 for a table that was not read.
    #[must_use]
    pub fn at(&self, time: f64) -> f64 {
        match self {
            Self::Constant { value } => *value,
            Self::Sine {
                amplitude,
                period_s,
                phase_deg,
            } => amplitude * (TAU * (time / period_s + phase_deg / 360.0)).sin(),
            Self::Trapezoid {
                low,
                high,
                ramp_s,
                rest_s,
            } => {
                let half = ramp_s + rest_s;
                let gone = time % (2.0 * half);
                let share = |since: f64| (since / ramp_s).min(1.0);
                let up = match gone < half {
                    true => share(gone),
                    false => 1.0 - share(gone - half),
                };
                low + up * (high - low)
            }
            Self::Steps { points } => {
                let passed = points.partition_point(|(t, _)| *t <= time);
                points[passed.saturating_sub(1)].1
            }
            Self::Ramps { points } => {
                let passed = points.partition_point(|(t, _)| *t <= time);
                match (passed.checked_sub(1).map(|n| points[n]), points.get(passed)) {
                    (Some((t, y)), Some((u, z))) => y + (z - y) * ((time - t) / (u - t)),
                    (Some((_, y)), None) | (None, Some(&(_, y))) => y,
                    (None, None) => 0.0,
                }
            }
            Self::Csv { .. } => 0.0,
        }
    }
}

//! The stages around the operators of a block.

use super::resource::{Lines, Parsed};
use hysteron_core::{Axis, Body, Creep, Load, Stages};

/// Their constants; what is empty is not there.
#[derive(Debug)]
pub(crate) struct Constants {
    pub(crate) body: Option<Body<f64>>,
    /// The range of the drive in the inverse.
    pub(crate) drive: (f64, f64),
    pub(crate) loads: Vec<f64>,
    pub(crate) shifts: Vec<f64>,
    pub(crate) scales: Vec<f64>,
    pub(crate) gains: Vec<f64>,
    pub(crate) offsets: Vec<f64>,
    pub(crate) spacing: Vec<f64>,
    pub(crate) creep: Vec<f64>,
    pub(crate) taus: Vec<f64>,
    pub(crate) lag: f64,
}

impl Constants {
    /// As the core takes them, with offset and sign of the output.
    pub(crate) fn core(&self, offset: f64, sign: f64) -> Stages<'_, f64> {
        Stages {
            body: self.body,
            axis: Axis {
                load: Load {
                    loads: &self.loads,
                    shifts: &self.shifts,
                    scales: &self.scales,
                    gains: &self.gains,
                    offsets: &self.offsets,
                },
                spacing: &self.spacing,
            },
            creep: Creep {
                coefficients: &self.creep,
                taus: &self.taus,
            },
            lag: self.lag,
            offset,
            falling: sign < 0.0,
        }
    }

    /// Whether there is a stage at all.
    pub(crate) fn is_none(&self) -> bool {
        let stages = self.core(0.0, 1.0);
        !stages.is_timed() && self.loads.is_empty() && self.spacing.is_empty()
    }
}

/// What a model's text of version 2 has more.
pub(crate) struct More {
    pub(crate) first: (f64, f64),
    pub(crate) start: Option<(Vec<f64>, f64)>,
    pub(crate) stages: Constants,
}

impl More {
    /// Reads its lines.
    pub(crate) fn read(lines: &mut Lines<'_>) -> Parsed<Self> {
        let first = match lines.numbers("first")?[..] {
            [signal, load] => (signal, load),
            _ => return lines.fault("`first` and 2 numbers are expected"),
        };
        let start = match &lines.numbers("start")?[..] {
            [] => None,
            [input, points @ ..] => Some((points.to_vec(), *input)),
        };
        let body = match lines.numbers("body")?[..] {
            [] => None,
            [ambient, gain, tau_heating, tau_cooling] => Some(Body {
                ambient,
                gain,
                tau_heating,
                tau_cooling,
            }),
            _ => return lines.fault("`body` and 4 numbers are expected"),
        };
        let drive = match lines.numbers("drive")?[..] {
            [] => (f64::NEG_INFINITY, f64::INFINITY),
            [low, high] if low <= high => (low, high),
            _ => return lines.fault("`drive` and 2 numbers in order are expected"),
        };
        let mut stages = Constants {
            body,
            drive,
            loads: lines.numbers("loads")?,
            shifts: lines.numbers("shifts")?,
            scales: lines.numbers("scales")?,
            gains: lines.numbers("gains")?,
            offsets: lines.numbers("offsets")?,
            spacing: lines.numbers("spacing")?,
            creep: lines.numbers("creep")?,
            taus: lines.numbers("taus")?,
            lag: 0.0,
        };
        stages.lag = match lines.numbers("lag")?[..] {
            [lag] => lag,
            _ => return lines.fault("`lag` and 1 number is expected"),
        };
        Ok(Self {
            first,
            start,
            stages,
        })
    }
}

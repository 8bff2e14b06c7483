//! What a picture shows.

use super::id::Id;
use super::thinned::{Ends, Scale};
use hysteron::Recording;
use serde::{Deserialize, Serialize};

/// What is drawn of a file and of fits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Picture {
    /// The input over time.
    Input,
    /// The output over time.
    Output,
    /// The output over the input.
    Loop,
    /// Modelled minus measured output over time.
    Residuals,
    /// The same over the input.
    ResidualsOverInput,
    /// How often each residual occurs.
    Histogram,
}

/// Lines that are asked for.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct View {
    /// The file.
    pub file: Id,
    /// The fits drawn with it.
    #[serde(default)]
    pub fits: Vec<Id>,
    /// What is drawn.
    pub picture: Picture,
    /// The part of the time that is shown, in seconds, or in samples from 1; `None` for all.
    #[serde(default)]
    pub window: Option<(f64, f64)>,
    /// The part of the loop that is shown: samples beside it are left out of every picture.
    #[serde(default)]
    pub area: Area,
    /// The file before its preparation too, where it is prepared.
    #[serde(default)]
    pub raw: bool,
    /// The fit whose outliers and held-out samples are drawn, too.
    #[serde(default)]
    pub of: Option<Id>,
    /// Its band as well.
    #[serde(default)]
    pub band: bool,
    /// Width and height of the picture in pixels.
    pub pixels: (u32, u32),
}

impl View {
    /// What its axes show, where the samples in it reach from one to the other of these ends.
    pub(super) fn scale(&self, ends: [Option<Ends>; 2]) -> Scale {
        let over_input = matches!(self.picture, Picture::Loop | Picture::ResidualsOverInput);
        let area = [
            self.area.input.filter(|_| over_input),
            self.area.output.filter(|_| self.picture == Picture::Loop),
        ];
        [0, 1].map(|axis| area[axis].or(ends[axis].map(|ends| (ends.low, ends.high))))
    }
}

/// A part of the loop. `None` for the whole of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(default)]
pub struct Area {
    /// Lowest and highest input.
    pub input: Option<(f64, f64)>,
    /// Lowest and highest measured output.
    pub output: Option<(f64, f64)>,
}

impl Area {
    /// Whether the loop is inside at a sample, or on the way from or to it, so that lines go to
    /// the edge.
    pub(super) fn shows(&self, recording: &Recording, n: usize) -> bool {
        if self.input.is_none() && self.output.is_none() {
            return true;
        }
        self.has(recording, n)
            || (n > 0 && self.has(recording, n - 1))
            || (n + 1 < recording.len() && self.has(recording, n + 1))
    }

    pub(super) fn has(&self, recording: &Recording, n: usize) -> bool {
        let inside = |ends: Option<(f64, f64)>, value: f64| {
            ends.is_none_or(|(low, high)| (low..=high).contains(&value))
        };
        inside(self.input, recording.input[n]) && inside(self.output, recording.output[n])
    }
}

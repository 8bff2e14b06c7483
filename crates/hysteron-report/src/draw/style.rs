//! One look for all figures. Lines differ in lightness, width and dash, so that they stay apart in
//! grey.

use serde::Serialize;

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct Stroke {
    pub(crate) colour: &'static str,
    pub(crate) width: f64,
    /// SVG dash array; empty for a solid line.
    pub(crate) dash: &'static str,
}

impl Stroke {
    pub(crate) const fn solid(colour: &'static str, width: f64) -> Self {
        Self {
            colour,
            width,
            dash: "",
        }
    }
}

/// What was measured: dark, solid, wide enough to show on both sides of a curve that lies on it.
pub(crate) const MEASURED: Stroke = Stroke::solid("#1d2b3a", 2.8);
/// What the model says; for the inverse, the policy that holds.
pub(crate) const MODELLED: Stroke = Stroke {
    colour: "#f0701f",
    width: 1.7,
    dash: "8 4",
};
/// The inverse that anticipates.
pub(crate) const ANTICIPATE: Stroke = Stroke {
    colour: "#1496b8",
    width: 2.0,
    dash: "0.1 3.6",
};
/// A discrepancy where it stands alone.
pub(crate) const DISCREPANCY: Stroke = Stroke::solid("#1d2b3a", 1.3);

/// For many lines in one panel: ever darker, and different in their dashes.
pub(crate) const LINES: [Stroke; 7] = [
    dashed("#b9c2cc", "2 4"),
    dashed("#e0a15e", "9 4"),
    dashed("#7cb5cf", ""),
    dashed("#d9682d", "2 4"),
    dashed("#3a86b4", "9 4"),
    dashed("#a53e0f", ""),
    dashed("#0f2f63", "12 4 2 4"),
];

const fn dashed(colour: &'static str, dash: &'static str) -> Stroke {
    Stroke {
        colour,
        width: 2.0,
        dash,
    }
}

/// Axis lines and ticks.
pub(crate) const AXIS: Stroke = Stroke::solid("#444b54", 1.0);
/// Grid lines, behind the data.
pub(crate) const GRID: Stroke = Stroke::solid("#e6e9ed", 0.8);
/// The line of no discrepancy.
pub(crate) const ZERO: Stroke = Stroke::solid("#8a929c", 1.0);
/// A level that a picture refers to.
pub(crate) const GUIDE: Stroke = Stroke {
    colour: "#444b54",
    width: 1.1,
    dash: "4 3",
};

/// The ring around the sample that a figure points out; its shape alone tells it on a grey print.
pub(crate) const POINTED: Stroke = Stroke::solid("#b3006b", 2.0);

/// What the output should be: wide and pale, under the curve that follows it.
pub(crate) const REFERENCE: Stroke = Stroke::solid("#a9b3be", 4.2);
/// A curve that may be noisy, where dashes would be lost.
pub(crate) const FOLLOWER: Stroke = Stroke::solid("#12385f", 1.3);
/// Where a curve leaves the panel.
pub(crate) const BEYOND: Stroke = Stroke::solid("#d2550c", 3.4);

/// Samples in the dead band.
pub(crate) const SHADE: &str = "#e4e7ec";
/// The band around the model's output: a tint of its colour.
pub(crate) const BAND: &str = "#fbd9c0";
/// Text.
pub(crate) const INK: &str = "#1b2128";
/// Text of less weight.
pub(crate) const FAINT: &str = "#4c5661";

/// Size of a title.
pub(crate) const TITLE: f64 = 15.5;
/// Size of axis labels and legends.
pub(crate) const LABEL: f64 = 13.5;
/// Size of tick labels.
pub(crate) const TICK: f64 = 12.5;

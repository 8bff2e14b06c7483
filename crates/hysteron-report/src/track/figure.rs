//! The figures of a comparison.

use super::view::View;
use super::{before_after, input, reversal, series, weights_time};
use crate::draw::sheet::Drawing;

/// A figure of the report, named after what it shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Figure {
    /// Reference and output over time.
    Tracking,
    /// Output minus reference over time.
    Error,
    /// A reversal of the reference, close up.
    Reversal,
    /// True or measured, and commanded input over time.
    Input,
    /// Drive and status over time.
    Drive,
    /// Predicted minus reached output over time.
    Prediction,
    /// Change of the adapted weights over time.
    WeightsTime,
    /// The plane before and after.
    BeforeAfter,
}

impl Figure {
    /// Every figure, in the order of the page.
    pub(super) const ALL: [Self; 8] = [
        Self::Tracking,
        Self::Error,
        Self::Reversal,
        Self::Input,
        Self::Drive,
        Self::Prediction,
        Self::WeightsTime,
        Self::BeforeAfter,
    ];

    /// File name without extension.
    pub(super) fn stem(self) -> &'static str {
        match self {
            Self::Tracking => "track-output",
            Self::Error => "track-error",
            Self::Reversal => "track-reversal",
            Self::Input => "track-input",
            Self::Drive => "track-drive",
            Self::Prediction => "track-prediction",
            Self::WeightsTime => "track-weights",
            Self::BeforeAfter => "track-plane",
        }
    }

    /// The figure as SVG; `None` where the runs have nothing to show in it.
    pub(super) fn svg(self, view: &View<'_>) -> Option<Drawing> {
        match self {
            Self::Tracking => Some(series::tracking(view)),
            Self::Error => Some(series::error(view)),
            Self::Reversal => reversal::svg(view),
            Self::Input => input::input(view),
            Self::Drive => input::drive(view),
            Self::Prediction => series::prediction(view),
            Self::WeightsTime => weights_time::svg(view),
            Self::BeforeAfter => before_after::svg(view),
        }
    }
}

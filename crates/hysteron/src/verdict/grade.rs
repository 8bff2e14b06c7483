//! What a model is good for, and what says so.

use serde::Serialize;

/// Errors up to this, in percent, are good.
pub(super) const GOOD: f64 = 1.0;
/// So are errors up to this many deviations of the noise: no model predicts that.
pub(super) const OF_NOISE: f64 = 1.5;
/// Errors up to this, in percent, are usable.
pub(super) const USABLE: f64 = 5.0;

/// What a model is good for.
///
/// The error counts, in percent of the range of the output, on data that the model was not fitted
/// to. One step less where a simple predictor errs less. At most `Usable` where few branches or
/// points that are unlike each other were recorded, loads left out are predicted badly, or what
/// comes late was found at one speed. `Poor` where a fifth of the inputs is outside the plane, the
/// output does not move, or hardly follows the input.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Grade {
    /// At most 1 %, or hardly more than the noise of the readings: good enough to drive by its
    /// inverse alone.
    Good,
    /// At most 5 %: useful beside a controller that measures the output.
    Usable,
    /// More: not to be driven by.
    Poor,
    /// Not known, as it was tested only on what it was fitted to.
    Untested,
}

/// What an error was measured on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Basis {
    /// Another recording than the one fitted.
    OtherRecording,
    /// What the user held out of the fit.
    HeldOut,
    /// Branches that the fit left out one after the other to choose its options.
    BranchesLeftOut,
    /// Parts of branches, where there are too few whole ones.
    PartsLeftOut,
    /// The data fitted: it says nothing of others.
    Fitted,
}

//! The figures that a report can hold.

use std::fmt;

/// A figure of a report, named after what it shows and, where it stands beside a figure of the
/// chapter, numbered after that.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Figure {
    /// Fig. 2: major loops at the smallest, the middle and the largest load.
    LoadLoops,
    /// By how much a load shifts the axis of the input.
    LoadShift,
    /// Loops of the recording at each of its loads, measured and modelled.
    LoadMeasured,
    /// Fig. 6: operator states on the plane at a few instants of the recording.
    PlaneEvolution,
    /// Fig. 8(a): which weights are not zero.
    WeightsPlane,
    /// Fig. 8(b): how large the weights are.
    WeightsMap,
    /// What the recording fitted says of each operator.
    Excitation,
    /// Standard errors of the weights.
    StandardErrors,
    /// Errors on left-out branches by levels and smoothness.
    CrossValidation,
    /// Fig. 10: modelled and measured output over time.
    OutputTime,
    /// Fig. 11: modelled and measured output over input.
    Loops,
    /// Fig. 12: modelled minus measured output over time.
    OutputDiscrepancy,
    /// Modelled minus measured output over the input.
    OutputResiduals,
    /// How often each size of it occurs.
    OutputHistogram,
    /// Fig. 13: input from the inverse model, and measured input, over time.
    InputTime,
    /// Fig. 14: modelled minus measured input over time.
    InputDiscrepancy,
    /// Fig. 15: close-up of the dead band with the largest input discrepancy.
    DeadBand,
}

impl Figure {
    /// Every figure, in the order of the page: the fitted weights, both tests, then the memory
    /// behind them.
    pub const ALL: [Self; 17] = [
        Self::WeightsPlane,
        Self::WeightsMap,
        Self::LoadShift,
        Self::LoadLoops,
        Self::Excitation,
        Self::StandardErrors,
        Self::CrossValidation,
        Self::OutputTime,
        Self::Loops,
        Self::LoadMeasured,
        Self::OutputDiscrepancy,
        Self::OutputResiduals,
        Self::OutputHistogram,
        Self::InputTime,
        Self::InputDiscrepancy,
        Self::DeadBand,
        Self::PlaneEvolution,
    ];

    /// File name without extension, for example `fig10-output-time`.
    pub fn stem(self) -> &'static str {
        match self {
            Self::LoadLoops => "fig02-load-loops",
            Self::LoadShift => "load-shift",
            Self::LoadMeasured => "load-measured",
            Self::Excitation => "excitation",
            Self::StandardErrors => "standard-errors",
            Self::CrossValidation => "cross-validation",
            Self::PlaneEvolution => "fig06-plane-evolution",
            Self::WeightsPlane => "fig08a-weights-plane",
            Self::WeightsMap => "fig08b-weights-map",
            Self::OutputTime => "fig10-output-time",
            Self::Loops => "fig11-loops",
            Self::OutputDiscrepancy => "fig12-output-discrepancy",
            Self::OutputResiduals => "residuals-input",
            Self::OutputHistogram => "residuals-histogram",
            Self::InputTime => "fig13-input-time",
            Self::InputDiscrepancy => "fig14-input-discrepancy",
            Self::DeadBand => "fig15-dead-band",
        }
    }

    /// Number of the chapter's figure, for example `8(a)`, where there is one.
    pub fn chapter_number(self) -> Option<&'static str> {
        Some(match self {
            Self::LoadLoops => "2",
            Self::PlaneEvolution => "6",
            Self::WeightsPlane => "8(a)",
            Self::WeightsMap => "8(b)",
            Self::OutputTime => "10",
            Self::Loops => "11",
            Self::OutputDiscrepancy => "12",
            Self::InputTime => "13",
            Self::InputDiscrepancy => "14",
            Self::DeadBand => "15",
            Self::LoadShift
            | Self::LoadMeasured
            | Self::Excitation
            | Self::StandardErrors
            | Self::CrossValidation
            | Self::OutputResiduals
            | Self::OutputHistogram => return None,
        })
    }

    /// Whether the figure shows the inverse model, and so is absent where there is none.
    pub(crate) fn needs_inverse(self) -> bool {
        matches!(
            self,
            Self::InputTime | Self::InputDiscrepancy | Self::DeadBand
        )
    }
}

impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.stem())
    }
}

//! The flags of a control loop.

/// Flags of one sample of a control loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LoopStatus {
    /// The drive or the commanded input was at a limit.
    pub saturated: bool,
    /// The model could not reach the reference. The nearest reachable output was used.
    pub out_of_reach: bool,
    /// A reading was missing or stuck. The loop continued without it.
    pub sensor_fault: bool,
    /// The model learned from the sample.
    pub adapted: bool,
    /// The reading was rejected: it was too far from the expected output, so the model did not
    /// learn from it.
    pub rejected: bool,
    /// A channel stands still while the other one moves, so the model does not learn
    /// ([`hysteron_core::Watch`]).
    pub stuck: bool,
    /// The loop is given up: the drive is the safe one ([`super::Scheme::safety`]).
    pub safe: bool,
}

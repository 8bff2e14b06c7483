//! A column of the regressor.

/// An operator that is multiplied by a function of the load, from one start in each recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Column {
    /// Index of the function of the load that the column is multiplied by.
    pub(crate) part: usize,
    /// Index of the operator, in the order of the weights.
    pub(crate) operator: usize,
    /// Bit `s` is set if the column starts on in recording `s`.
    pub(super) on: u64,
}

impl Column {
    /// The column of an operator that starts off.
    #[cfg(test)]
    pub(crate) fn known(part: usize, operator: usize) -> Self {
        let on = 0;
        Self { part, operator, on }
    }

    /// Whether the operator starts on in a recording.
    pub(super) fn is_on_in(&self, recording: usize) -> bool {
        self.on >> recording & 1 == 1
    }
}

//! Error measures.

/// How far a modelled series is from a measured one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// Root of the mean squared difference, in the unit of the series.
    pub rmse: f64,
    /// Largest absolute difference, in the unit of the series.
    pub max_abs: f64,
    /// `rmse` in percent of the measured range.
    pub nrmse_percent: f64,
    /// How many samples were compared.
    pub samples: usize,
}

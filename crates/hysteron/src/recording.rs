//! Recordings.

/// A physical quantity: its name and, where known, its unit.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Quantity {
    /// Name, for example `temperature`.
    pub name: String,
    /// Unit, for example `degC`; `None` where the source does not say.
    pub unit: Option<String>,
}

/// Where a recording comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// Read from a file.
    Measured,
    /// Produced by a simulated plant; every surface must say so.
    Simulated,
}

/// An input and the output it caused, sample by sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// Time of each sample in seconds, where the source has one.
    pub time: Option<Vec<f64>>,
    /// Input samples.
    pub input: Vec<f64>,
    /// Output samples, as many as `input`.
    pub output: Vec<f64>,
    /// What the input is.
    pub input_quantity: Quantity,
    /// What the output is.
    pub output_quantity: Quantity,
    /// Measured or simulated.
    pub origin: Origin,
}

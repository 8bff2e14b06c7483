//! What an FMU is to be.

use hysteron::control::Scheme;

/// The block that is made.
#[derive(Debug, Clone, Copy)]
pub(super) enum Block<'a> {
    Forward,
    Inverse,
    Controller(&'a Scheme),
}

impl Block<'_> {
    pub(super) fn is_forward(self) -> bool {
        matches!(self, Self::Forward)
    }
}

/// What an FMU is to be.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FmuOptions {
    /// The inverse of the model, from the wanted output to the input, instead of the model.
    pub inverse: bool,
    /// The standard that it follows.
    pub fmi: Fmi,
    /// The block's name, a C identifier of up to 60 letters; `sf_MKP`, `sf_Inverse_MKP` or
    /// `sf_Controller_MKP` without one.
    pub name: Option<String>,
}

/// A version of the Functional Mock-up Interface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Fmi {
    /// FMI 2.0, co-simulation: what most tools import.
    #[default]
    V2,
    /// FMI 3.0, co-simulation.
    V3,
}

impl Fmi {
    /// `2.0` or `3.0`.
    #[must_use]
    pub fn version(self) -> &'static str {
        match self {
            Fmi::V2 => "2.0",
            Fmi::V3 => "3.0",
        }
    }
}

//! What a fit says of how well the data determined its weights.

use crate::model::excitation::Excitation;
use crate::model::load::LoadPart;
use serde::{Deserialize, Serialize};

/// What the data say of the weights, and what not.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an object in braces")]
pub struct Confidence {
    /// Branches of the input.
    pub branches: usize,
    /// How many combinations of weights (and initial states, where these are unknown) the data
    /// determine at all.
    pub rank: usize,
    /// How many there are.
    pub unknowns: usize,
    /// Ratio of the best to the worst determined of them, singular values of the centred regressor.
    pub condition: f64,
    /// Standard deviation of what the model leaves, in the output's unit.
    pub noise: f64,
    /// Replicates of the bootstrap.
    pub replicates: usize,
    /// What the input says of each operator, in the order of the weights.
    pub excitation: Vec<Excitation>,
    /// Standard error of each weight, in the output's unit; with a load, at the middle of its
    /// range.
    pub standard_error: Vec<f64>,
    /// Standard error of the offset.
    pub offset_error: f64,
    /// The main joint deviations of offset and weights, each one standard deviation long.
    pub factors: Vec<LoadPart>,
}

impl Confidence {
    /// The first entry that cannot be, of a model with `operators` operators, and why.
    pub(crate) fn fault(&self, operators: usize) -> Option<(String, String)> {
        let lengths = [
            ("excitation", self.excitation.len()),
            ("standard_error", self.standard_error.len()),
        ];
        let factors = self.factors.iter().enumerate();
        let of_factors = factors.map(|(n, f)| (format!("factors[{n}].weights"), f.weights.len()));
        let lengths = lengths.map(|(name, length)| (name.to_owned(), length));
        for (name, length) in lengths.into_iter().chain(of_factors) {
            if length != operators {
                return Some((name, format!("{length} entries for {operators} operators")));
            }
        }
        let sizes = [
            ("condition", self.condition),
            ("noise", self.noise),
            ("offset_error", self.offset_error),
        ];
        let errors = self.standard_error.iter().map(|e| ("standard_error", *e));
        let factors = self.factors.iter();
        let deviations = factors.flat_map(|f| f.weights.iter().chain([&f.offset]));
        let deviations = deviations.map(|d| ("factors", d.abs()));
        let mut numbers = sizes.into_iter().chain(errors).chain(deviations);
        // Their squares are summed.
        numbers
            .find(|(_, value)| !(0.0..=1e140).contains(value))
            .map(|(name, value)| {
                (
                    name.to_owned(),
                    format!("{value:e} is not a number from zero on that can be squared"),
                )
            })
    }

    /// How many operators are in a class.
    #[must_use]
    pub fn count(&self, class: Excitation) -> usize {
        self.excitation.iter().filter(|e| **e == class).count()
    }
}

/// Half the width of a 95 % interval in standard errors of a normal distribution.
pub const INTERVAL: f64 = 1.959_963_984_540_054;

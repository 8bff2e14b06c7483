//! How well the data determined the weights of a model. This part of the model file is written by a
//! fit.

use crate::model::excitation::Excitation;
use crate::model::load::LoadPart;
use serde::{Deserialize, Serialize};

/// How well the data determine the weights.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an object in braces")]
pub struct Confidence {
    /// Number of branches of the input.
    pub branches: usize,
    /// Rank: number of combinations of weights (and of unknown initial states) that the data
    /// determine.
    pub rank: usize,
    /// Number of unknowns.
    pub unknowns: usize,
    /// Condition number: ratio of the largest to the smallest non-zero singular value of the
    /// centred regressor.
    pub condition: f64,
    /// Standard deviation of what the weights' uncertainty does not explain, in the output's unit:
    /// such that the band holds 95 % of the samples that fits left out.
    pub noise: f64,
    /// Standard deviation of the white noise of the readings, in the output's unit. What the model
    /// cannot follow is no part of it.
    #[serde(default)]
    pub sensor: f64,
    /// Number of sessions that the band holds: 1 for the recordings fitted, and one for each repeat.
    #[serde(default)]
    pub sessions: usize,
    /// Number of bootstrap replicates.
    pub replicates: usize,
    /// How well the input determines each operator, in the order of the weights.
    pub excitation: Vec<Excitation>,
    /// Standard error of each weight, in the output's unit; with a load, at the middle of its
    /// range.
    pub standard_error: Vec<f64>,
    /// Standard error of the offset, in the output's unit.
    pub offset_error: f64,
    /// Principal components of the joint deviations of offset and weights, each scaled to one
    /// standard deviation.
    pub factors: Vec<LoadPart>,
}

impl Confidence {
    /// The first invalid entry for a model with `operators` operators, and the reason.
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
            ("sensor", self.sensor),
            ("offset_error", self.offset_error),
        ];
        let errors = self.standard_error.iter().map(|e| ("standard_error", *e));
        let factors = self.factors.iter();
        let deviations = factors.flat_map(|f| f.weights.iter().chain([&f.offset]));
        let deviations = deviations.map(|d| ("factors", d.abs()));
        let mut numbers = sizes.into_iter().chain(errors).chain(deviations);
        // Their squares will be summed, so limit their size.
        numbers
            .find(|(_, value)| !(0.0..=1e140).contains(value))
            .map(|(name, value)| {
                (
                    name.to_owned(),
                    format!("{value:e} is negative, not a number, or too large to be squared"),
                )
            })
    }

    /// What the band is called, as by [`crate::BandEvaluation::name`].
    #[must_use]
    pub fn band_name(&self) -> String {
        band_name(self.sessions)
    }

    /// Number of operators in a class.
    #[must_use]
    pub fn count(&self, class: Excitation) -> usize {
        self.excitation.iter().filter(|e| **e == class).count()
    }
}

/// Half the width of a 95 % interval of a normal distribution, in standard deviations.
pub const INTERVAL: f64 = 1.959_963_984_540_054;

/// What the 95 % band of a model that knows so many sessions is called.
pub(crate) fn band_name(sessions: usize) -> String {
    match sessions {
        0 | 1 => "95 % band within its session".into(),
        sessions => format!("95 % band of {sessions} sessions"),
    }
}

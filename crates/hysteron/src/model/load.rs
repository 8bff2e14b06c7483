//! The load: it shifts the operators' axis, and offset and weights depend on it. So one model holds
//! for several loads or stresses.

use crate::error::{Error, Result};
use crate::model::operators::Operators;
use crate::recording::Quantity;
use crate::remedy::{Remedy, Setting};
use serde::{Deserialize, Serialize};

/// The part of the range of a load that the readings of a load cell wander: not another load.
const NOISE: f64 = 0.01;

/// Offset and weights that belong to one Bernstein polynomial of the load.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an object in braces")]
pub struct LoadPart {
    /// Output with every operator off.
    pub offset: f64,
    /// `N` weights, row by row.
    pub weights: Vec<f64>,
}

impl LoadPart {
    /// Offset and weights at the middle of the load range.
    pub(crate) fn at_middle(parts: &[Self]) -> Self {
        Self::sum(parts, &bernstein(parts.len() - 1, 0.5))
    }

    fn sum(parts: &[Self], factors: &[f64]) -> Self {
        let mut sum = Self {
            offset: 0.0,
            weights: vec![0.0; parts[0].weights.len()],
        };
        for (factor, part) in factors.iter().zip(parts) {
            sum.offset += factor * part.offset;
            for (sum, mu) in sum.weights.iter_mut().zip(&part.weights) {
                *sum += factor * mu;
            }
        }
        sum
    }
}

/// What a load does, as curves over the load: piecewise linear between the loads given.
///
/// The load shifts and scales the axis of the operators, `x = a(σ) · T − s(σ)`, and changes stroke
/// and offset, `y = offset + o(σ) ± g(σ) · Σ μ γ`. Under stress a shape-memory alloy transforms at
/// a higher temperature (Clausius and Clapeyron), and its stroke grows. Weights alone cannot follow
/// the first, because they do not move along the axis.
///
/// A curve that is empty has no effect.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an object in braces")]
pub struct LoadCurves {
    /// The loads, ascending.
    pub loads: Vec<f64>,
    /// The shift `s` at each load, in the input's unit.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shifts: Vec<f64>,
    /// The scale `a` at each load, above zero.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub scales: Vec<f64>,
    /// The gain `g` at each load, above zero.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub gains: Vec<f64>,
    /// The offset `o` at each load, in the output's unit.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub offsets: Vec<f64>,
}

impl LoadCurves {
    /// The curves for the core.
    pub(crate) fn core(&self) -> hysteron_core::Load<'_, f64> {
        hysteron_core::Load {
            loads: &self.loads,
            shifts: &self.shifts,
            scales: &self.scales,
            gains: &self.gains,
            offsets: &self.offsets,
        }
    }

    /// The values of all curves at a load. Beyond the ends they are those of the nearest load.
    ///
    /// # Errors
    /// [`Error::Core`] for a load that is not finite.
    pub fn at(&self, load: f64) -> Result<hysteron_core::Loaded<f64>> {
        Ok(self.core().at(Some(load))?)
    }

    /// The shift at a load, which goes on beyond the ends with the slope of the outermost piece.
    pub(crate) fn extended(&self, load: f64) -> f64 {
        let last = self.loads.len() - 1;
        if last == 0 {
            return self.shifts[0];
        }
        let k = self
            .loads
            .partition_point(|knot| *knot <= load)
            .clamp(1, last)
            - 1;
        let slope = (self.shifts[k + 1] - self.shifts[k]) / (self.loads[k + 1] - self.loads[k]);
        self.shifts[k] + (load - self.loads[k]) * slope
    }

    /// The mean slope of the shift, in units of the input per unit of the load. 0 for one load.
    #[must_use]
    pub fn slope(&self) -> f64 {
        match (self.loads.as_slice(), self.shifts.as_slice()) {
            ([first, .., last], [low, .., high]) => (high - low) / (last - first),
            _ => 0.0,
        }
    }
}

/// How offset and weights depend on the load: `μ(s) = Σ_k μ_k B_k(s)`, where `B_k` are Bernstein
/// polynomials and `s` in `[0, 1]` is the load scaled to its range. The first part is the model at
/// the smallest load and the last part the model at the largest; those between are control points.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadDependence {
    /// Name and unit of the load.
    pub quantity: Quantity,
    range: (f64, f64),
    parts: Vec<LoadPart>,
    /// How the load moves axis, stroke and offset; `None` where it changes offset and weights only.
    pub curves: Option<LoadCurves>,
    /// The Everett table of each part.
    tables: Vec<Vec<f64>>,
    /// Offsets and weights of the parts, one part after the other.
    joined: (Vec<f64>, Vec<f64>),
    /// Whether a weight of a part is below zero.
    negative: bool,
}

impl LoadDependence {
    /// Offset and weights for each of `parts` (at least one), over the `range` of loads. The
    /// operators are of the same kind as `like`.
    ///
    /// # Errors
    /// As [`Operators::new`], with the index of the part.
    pub(crate) fn new(
        quantity: Quantity,
        range: (f64, f64),
        parts: Vec<LoadPart>,
        like: &Operators,
    ) -> std::result::Result<Self, (usize, Error)> {
        let operators = parts.iter().enumerate().map(|(n, part)| {
            let (operator, plane) = (like.operator(), *like.plane());
            let weights = part.weights.clone();
            Operators::new(operator, plane, weights, part.offset, like.sign())
                .map_err(|error| (n, error))
        });
        let operators = operators.collect::<std::result::Result<Vec<_>, _>>()?;
        let offsets = parts.iter().map(|part| part.offset).collect();
        let weights = parts.iter().flat_map(|part| part.weights.iter().copied());
        Ok(Self {
            quantity,
            range,
            joined: (offsets, weights.collect()),
            parts,
            curves: None,
            negative: operators
                .iter()
                .any(|part| part.core.negative_weights().is_some()),
            tables: operators
                .iter()
                .map(|part| part.core.table().to_vec())
                .collect(),
        })
    }

    /// The Everett table of each part.
    pub(crate) fn tables(&self) -> &[Vec<f64>] {
        &self.tables
    }

    /// Whether a weight of a part is below zero, so that there is no inverse.
    pub(crate) fn is_negative(&self) -> bool {
        self.negative
    }

    /// The error for a model that depends on a load but was given none.
    pub(crate) fn one_is_needed(&self) -> Error {
        let (low, high) = self.range;
        let what = format!(
            "the model depends on the load `{}`, from {low} to {high}",
            self.quantity.name
        );
        let remedy = Remedy::new(
            "give it, or take the model at one load ({})",
            [Setting::any("load")],
        );
        Error::Fit(what).remedied(remedy)
    }

    /// Smallest and largest load that the model was identified at.
    #[must_use]
    pub fn range(&self) -> (f64, f64) {
        self.range
    }

    /// The order of the weights in the load: 0 if all parts have the same weights.
    #[must_use]
    pub fn weights_order(&self) -> usize {
        let same = self
            .parts
            .windows(2)
            .all(|pair| pair[0].weights == pair[1].weights);
        if same { 0 } else { self.parts.len() - 1 }
    }

    /// The parts: one more than the degree in the load.
    #[must_use]
    pub fn parts(&self) -> &[LoadPart] {
        &self.parts
    }

    /// The offsets of the parts, and their weights, one part after the other: for interfaces that
    /// carry arrays.
    ///
    /// ```
    /// let model = hysteron::Model::from_json(r#"{"format": "hysteron-model", "version": 2,
    ///     "operator": "mkp", "plane": {"min": 1, "max": 2, "levels": 2}, "weights": [1, 1, 1],
    ///     "output": {"offset": 2}, "load": {"min": 0, "max": 9, "parts": [
    ///         {"offset": 0, "weights": [1, 0, 1]}, {"offset": 4, "weights": [1, 2, 1]}]}}"#)?;
    /// let (offsets, weights) = model.load.as_ref().unwrap().joined();
    /// assert_eq!((offsets, weights), (&[0.0, 4.0][..], &[1.0, 0.0, 1.0, 1.0, 2.0, 1.0][..]));
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    #[must_use]
    pub fn joined(&self) -> (&[f64], &[f64]) {
        (&self.joined.0, &self.joined.1)
    }

    /// The factor of each part at a load: the values of the Bernstein polynomials. A load that is
    /// outside the range by at most a hundredth of it is taken for that end.
    ///
    /// # Errors
    /// [`Error::Fit`] for a load further outside, because weights could be negative there.
    pub fn factors(&self, load: f64) -> Result<Vec<f64>> {
        let (low, high) = self.range;
        if !self.knows(load) {
            return Err(Error::Fit(format!(
                "the {} {load} is outside the range {low} to {high} that the model was identified \
                 at",
                self.quantity.name
            )));
        }
        let s = ((load - low) / (high - low)).clamp(0.0, 1.0);
        Ok(bernstein(self.parts.len() - 1, s))
    }

    /// Whether a load is in the range, or hardly outside.
    pub(super) fn knows(&self, load: f64) -> bool {
        let (low, high) = self.range;
        let slack = NOISE * (high - low);
        load >= low - slack && load <= high + slack
    }

    /// Offset and weights at a load.
    ///
    /// # Errors
    /// As [`LoadDependence::factors`].
    pub fn at(&self, load: f64) -> Result<LoadPart> {
        Ok(LoadPart::sum(&self.parts, &self.factors(load)?))
    }
}

pub(crate) fn no_load() -> Error {
    Error::Fit("this model does not depend on a load: leave the load out".into())
}

/// The Bernstein polynomials of `degree` at `s` in `[0, 1]`.
pub(crate) fn bernstein(degree: usize, s: f64) -> Vec<f64> {
    let mut values = vec![0.0; degree + 1];
    hysteron_core::bernstein(s, &mut values);
    values
}

#[cfg(test)]
mod tests {
    use super::bernstein;

    #[test]
    fn load_functions_sum_to_one_and_meet_the_ends() {
        for degree in 0..=5 {
            for s in [0.0, 0.3, 1.0] {
                let values = bernstein(degree, s);
                assert_eq!(values.len(), degree + 1);
                // Five roundings of numbers up to one.
                assert!((values.iter().sum::<f64>() - 1.0).abs() < 1e-15 * 5.0);
                assert!(values.iter().all(|v| *v >= 0.0));
            }
            assert_eq!(bernstein(degree, 0.0)[0], 1.0);
            assert_eq!(bernstein(degree, 1.0)[degree], 1.0);
        }
    }
}

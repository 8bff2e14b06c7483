//! Weights that depend on a load, so that one model holds for several loads or stresses.

use crate::error::{Error, Result};
use crate::model::{Model, Operators};
use crate::recording::Quantity;
use crate::remedy::{Remedy, Setting};
use serde::{Deserialize, Serialize};

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

/// How offset and weights depend on the load: `μ(s) = Σ_k μ_k B_k(s)`, where `B_k` are Bernstein
/// polynomials and `s` in `[0, 1]` is the load scaled to its range. The first part is the model at
/// the smallest load and the last part the model at the largest; those between are control points.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadDependence {
    /// Name and unit of the load.
    pub quantity: Quantity,
    range: (f64, f64),
    parts: Vec<LoadPart>,
    /// One set of operators for each part.
    operators: Vec<Operators>,
}

impl LoadDependence {
    /// Operators of the same kind as `like` for each of `parts` (at least one), over the `range` of
    /// loads.
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
            Operators::new(
                operator,
                plane,
                part.weights.clone(),
                part.offset,
                like.sign(),
            )
            .map_err(|error| (n, error))
        });
        let operators = operators.collect::<std::result::Result<_, _>>()?;
        Ok(Self {
            quantity,
            range,
            parts,
            operators,
        })
    }

    /// The operators of each part.
    pub(crate) fn operators(&self) -> impl Iterator<Item = &Operators> {
        self.operators.iter()
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

    /// The parts: one more than the degree in the load.
    #[must_use]
    pub fn parts(&self) -> &[LoadPart] {
        &self.parts
    }

    /// The factor of each part at a load: the values of the Bernstein polynomials.
    ///
    /// # Errors
    /// [`Error::Fit`] for a load outside the range, because weights could be negative there.
    pub fn factors(&self, load: f64) -> Result<Vec<f64>> {
        let (low, high) = self.range;
        // A difference of a millionth of the range is rounding in print, not another load.
        let slack = 1e-6 * (high - low);
        if !(load >= low - slack && load <= high + slack) {
            return Err(Error::Fit(format!(
                "the {} {load} is outside the range {low} to {high} that the model was identified \
                 at",
                self.quantity.name
            )));
        }
        let s = ((load - low) / (high - low)).clamp(0.0, 1.0);
        Ok(bernstein(self.parts.len() - 1, s))
    }

    /// Offset and weights at a load.
    ///
    /// # Errors
    /// As [`LoadDependence::factors`].
    pub fn at(&self, load: f64) -> Result<LoadPart> {
        Ok(LoadPart::sum(&self.parts, &self.factors(load)?))
    }
}

impl Model {
    /// The model at one load. The result does not depend on a load.
    ///
    /// # Errors
    /// [`Error::Fit`] if the model does not depend on a load, or for a load outside its range.
    pub fn at_load(&self, load: f64) -> Result<Self> {
        let Some(dependence) = &self.load else {
            return Err(no_load());
        };
        let LoadPart { offset, weights } = dependence.at(load)?;
        let (operator, plane) = (self.operator(), *self.plane());
        let mut model = Self::new(operator, plane, weights, offset, self.sign())?;
        model.input = self.input.clone();
        model.output = self.output.clone();
        model.thermal = self.thermal;
        model.fit = self.fit.clone();
        Ok(model)
    }

    /// The outputs for `input` under a `load` that may change from sample to sample, from every
    /// operator off. All three have the same length.
    ///
    /// The operators move with the input alone. So each part of the load dependence is simulated on
    /// its own.
    ///
    /// # Errors
    /// As [`Model::at_load`] and [`Model::run`]; [`Error::Fit`] if there are not as many loads as
    /// inputs.
    pub fn simulate_under_load(&self, input: &[f64], load: &[f64]) -> Result<Vec<f64>> {
        let Some(dependence) = &self.load else {
            return Err(no_load());
        };
        if load.len() != input.len() {
            let (loads, inputs) = (load.len(), input.len());
            return Err(Error::Fit(format!("{loads} loads for {inputs} inputs")));
        }
        let factors: Vec<Vec<f64>> = load
            .iter()
            .map(|f| dependence.factors(*f))
            .collect::<Result<_>>()?;
        let mut output = vec![0.0; input.len()];
        for (k, part) in dependence.operators().enumerate() {
            let run = part.simulate(input)?;
            for ((y, h), factors) in output.iter_mut().zip(run).zip(&factors) {
                *y += factors[k] * h;
            }
        }
        Ok(output)
    }
}

pub(crate) fn no_load() -> Error {
    Error::Fit("this model does not depend on a load: leave the load out".into())
}

/// The Bernstein polynomials of `degree` at `s` in `[0, 1]`. They are not negative and sum to one.
/// So non-negative coefficients give non-negative weights at every load in the range (Farouki
/// 2012).
pub(crate) fn bernstein(degree: usize, s: f64) -> Vec<f64> {
    // De Casteljau's algorithm.
    let mut values = vec![1.0];
    for _ in 0..degree {
        let mut next = vec![0.0; values.len() + 1];
        for (k, value) in values.iter().enumerate() {
            next[k] += (1.0 - s) * value;
            next[k + 1] += s * value;
        }
        values = next;
    }
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

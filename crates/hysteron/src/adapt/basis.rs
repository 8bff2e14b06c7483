//! A basis for the changes of weights under load and drift, in place of all weights.

use crate::error::Result;
use crate::model::Model;
use hysteron_core::{operator_index, operators};

/// Levels by which the weights are shifted along the diagonal of the plane.
const SHIFTS: [isize; 6] = [-3, -1, 0, 1, 3, 5];

/// A model as a sum of a few sets of weights, the basis, each times its coefficient.
///
/// An estimator adapts these few coefficients in place of all weights.
///
/// A model that depends on a load has its load parts as the basis. For any other model, the members
/// of the basis are the off-line weights, shifted along the diagonal of the plane by −3, −1, 0, 1,
/// 3 and 5 levels. A stress shifts all transformation temperatures alike (the relation of Clausius
/// and
/// Clapeyron). So coefficients of zero or above can follow a larger stroke, a shift, and a wider
/// transformation.
///
/// An operator that the shift moves beyond the plane is left out. Above the plane it would never
/// switch; below it, it would always be on, like the offset. An operator that would switch off
/// below the plane switches off at the lowest level.
///
/// ```
/// use hysteron::{DriftBasis, Model, Operator, Plane, Sign};
/// let plane = Plane::new(20.0, 80.0, 20)?;
/// let model = Model::new(Operator::Mkp, plane, vec![1.0; 210], 0.0, Sign::Positive)?;
/// let drift = DriftBasis::of(&model, None)?;
/// assert_eq!(drift.coefficients, [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct DriftBasis {
    /// The model that basis and coefficients make up, at one load.
    pub model: Model,
    /// The members of the basis: `N` weights each, row by row.
    pub basis: Vec<Vec<f64>>,
    /// One for each member of the basis, 0 or above.
    pub coefficients: Vec<f64>,
}

impl DriftBasis {
    /// The basis of `model`. A model that depends on a load starts at `load`, or at the middle of
    /// its range.
    ///
    /// # Errors
    /// [`crate::Error::Fit`] for a load outside the model's range, or of a model without one.
    pub fn of(model: &Model, load: Option<f64>) -> Result<Self> {
        let Some(dependence) = &model.load else {
            return match load {
                None => Ok(Self::shifted(model)),
                Some(_) => Err(crate::model::no_load()),
            };
        };
        let (low, high) = dependence.range();
        let load = load.unwrap_or(0.5 * (low + high));
        // The model's weights have the gain of the load's curves.
        let curves = dependence.curves.as_ref();
        let gain = curves.map_or(Ok(1.0), |curves| curves.at(load).map(|at| at.gain))?;
        let factors = dependence.factors(load)?;
        Ok(Self {
            model: model.at_load(load)?,
            basis: dependence
                .parts()
                .iter()
                .map(|part| part.weights.clone())
                .collect(),
            coefficients: factors.iter().map(|factor| gain * factor).collect(),
        })
    }

    fn shifted(model: &Model) -> Self {
        let coefficient = |shift: &isize| if *shift == 0 { 1.0 } else { 0.0 };
        Self {
            model: model.clone(),
            basis: SHIFTS.map(|shift| along_diagonal(model, shift)).to_vec(),
            coefficients: SHIFTS.iter().map(coefficient).collect(),
        }
    }
}

/// The weights moved along the diagonal of the plane by so many levels, as [`DriftBasis`] says.
pub(super) fn along_diagonal(model: &Model, shift: isize) -> Vec<f64> {
    let levels = model.plane().levels();
    let mut moved = vec![0.0; model.weights().len()];
    for ((i, j), &mu) in operators(levels).zip(model.weights()) {
        let j = j.saturating_add_signed(shift);
        if (1..=levels).contains(&j) {
            let i = i.saturating_add_signed(shift).max(1);
            moved[operator_index(i, j)] += mu;
        }
    }
    moved
}

//! A few ways in which weights change under load and drift, in place of all weights.

use crate::adapt::adaptive::Adaptive;
use crate::error::Result;
use crate::model::Model;
use hysteron_core::Adaptation;
use hysteron_core::operator_index;

/// Levels by which the weights are shifted along the diagonal of the plane.
const SHIFTS: [isize; 6] = [-3, -1, 0, 1, 3, 5];

/// Sets of weights, and the share of each, that make up a model: what an estimator with few
/// unknowns adapts.
///
/// A model that depends on a load has its load parts. For any other one, the parts are the off-line
/// weights shifted along the diagonal of the plane by −3, −1, 0, 1, 3 and 5 levels: a stress shifts
/// all transformation temperatures alike (the relation of Clausius and Clapeyron), so that shares
/// from zero on follow a larger stroke, a shift, and a transformation that is spread wider. An
/// operator shifted beyond the plane is left out: above, it never switches, and below it is always
/// on, as the offset is. One that would switch off below the plane does so at its lowest level.
///
/// ```
/// use hysteron::{DriftParts, Model, Operator, Plane, Sign};
/// let plane = Plane::new(20.0, 80.0, 20)?;
/// let model = Model::new(Operator::Mkp, plane, vec![1.0; 210], 0.0, Sign::Positive)?;
/// let parts = DriftParts::of(&model, None)?;
/// assert_eq!(parts.shares, [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct DriftParts {
    /// What the parts are with their shares: the model, at one load.
    pub model: Model,
    /// `N` weights each, row by row.
    pub parts: Vec<Vec<f64>>,
    /// As many as parts.
    pub shares: Vec<f64>,
}

impl DriftParts {
    /// The parts of `model`; one that depends on a load starts at `load`, or at the middle of its
    /// range.
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
        Ok(Self {
            model: model.at_load(load)?,
            parts: dependence
                .parts()
                .iter()
                .map(|part| part.weights.clone())
                .collect(),
            shares: dependence.factors(load)?,
        })
    }

    fn shifted(model: &Model) -> Self {
        let levels = model.plane().levels();
        let part = |shift: &isize| {
            let mut part = vec![0.0; model.weights().len()];
            let places = (1..=levels).flat_map(|j| (1..=j).map(move |i| (i, j)));
            for ((i, j), &mu) in places.zip(model.weights()) {
                let j = j.saturating_add_signed(*shift);
                if (1..=levels).contains(&j) {
                    let i = i.saturating_add_signed(*shift).max(1);
                    part[operator_index(i, j)] += mu;
                }
            }
            part
        };
        let share = |shift: &isize| if *shift == 0 { 1.0 } else { 0.0 };
        Self {
            model: model.clone(),
            parts: SHIFTS.iter().map(part).collect(),
            shares: SHIFTS.iter().map(share).collect(),
        }
    }

    /// An estimator of the shares and the offset.
    ///
    /// # Errors
    /// As [`Adaptive::of_parts`].
    pub fn adaptive(self, options: Adaptation<f64>) -> Result<Adaptive> {
        Adaptive::of_parts(&self.model, self.parts, &self.shares, options)
    }
}

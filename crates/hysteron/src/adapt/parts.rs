//! A basis with few coefficients that describes how weights change under load and drift. It is
//! adapted instead of all weights.

use crate::adapt::adaptive::Adaptive;
use crate::error::Result;
use crate::model::Model;
use hysteron_core::Adaptation;
use hysteron_core::operator_index;

/// Shifts of the weights along the diagonal of the plane, in levels.
const SHIFTS: [isize; 6] = [-3, -1, 0, 1, 3, 5];

/// A basis (`parts`, sets of weights) and its coefficients (`shares`). Their weighted sum is the
/// model. The estimator then has few unknowns.
///
/// For a model that depends on a load, the basis consists of its load parts. For any other model it
/// consists of the off-line weights, shifted along the diagonal of the plane by −3, −1, 0, 1, 3 and
/// 5 levels. The reason is that stress shifts all transformation temperatures alike (relation of
/// Clausius and Clapeyron). Non-negative coefficients can then describe a larger stroke, a shift,
/// and a wider transformation.
///
/// An operator shifted beyond the plane is omitted: above the plane it never switches, and below it
/// is always on, as the offset is. An operator that would switch off below the plane does so at its
/// lowest level.
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
    /// The model, at one load.
    pub model: Model,
    /// The basis: `N` weights each, row by row.
    pub parts: Vec<Vec<f64>>,
    /// The coefficients, as many as `parts`.
    pub shares: Vec<f64>,
}

impl DriftParts {
    /// The parts of `model`. If it depends on a load, they start at `load`, by default at the
    /// middle of its range.
    ///
    /// # Errors
    /// [`crate::Error::Fit`] for a load outside the model's range, or for a load with a model that
    /// has none.
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

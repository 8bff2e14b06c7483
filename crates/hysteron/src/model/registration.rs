//! At which temperature each threshold is passed, for rising and for falling input.

use crate::model::StageConstants;

/// The constants of a registration, as [`hysteron_core::Registration`] describes them. All empty:
/// there is none.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Registration {
    /// Two or more positions on the axis of the operators, ascending.
    pub knots: Vec<f64>,
    /// The inputs at which rising input passes the knots: a row for each load of the curves of the
    /// load, one row without them.
    pub rising: Vec<f64>,
    /// The same for falling input; empty where that passes them at the same inputs.
    pub falling: Vec<f64>,
}

impl Registration {
    /// Those among the constants of all stages.
    pub(crate) fn of_constants(constants: &StageConstants<f64>) -> Self {
        let list = |name| constants.get(name).to_vec();
        Self {
            knots: list("knots"),
            rising: list("rising"),
            falling: list("falling"),
        }
    }

    /// As the core takes them.
    pub(crate) fn core(&self) -> hysteron_core::Registration<'_, f64> {
        hysteron_core::Registration {
            knots: &self.knots,
            rising: &self.rising,
            falling: &self.falling,
        }
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.knots.is_empty()
    }

    /// The registration at one load, with all its numbers moved.
    pub(crate) fn at(
        &self,
        loaded: hysteron_core::Loaded<f64>,
        moved: impl Fn(f64) -> f64,
    ) -> Self {
        let count = self.knots.len();
        let row = |rows: &[f64]| -> Vec<f64> {
            let own = rows.iter().skip(loaded.row * count).take(count);
            let next = rows.iter().skip((loaded.row + 1) * count);
            // The last row has no next one, and is not on the way to any.
            let next = next.copied().chain(std::iter::repeat(0.0));
            let between = |(low, high): (&f64, f64)| match loaded.part == 0.0 {
                true => *low,
                false => low + loaded.part * (high - low),
            };
            own.zip(next).map(between).map(&moved).collect()
        };
        Self {
            knots: self.knots.iter().map(|x| moved(*x)).collect(),
            rising: row(&self.rising),
            falling: row(&self.falling),
        }
    }

    /// The same registration with all its numbers moved.
    pub(crate) fn moved(&self, moved: impl Fn(f64) -> f64) -> Self {
        let all = |list: &[f64]| list.iter().map(|x| moved(*x)).collect();
        Self {
            knots: all(&self.knots),
            rising: all(&self.rising),
            falling: all(&self.falling),
        }
    }
}

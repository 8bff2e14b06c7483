//! Output curve: the output is a monotone function of the operators' sum.

use crate::scalar::Real;
use crate::stages::axis::between;
use crate::stages::constant::{Constant, Constants, Declared, Range, Unit};
use crate::stages::stage::Stage;

/// A monotone curve, piecewise linear between knots. Beyond the outermost knots it goes on straight.
///
/// With plays for operators, that is a two-sided Prandtl-Ishlinskii model (Kuhnen 2003).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curve<'a, T> {
    /// The operators' sum at each knot, ascending; two or more, none for no curve.
    pub sums: &'a [T],
    /// The output of the curve at each knot, ascending; as many.
    pub outputs: &'a [T],
}

/// A curve remembers nothing.
pub(crate) type Memory<T> = [T; 0];
/// It does not depend on time.
pub(crate) type Factors<T> = [T; 0];

impl<T: Real> Curve<'_, T> {
    /// No curve.
    pub const NONE: Self = Curve {
        sums: &[],
        outputs: &[],
    };

    /// The output at a sum of the operators.
    ///
    /// ```
    /// use hysteron_core::Curve;
    /// let curve = Curve { sums: &[0.0, 1.0, 3.0], outputs: &[0.0, 4.0, 5.0] };
    /// assert_eq!((curve.at(2.0), curve.slope_at(2.0)), (4.5, 0.5));
    /// ```
    #[must_use]
    pub fn at(&self, sum: T) -> T {
        match self.sums {
            [] => sum,
            sums => between(sums, |k| self.outputs[k], sum),
        }
    }

    /// The slope at a sum of the operators.
    #[must_use]
    pub fn slope_at(&self, sum: T) -> T {
        let above = self.sums.partition_point(|knot| *knot <= sum);
        let last = self.sums.len().saturating_sub(2);
        let piece = above.saturating_sub(1).min(last);
        self.slopes().nth(piece).unwrap_or(T::ONE)
    }

    /// The slope of each piece.
    fn slopes(&self) -> impl Iterator<Item = T> {
        let pieces = self.sums.windows(2).zip(self.outputs.windows(2));
        pieces.map(|(x, y)| (y[1] - y[0]) / (x[1] - x[0]))
    }
}

impl<'a, T: Real> Constants<'a, T> for Curve<'a, T> {
    const DECLARED: &'static [Declared] = &[Declared {
        name: "curve",
        about: "the output is a monotone curve over the operators' sum",
        constants: &[
            Constant {
                name: "curve_sums",
                unit: Unit::Output,
                range: Range::Size,
                meaning: "the operators' sum at each of two or more knots, ascending",
            },
            Constant {
                name: "curve_outputs",
                unit: Unit::Output,
                range: Range::Size,
                meaning: "the output of the curve at each knot, ascending",
            },
        ],
    }];

    fn lists(&self) -> impl Iterator<Item = &[T]> {
        [self.sums, self.outputs].into_iter()
    }

    fn of_lists(mut next: impl FnMut() -> &'a [T]) -> Option<Self> {
        let (sums, outputs) = (next(), next());
        Some(Self { sums, outputs })
    }

    fn fits(&self) -> Result<(), &'static str> {
        let count = self.sums.len();
        // Each piece is divided by both of its lengths.
        let ascends = |list: &[T]| {
            let rises = |pair: &[T]| {
                let size = pair[0].max(-pair[0]).max(pair[1].max(-pair[1]));
                pair[1] - pair[0] > size * T::EPSILON * T::from_index(4)
            };
            list.windows(2).all(rises)
        };
        let slopes = self.slopes().all(|slope| Range::Factor.has(slope));
        if count == 1 || count != self.outputs.len() || !ascends(self.sums) {
            return Err("curve_sums");
        }
        match ascends(self.outputs) && slopes {
            true => Ok(()),
            false => Err("curve_outputs"),
        }
    }
}

impl<T: Real> Stage<T> for Curve<'_, T> {
    type Memory = Memory<T>;
    type Factors = Factors<T>;

    fn is_there(&self) -> bool {
        !self.sums.is_empty()
    }

    fn is_timed(&self) -> bool {
        false
    }

    fn factors(&self, _: T) -> Factors<T> {
        []
    }

    fn rest(&self, _: T) -> Memory<T> {
        []
    }

    fn forward(&self, _: &mut Memory<T>, _: &Factors<T>, sum: T) -> T {
        self.settled(sum)
    }

    fn inverse(&self, _: &Memory<T>, _: &Factors<T>, output: T) -> T {
        between(self.outputs, |k| self.sums[k], output)
    }

    fn settled(&self, sum: T) -> T {
        self.at(sum)
    }

    fn steepest(&self, _: &Factors<T>) -> T {
        self.slopes().fold(T::ZERO, Real::max)
    }

    fn slope(&self, _: &Factors<T>, sum: T) -> T {
        self.slope_at(sum)
    }

    fn size(&self) -> T {
        let most = |list: &[T]| {
            let each = list.iter().map(|number| number.max(-*number));
            each.fold(T::ZERO, Real::max)
        };
        most(self.outputs) + self.steepest(&[]) * most(self.sums)
    }
}

//! A run of a [`Watch`](super::Watch): a stretch over which one channel stays within a band, and
//! what the other one does meanwhile.

use crate::scalar::Real;

/// A channel follows the other one where that explains one part in so many of its variance.
const FOLLOWS: usize = 3;
/// Of so many more readings the variance has to be explained: chance explains some of a few.
const CHANCE: usize = 4;
/// The channel may have moved in the band before it froze, while the other one travelled its span
/// divided by this. What they did there is not compared.
const BEFORE: usize = 4;
/// Rounding of a sum over a run, in units of the last place, at most.
const ROUNDING: usize = 1024;

/// A stretch over which one channel stayed within a band. All is counted from its first reading. A
/// reading is the channel that moves, the one that may be still, and the input's position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Run<T> {
    pub(super) spans: [Span<T>; 3],
    /// How far the moving channel travelled.
    pub(super) travel: T,
    pub(super) readings: u32,
    first: [T; 2],
    last: [T; 3],
    /// Sums, but for a count, over the way of the moving channel: of 1, of both channels, of their
    /// squares and of their product. So a rest does not weigh more than a move.
    way: T,
    count: T,
    sums: [T; 2],
    squares: [T; 2],
    product: T,
}

impl<T: Real> Run<T> {
    pub(super) fn begin(reading: [T; 3]) -> Self {
        Self {
            spans: reading.map(Span::at),
            travel: T::ZERO,
            readings: 1,
            first: [reading[0], reading[1]],
            last: reading,
            way: T::ZERO,
            count: T::ZERO,
            sums: [T::ZERO; 2],
            squares: [T::ZERO; 2],
            product: T::ZERO,
        }
    }

    /// Takes a reading, to which the moving channel `travel`led. `span` is its span lately.
    pub(super) fn take(&mut self, reading: [T; 3], travel: T, span: T) {
        for (span, at) in self.spans.iter_mut().zip(reading) {
            span.take(at);
        }
        self.travel = self.travel + travel;
        self.readings = self.readings.saturating_add(1);
        let before = core::mem::replace(&mut self.last, reading);
        if T::from_index(BEFORE) * self.travel < span {
            self.first = [reading[0], reading[1]];
            return;
        }
        let step = reading[0] - before[0];
        let step = step.max(-step);
        let [x, y] = [0, 1].map(|n| reading[n] - self.first[n]);
        self.way = self.way + step;
        self.count = self.count + T::ONE;
        self.sums = [self.sums[0] + step * x, self.sums[1] + step * y];
        self.squares = [
            self.squares[0] + step * x * x,
            self.squares[1] + step * y * y,
        ];
        self.product = self.product + step * x * y;
    }

    /// The last reading.
    pub(super) fn last(&self) -> [T; 3] {
        self.last
    }

    /// Whether the one channel follows the other: their correlation is positive, and its square at
    /// least a third, more with few readings. A channel that keeps its value but for rounding
    /// follows nothing.
    pub(super) fn follows(&self) -> bool {
        let [x, y] = self.sums;
        let product = self.way * self.product - x * y;
        let [moving, still] = [0, 1].map(|n| {
            let sum = self.sums[n];
            self.way * self.squares[n] - sum * sum
        });
        let rounding = T::from_index(ROUNDING) * T::EPSILON * self.way * self.squares[1];
        let least = self.count / T::from_index(FOLLOWS) + T::from_index(CHANCE);
        still > rounding
            && product > T::ZERO
            && product * product * self.count >= moving * still * least
    }
}

/// The span of a channel over its way lately: that of the present stretch and of the one before.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Lately<T> {
    spans: [Span<T>; 2],
    travel: T,
}

impl<T: Real> Lately<T> {
    pub(super) fn begin(at: T) -> Self {
        Self {
            spans: [Span::at(at); 2],
            travel: T::ZERO,
        }
    }

    /// Takes a reading. A stretch ends after the way `long`.
    pub(super) fn take(&mut self, at: T, travel: T, long: T) {
        self.spans[0].take(at);
        self.travel = self.travel + travel;
        if self.travel >= long {
            self.spans = [Span::at(at), self.spans[0]];
            self.travel = T::ZERO;
        }
    }

    pub(super) fn size(&self) -> T {
        let [mut both, before] = self.spans;
        both.take(before.low);
        both.take(before.high);
        both.size()
    }
}

/// The lowest and the highest of some readings.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Span<T> {
    low: T,
    high: T,
}

impl<T: Real> Span<T> {
    pub(super) fn at(at: T) -> Self {
        Self { low: at, high: at }
    }

    pub(super) fn take(&mut self, at: T) {
        self.low = self.low.min(at);
        self.high = self.high.max(at);
    }

    pub(super) fn size(&self) -> T {
        self.high - self.low
    }
}

//! Where a series turns, small wiggles apart.

use crate::Direction;

/// Finds the turning points of a series as it comes: an extreme counts once the series has gone back
/// from it by more than `band`.
///
/// ```
/// use hysteron::{Direction, Turning};
/// let mut turning = Turning::new(0.5);
/// let series = [0.0, 1.0, 0.9, 2.0, 1.9, 0.0];
/// let found: Vec<_> = series.iter().filter_map(|&y| turning.push(y)).collect();
/// assert_eq!(found, [(0, Direction::Rising), (3, Direction::Falling)]);
/// ```
#[derive(Debug, Clone)]
pub struct Turning {
    band: f64,
    count: usize,
    low: (usize, f64),
    high: (usize, f64),
    heading: Option<Direction>,
}

impl Turning {
    /// A search that ignores reversals of up to `band`.
    #[must_use]
    pub fn new(band: f64) -> Self {
        Self {
            band,
            count: 0,
            low: (0, f64::INFINITY),
            high: (0, f64::NEG_INFINITY),
            heading: None,
        }
    }

    /// Takes the next sample. Returns an extreme that is now known, by its index, with the direction
    /// the series takes from there; the start counts as one.
    pub fn push(&mut self, y: f64) -> Option<(usize, Direction)> {
        let n = self.count;
        self.count += 1;
        if y < self.low.1 {
            self.low = (n, y);
        }
        if y > self.high.1 {
            self.high = (n, y);
        }
        if self.heading != Some(Direction::Falling) && self.high.1 - y > self.band {
            let turn = self.high.0;
            let first = self.heading.is_none();
            self.heading = Some(Direction::Falling);
            self.low = (n, y);
            return Some((if first { 0 } else { turn }, Direction::Falling));
        }
        if self.heading != Some(Direction::Rising) && y - self.low.1 > self.band {
            let turn = self.low.0;
            let first = self.heading.is_none();
            self.heading = Some(Direction::Rising);
            self.high = (n, y);
            return Some((if first { 0 } else { turn }, Direction::Rising));
        }
        None
    }
}

/// The direction that each sample's series takes next: from an extreme on, but not at it, that of the branch after it.
///
/// `None` throughout where the series never moves by more than `band`.
#[must_use]
pub fn headings(series: &[f64], band: f64) -> Vec<Option<Direction>> {
    let mut turning = Turning::new(band);
    let mut result: Vec<Option<Direction>> = vec![None; series.len()];
    let mut turns: Vec<(usize, Direction)> =
        series.iter().filter_map(|&y| turning.push(y)).collect();
    turns.push((series.len(), Direction::Rising)); // the end; its direction is not used
    for pair in turns.windows(2) {
        let (start, heading) = pair[0];
        let first = if start == 0 { 0 } else { start + 1 };
        let last = (pair[1].0 + 1).min(series.len());
        result[first..last].fill(Some(heading));
    }
    result
}

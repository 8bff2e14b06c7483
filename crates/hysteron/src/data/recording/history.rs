//! The order of rows is history: it is never changed. Where the clock says that rows are no
//! continuation of those before them, another segment begins.

use super::columns::TIME;
use crate::recording::long_gaps;
use crate::series::lost::{STEP, step_near};

/// So many rows with the times and values of earlier ones are those rows, whatever follows.
const COPIED: usize = 2;

/// What the clock tells of rows, by their index.
#[derive(Debug, Default, PartialEq)]
pub(super) struct History {
    /// Rows to keep, in the order of the file.
    pub(super) kept: Vec<usize>,
    /// Rows that go back in time, with which a segment begins.
    pub(super) back: Vec<usize>,
    /// Rows that stand before in the same segment, with the same time and values.
    pub(super) copies: Vec<usize>,
    /// Rows whose time fits neither the row before nor the one after, which fit each other.
    pub(super) alone: Vec<usize>,
    /// Rows that are kept, at the time of the row before.
    pub(super) repeated: Vec<usize>,
}

impl History {
    pub(super) fn new(series: &[Vec<f64>]) -> Self {
        let time = &series[TIME];
        let mut history = Self::default();
        let Self {
            kept,
            back,
            copies,
            alone,
            repeated,
        } = &mut history;
        let same = |a: usize, b: usize| series.iter().all(|values| values[a] == values[b]);
        let (mut begin, mut n) = (0, 0);
        while n < time.len() {
            let before = &kept[begin..];
            let last = before.last().copied();
            let Some(last) = last.filter(|&last| time[n] <= time[last]) else {
                kept.push(n);
                n += 1;
                continue;
            };
            // Rows once more, from somewhere before.
            let from = before.partition_point(|&row| time[row] < time[n]);
            let pairs = before[from..].iter().zip(n..time.len());
            let count = pairs.take_while(|&(&row, n)| same(row, n)).count();
            let goes_on = time.get(n + count).is_none_or(|next| *next >= time[last]);
            if same(last, n) {
                copies.push(n);
                n += 1;
            } else if count >= COPIED || (count > 0 && goes_on) {
                copies.extend(n..n + count);
                n += count;
            } else if time[n] == time[last] {
                repeated.push(n);
                kept.push(n);
                n += 1;
            } else if time.get(n + 1).is_some_and(|next| *next >= time[last]) {
                alone.push(n);
                n += 1;
            } else if before.len() > 1 && time[n] >= time[before[before.len() - 2]] {
                alone.extend(kept.pop());
            } else {
                begin = kept.len();
                back.push(n);
                kept.push(n);
                n += 1;
            }
        }
        history
    }
}

/// Whether the series go on at row `n` as they do nearby, whatever its time is: the clock was set.
pub(super) fn goes_on(series: &[Vec<f64>], n: usize) -> bool {
    let goes_on =
        |values: &Vec<f64>| (values[n] - values[n - 1]).abs() <= STEP * step_near(values, &(n..n));
    let mut each = series.iter().enumerate();
    each.all(|(s, values)| s == TIME || goes_on(values))
}

/// The indices at which segments begin, in rows that were kept: those that go `back`, and those
/// after a long gap, which are added to `gaps`.
pub(super) fn starts(series: &[Vec<f64>], back: Vec<usize>, gaps: &mut Vec<usize>) -> Vec<usize> {
    let time = &series[TIME];
    let ends = back.iter().copied().chain([time.len()]);
    let mut begin = 0;
    for end in ends {
        let found = long_gaps(&time[begin..end], &series[0][begin..end]);
        gaps.extend(found.into_iter().map(|n| begin + n));
        begin = end;
    }
    let mut starts = back;
    starts.extend(gaps.iter());
    starts.sort_unstable();
    starts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(time: &[f64], value: &[f64]) -> History {
        let series = [value, value, time].map(<[f64]>::to_vec);
        History::new(&series)
    }

    #[test]
    fn a_clock_that_goes_back_begins_a_segment() {
        let found = of(
            &[0.0, 1.0, 2.0, 3.0, 1.5, 2.5],
            &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
        );
        assert_eq!((&found.back[..], found.kept.len()), (&[4][..], 6));
        // Rows written twice are no other segment; nor is one whose own time is wrong.
        let time = [0.0, 1.0, 2.0, 3.0, 2.0, 3.0, 4.0];
        let found = of(&time, &[1.0, 2.0, 3.0, 4.0, 3.0, 4.0, 5.0]);
        assert_eq!(
            (found.copies, found.kept),
            (vec![4, 5], vec![0, 1, 2, 3, 6])
        );
        // A block from before, at its old times; then the recording goes on.
        let time = [0.0, 1.0, 2.0, 3.0, 4.0, 1.0, 2.0, 5.0];
        let found = of(&time, &[1.0, 2.0, 3.0, 4.0, 5.0, 2.0, 3.0, 6.0]);
        assert_eq!((found.copies, found.back.len()), (vec![5, 6], 0));
        for wrong in [-50.0, 50.0] {
            let found = of(&[0.0, 1.0, wrong, 3.0, 4.0], &[1.0, 2.0, 3.0, 4.0, 5.0]);
            assert_eq!((found.alone, found.back.len()), (vec![2], 0), "{wrong}");
        }
        let found = of(&[0.0, 1.0, 1.0, 1.0], &[1.0, 2.0, 3.0, 3.0]);
        assert_eq!((found.repeated, found.copies), (vec![2], vec![3]));
    }

    #[test]
    fn series_go_on_where_a_clock_was_set() {
        let time = [0.0, 1.0, 2.0, 3.0, 0.5, 1.5, 2.5];
        let on = vec![1.0, 2.0, 3.5, 5.0, 6.0, 8.0, 9.0];
        let anew = vec![1.0, 2.0, 3.5, 5.0, 1.0, 2.0, 3.5];
        let rest = vec![4.0; 7];
        let of = |input: &Vec<f64>, output: &Vec<f64>| {
            goes_on(&[input.clone(), output.clone(), time.to_vec()], 4)
        };
        assert!(of(&on, &on) && of(&on, &rest));
        assert!(!of(&anew, &on) && !of(&on, &anew));
    }
}

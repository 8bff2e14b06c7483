//! Runs of samples, and where they lie in time.

use std::ops::Range;

/// The stretches of samples that do not move.
pub(crate) fn stretches(moving: &[bool]) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut start = None;
    for (k, &moves) in moving.iter().enumerate() {
        match (moves, start) {
            (false, None) => start = Some(k),
            (true, Some(begin)) => {
                found.push(begin..k);
                start = None;
            }
            _ => {}
        }
    }
    found.extend(start.map(|begin| begin..moving.len()));
    found
}

/// Where in time a stretch of samples begins and ends: halfway to its neighbours, so that one
/// sample has a width.
pub(crate) fn extent(time: &[f64], stretch: &Range<usize>) -> [f64; 2] {
    let between = |before: Option<usize>, after: usize| {
        let after = time.get(after).or(time.last()).copied().unwrap_or(0.0);
        before
            .and_then(|k| time.get(k))
            .map_or(after, |before| 0.5 * (before + after))
    };
    [
        between(stretch.start.checked_sub(1), stretch.start),
        between(stretch.end.checked_sub(1), stretch.end),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_reach_both_ends() {
        assert_eq!(stretches(&[false, false, true, false]), [0..2, 3..4]);
        assert!(stretches(&[true, true]).is_empty());
        assert!(stretches(&[]).is_empty());
    }
}

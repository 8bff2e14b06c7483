//! Stretches of a recording in which the output stands still while the input travels.

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

/// A dead band and the sample in it where modelled and measured input are farthest apart.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Worst {
    pub(crate) stretch: Range<usize>,
    pub(crate) sample: usize,
}

/// The dead band that holds the largest `|modelled − measured|`; `None` where nothing stands still.
pub(crate) fn worst(moving: &[bool], modelled: &[f64], measured: &[f64]) -> Option<Worst> {
    let error = |k: usize| {
        Some((modelled.get(k)? - measured.get(k)?).abs()).filter(|error| error.is_finite())
    };
    stretches(moving)
        .into_iter()
        .flat_map(|stretch| {
            stretch.clone().map(move |sample| Worst {
                stretch: stretch.clone(),
                sample,
            })
        })
        .filter_map(|candidate| Some((error(candidate.sample)?, candidate)))
        // The first of equals, so that the choice does not depend on how a constant stretch ends.
        .fold(None, |best: Option<(f64, Worst)>, next| match best {
            Some(best) if best.0 >= next.0 => Some(best),
            _ => Some(next),
        })
        .map(|(_, worst)| worst)
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

    #[test]
    fn worst_ignores_larger_errors_where_the_output_moves() {
        let moving = [true, false, false, true, false, true];
        let modelled = [9.0, 1.0, 2.0, 9.0, -4.0, 9.0];
        let worst = worst(&moving, &modelled, &[0.0; 6]);
        assert_eq!(
            worst,
            Some(Worst {
                stretch: 4..5,
                sample: 4
            })
        );
    }

    #[test]
    fn worst_skips_values_that_are_not_numbers() {
        let worst = worst(&[false, false], &[f64::NAN, 1.0], &[0.0; 2]);
        assert_eq!(
            worst,
            Some(Worst {
                stretch: 0..2,
                sample: 1
            })
        );
        assert_eq!(super::worst(&[true], &[1.0], &[0.0]), None);
    }
}

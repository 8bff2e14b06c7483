//! The dead band that holds the largest error.

use crate::draw::stretches::stretches;
use std::ops::Range;

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

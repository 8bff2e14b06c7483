//! Which part of an error is in readings that are wrong.

use super::cause::{Cause, WORTH};
use crate::prepare::mended::replaced;
use crate::recording::Recording;

/// Readings that stand out or were held, if a good part of the squared error is in them.
pub(super) fn cause(recordings: &[Recording], modelled: &[f64]) -> Option<Cause> {
    let samples: usize = recordings.iter().map(Recording::len).sum();
    if modelled.len() != samples {
        return None;
    }
    let (mut total, mut first) = (0.0, 0);
    let (mut within, mut all) = (0.0, Vec::new());
    for recording in recordings {
        let modelled = &modelled[first..first + recording.len()];
        let squared = |n: usize| (recording.output[n] - modelled[n]).powi(2);
        total += (0..recording.len()).map(squared).sum::<f64>();
        let wrong = in_either(recording.wrong_readings());
        within += wrong.iter().map(|n| squared(*n)).sum::<f64>();
        all.push(wrong);
        first += recording.len();
    }
    let share = within / total;
    (share >= WORTH).then(|| Cause::Readings {
        share,
        samples: all.iter().map(Vec::len).sum(),
        replaced: std::iter::zip(recordings, &all)
            .map(|(recording, wrong)| count_replaced(recording, wrong))
            .sum(),
    })
}

/// The samples that are in either list.
fn in_either(lists: [Vec<usize>; 2]) -> Vec<usize> {
    let mut samples = lists.concat();
    samples.sort_unstable();
    samples.dedup();
    samples
}

/// How many of the wrong samples of a recording the preparation would replace.
fn count_replaced(recording: &Recording, wrong: &[usize]) -> usize {
    let replaced = in_either(replaced(recording));
    let is_wrong = |sample: &&usize| wrong.binary_search(sample).is_ok();
    replaced.iter().filter(is_wrong).count()
}

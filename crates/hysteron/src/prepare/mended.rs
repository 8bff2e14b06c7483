//! What the preparation would change if it were asked for: only that is advice.

use super::options::PrepareOptions;
use super::single::without_wrong;
use crate::progress::Progress;
use crate::recording::Recording;

/// The samples whose input it would replace, and those whose output, ascending.
pub(crate) fn replaced(recording: &Recording) -> [Vec<usize>; 2] {
    let mended = without_wrong(recording);
    let changed = |read: &[f64], mended: &[f64]| {
        let pairs = read.iter().zip(mended).enumerate();
        let changed = pairs.filter(|(_, (read, mended))| read != mended);
        changed.map(|(n, _)| n).collect()
    };
    [
        changed(&recording.input, &mended.input),
        changed(&recording.output, &mended.output),
    ]
}

/// Whether it would remove false reversals of the input.
pub(crate) fn settles(recording: &Recording) -> bool {
    let options = PrepareOptions {
        believe: true,
        ..PrepareOptions::default()
    };
    super::prepare(recording, &options, Progress::NONE).is_ok_and(|(_, report)| {
        let filter = report.low_pass.and_then(|filter| filter.input);
        let band = report.dead_band.map_or(0, |band| band.false_reversals);
        filter.is_some() || band > 0
    })
}

//! Widens the band to what changes between sessions: other recordings of the same actuator.

use crate::error::Result;
use crate::identify::doubt::calibrate::{missing, quantile};
use crate::identify::doubt::change::change;
use crate::identify::history::find_start;
use crate::model::{INTERVAL, Model, SeenFile, Surroundings};
use crate::recording::Recording;
use crate::series::{branch_spans, usual_tolerance};

/// Tells how much the `repeats` changed, and widens the band of a model with confidence so that it
/// holds 95 % of their samples, too. Weights and offset stay as they are. The start of each repeat
/// is estimated from its beginning.
///
/// # Errors
/// As [`crate::evaluate_from`].
pub(crate) fn widen(model: &mut Model, repeats: &[Recording]) -> Result<()> {
    let repeats = &*model.all_rested(repeats)?;
    if let Some(change) = change(model, repeats)?
        && let Some(fit) = &mut model.fit
    {
        fit.tell_change(change);
    }
    let Some(band) = model.band()? else {
        return Ok(());
    };
    let noise = confidence(model).map_or(0.0, |found| found.noise);
    let (mut values, mut units) = (Vec::new(), 0);
    for repeat in repeats {
        let (start, _) = find_start(model, repeat)?;
        let begin = model.restore(&start.turning_points, start.input)?;
        let around = Surroundings::from_recording(model, repeat);
        let (output, _) = model.run_over(&mut begin.clone(), repeat)?;
        let half = band.run(&begin, &model.seen(&repeat.input, around)?)?;
        let errors = repeat.output.iter().zip(&output).map(|(y, h)| y - h);
        values.extend(errors.zip(half).map(|(error, half)| {
            let of_weights = (half / INTERVAL).powi(2) - noise * noise;
            missing(error, of_weights)
        }));
        units += branch_spans(&repeat.input, usual_tolerance(&repeat.input)).count();
    }
    let needed = quantile(values, units).sqrt();
    if let Some(found) = confidence(model) {
        found.noise = found.noise.max(needed);
        found.sessions += repeats.len();
    }
    if let Some(fit) = &mut model.fit {
        fit.repeats
            .extend(repeats.iter().filter_map(SeenFile::from_recording));
    }
    Ok(())
}

fn confidence(model: &mut Model) -> Option<&mut crate::model::Confidence> {
    model.fit.as_mut().and_then(|fit| fit.confidence.as_mut())
}

//! Several models on the same recording, forward only.

use crate::error::Result;
use crate::evaluate::{begin, compare, over_all};
use crate::model::{FitSummary, Model, Start};
use crate::recording::Recording;
use crate::series::Errors;

/// A model that ran over the input of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Forward {
    /// Modelled output, one value per sample.
    pub output_model: Vec<f64>,
    /// Modelled against measured output.
    pub errors: Errors,
    /// Whether this is a recording that the model was fitted to. Then the errors say how well the
    /// model fits, not how well it predicts.
    pub was_fitted: bool,
    /// Whether this recording was not fitted, but widened the band.
    pub seen_for_band: bool,
}

/// Runs a model over the input of a recording, without the tests of its inverse that
/// [`crate::evaluate`] makes. The `start` is as for [`crate::evaluate_from`].
///
/// ```
/// use hysteron::{Fit, Recording, Start, forward};
/// let input: Vec<f64> = (0..200).map(|n| (1.0 - (f64::from(n) * 0.1).cos()) * 30.0).collect();
/// let recording = Recording::new(input.clone(), input.iter().map(|x| x * x).collect())?;
/// let error = |levels| -> hysteron::Result<f64> {
///     let model = Fit::new().levels(levels).bootstrap(0).run(&recording)?;
///     Ok(forward(&model, &recording, Start::Fitted)?.errors.rmse)
/// };
/// assert!(error(20)? < 0.2 * error(4)?);
/// # Ok::<(), hysteron::Error>(())
/// ```
///
/// Several recordings are parts of one experiment, and the model starts anew in each.
///
/// # Errors
/// As [`crate::evaluate_from`].
pub fn forward(
    model: &Model,
    recordings: &(impl AsRef<[Recording]> + ?Sized),
    start: Start,
) -> Result<Forward> {
    let recordings = recordings.as_ref();
    recordings.iter().try_for_each(|r| model.check_units(r))?;
    let (mut output_model, mut errors) = (Vec::new(), Vec::new());
    for recording in recordings {
        recording.check()?;
        let recording = &*model.delay().of_recording(recording);
        let recording = &*model.rested_from(start, recording)?;
        let (mut state, _) = begin(model, recording, start)?;
        let (output, _) = model.run_over(&mut state, recording)?;
        errors.push(compare(&recording.output, &output));
        output_model.extend(output);
    }
    let fit = model.fit.as_ref();
    let of_all = |seen: fn(&FitSummary, &Recording) -> bool| {
        fit.is_some_and(|fit| recordings.iter().all(|recording| seen(fit, recording)))
    };
    Ok(Forward {
        errors: over_all(errors, recordings)?,
        was_fitted: of_all(FitSummary::was_fitted_to),
        seen_for_band: of_all(FitSummary::was_seen_for_band),
        output_model,
    })
}

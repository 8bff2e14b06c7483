//! Several models on the same recording, forward only.

use crate::error::Result;
use crate::evaluate::{begin, compare};
use crate::model::{Model, Start};
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
/// # Errors
/// As [`crate::evaluate_from`].
pub fn forward(model: &Model, recording: &Recording, start: Start) -> Result<Forward> {
    recording.check()?;
    let (mut state, _) = begin(model, recording, start)?;
    let (output_model, _) = model.run_over(&mut state, recording)?;
    let fit = model.fit.as_ref();
    Ok(Forward {
        errors: compare(&recording.output, &output_model),
        was_fitted: fit.is_some_and(|fit| fit.was_fitted_to(recording)),
        seen_for_band: fit.is_some_and(|fit| fit.was_seen_for_band(recording)),
        output_model,
    })
}

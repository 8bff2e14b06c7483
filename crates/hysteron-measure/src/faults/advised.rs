//! What comes of a recording with the command that is advised: `fit --prepare`.

use hysteron::{Errors, Fit, PrepareOptions, Progress, Recording, Start, prepare};

/// The error on a second recording, in percent of its range; or why the first one was refused.
pub enum Came {
    /// The error.
    To(f64),
    /// Why it was refused.
    Refused(String),
}

/// Fits the recording with the command that is advised, and tests the model on the second one.
pub fn advised(
    first: &Recording,
    second: &Recording,
    fit: &Fit<'_>,
) -> Result<Came, hysteron::Error> {
    match prepare(first, &PrepareOptions::default(), Progress::NONE) {
        Ok((prepared, _)) => plain(&prepared, second, fit).map(Came::To),
        Err(refused) => Ok(Came::Refused(refused.to_string())),
    }
}

/// Fits the recording as it is.
pub fn plain(first: &Recording, second: &Recording, fit: &Fit<'_>) -> Result<f64, hysteron::Error> {
    let model = fit.run(first)?;
    let on = model.fit.as_ref().is_some_and(|fit| fit.start == Start::On);
    let mut state = if on { model.saturated() } else { model.start() };
    let mut output = vec![0.0; second.len()];
    model.run(&mut state, &second.input, &mut output)?;
    let errors = Errors::between(&second.output, &output, |_| true);
    Ok(errors
        .and_then(|errors| errors.nrmse_percent)
        .unwrap_or(f64::NAN))
}

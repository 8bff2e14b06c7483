//! What comes of a recording with the command that is advised: `fit --prepare`.

use super::fault::Fault;
use hysteron::{
    Dynamics, Fit, PrepareOptions, Progress, Recording, Start, evaluate_errors, prepare,
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// What a fault may do to the error.
const BOUND: f64 = 1.15;

/// The fit by which faults are compared.
pub fn fit() -> Fit<'static> {
    Fit::new().levels(20).smooth(1e-8).bootstrap(0)
}

/// The recording with a fault whose place and size the seed draws.
pub fn put(fault: Fault, clean: &Recording, seed: u64) -> Recording {
    fault.put_into(clean, &mut ChaCha8Rng::seed_from_u64(seed))
}

/// The largest error that is allowed, where the clean recording has `clean`. Noise stays, whatever
/// is done: with it a model errs no more than without preparation, and what comes on top of the
/// noise is mended. It may hide a lag or a ring, so the model beside it has none.
pub fn allowed(
    fault: Fault,
    [first, second]: &[Recording; 2],
    clean: f64,
    seed: u64,
) -> Result<f64, hysteron::Error> {
    let bare = match fault {
        Fault::Everything => put(Fault::Noise, first, seed),
        _ if fault.is_noisy() => put(fault, first, seed),
        _ => return Ok(BOUND * clean),
    };
    let fit = fit().dynamics(Dynamics::Off);
    Ok(BOUND * plain(&bare, second, &fit)?.max(clean))
}

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
    let found = evaluate_errors(&fit.run(first)?, second, Start::Fitted)?;
    Ok(found.forward.nrmse_percent.unwrap_or(f64::NAN))
}

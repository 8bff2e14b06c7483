//! A profile of drives for an actuator whose body heats: its temperature follows the ramps.

use super::{Design, DesignOptions, Rates, design};
use crate::error::{Error, Result};
use crate::model::{FirstOrder, Model};

/// Ends of what the drives can hold that the profile keeps away from, as a share of it. Near the end
/// a body comes ever more slowly, so less would take longer, and more would leave operators out.
const MARGIN: f64 = 0.05;

/// The experiment of which a model like `model`, with a thermal body and so many `levels`, can be
/// identified anew: the profile of [`design`] in temperatures, as the drives that make the body
/// follow it. Temperatures are within the model's range and 5 % inside of what the drives of `range`
/// can hold; the rates are those that these drives can give everywhere, or slower ones that are
/// given. No drive leaves `range`, by default that of the drives fitted. The first one holds the
/// first temperature: begin at rest there. [`Design::legs`] and [`Design::plane`] are in
/// temperatures. Heat that the operators bind ([`Model::latent`]) is left out of the plan.
///
/// ```
/// use hysteron::{FirstOrder, Model, Operator, Plane, Sign, design_heated};
/// let plane = Plane::new(20.0, 80.0, 10)?;
/// let body = FirstOrder { ambient: 15.0, gain: 1.0, tau_heating: 4.0, tau_cooling: 9.0 };
/// let mut model = Model::new(Operator::Mkp, plane, vec![0.1; 55], 0.0, Sign::Positive)?;
/// model.thermal = Some(body);
/// let found = design_heated(&model, Some((0.0, 80.0)), 10, None, (None, None))?;
/// assert!(found.input.iter().all(|drive| (0.0..=80.0).contains(drive)));
/// let temperature = body.respond(&found.time, &found.input)?;
/// assert!(temperature.iter().all(|degrees| (19.0 - 1e-9..=80.0 + 1e-9).contains(degrees)));
/// # Ok::<(), hysteron::Error>(())
/// ```
///
/// `(budget_s, step_s)` are those of [`DesignOptions`].
///
/// # Errors
/// [`Error::Design`] for a model without a body, a range in which nothing moves, and rates that its
/// drives cannot give; otherwise as [`design`].
pub fn design_heated(
    model: &Model,
    range: Option<(f64, f64)>,
    levels: usize,
    rates: Option<Rates>,
    (budget_s, step_s): (Option<f64>, Option<f64>),
) -> Result<Design> {
    let body = model.thermal.ok_or_else(|| {
        Error::Design("this model has no thermal body: give a range and rates in its place".into())
    })?;
    let drives = range.unwrap_or_else(|| model.drive_range());
    let reached = (body.rest(drives.0), body.rest(drives.1));
    let margin = MARGIN * (reached.1 - reached.0);
    let (bottom, top) = model.active_range();
    let (low, high) = (
        (reached.0 + margin).max(bottom),
        (reached.1 - margin).min(top),
    );
    if low >= high || !(low.is_finite() && high.is_finite()) {
        return Err(Error::Design(format!(
            "drives from {} to {} hold temperatures from {} to {}, which move no operator of the \
             model ({bottom} to {top})",
            drives.0, drives.1, reached.0, reached.1
        )));
    }
    let fastest = Rates {
        heating: (reached.1 - high) / body.tau_heating,
        cooling: (low - reached.0) / body.tau_cooling,
    };
    let rates = rates.unwrap_or(fastest);
    if rates.heating > fastest.heating || rates.cooling > fastest.cooling {
        return Err(Error::Design(format!(
            "these drives heat the body by {:.4} and let it cool by {:.4} per second everywhere: \
             take slower rates, or leave them out",
            fastest.heating, fastest.cooling
        )));
    }
    let options = DesignOptions {
        operator: model.operator(),
        budget_s,
        step_s,
        ..DesignOptions::within((low, high), levels, rates)?
    };
    let mut found = design(&options, &[])?;
    found.input = drives_of(body, &found.time, &found.input, drives);
    Ok(found)
}

/// The drives with which the body follows these temperatures from rest, each held since the sample
/// before. What is outside of `drives` is so by a rounding.
fn drives_of(body: FirstOrder, time: &[f64], wanted: &[f64], drives: (f64, f64)) -> Vec<f64> {
    let body = body.core();
    let within = |drive: f64| drive.clamp(drives.0, drives.1);
    let steps = time.windows(2).zip(wanted.windows(2));
    let steps = steps.map(|(time, wanted)| {
        let decay = body.decay(time[1] - time[0]);
        within(body.drive(wanted[0], wanted[1], decay))
    });
    let first = wanted.first().map(|degrees| within(body.hold(*degrees)));
    first.into_iter().chain(steps).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::model::{Excitation, Sign};
    use hysteron_core::{Operator, Plane};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// The body follows the ramps from turning point to turning point, and every operator moves.
    #[test]
    fn the_body_of_any_model_follows_the_plan_within_the_drives() {
        for seed in 0..200 {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let body = FirstOrder {
                ambient: rng.random_range(-20.0..30.0),
                gain: rng.random_range(0.1..20.0),
                tau_heating: rng.random_range(0.01..100.0),
                tau_cooling: rng.random_range(0.01..100.0),
            };
            let low = body.ambient + rng.random_range(-5.0..40.0);
            let plane = Plane::new(low, low + rng.random_range(10.0..80.0), 6).unwrap();
            let model = Model::new(Operator::Mkp, plane, vec![0.1; 21], 0.0, Sign::Negative);
            let mut model = model.unwrap();
            model.thermal = Some(body);
            let most = rng.random_range(20.0..120.0) / body.gain;
            let levels = rng.random_range(4..10);
            let range = Some((0.0, most));
            let Ok(found) = design_heated(&model, range, levels, None, (None, None)) else {
                // The drives do not reach the plane.
                assert!(
                    body.rest(most) * 0.95 < plane.bottom() + body.ambient.abs(),
                    "{seed}"
                );
                continue;
            };
            assert!(
                found.input.iter().all(|u| (0.0..=most).contains(u)),
                "{seed}"
            );
            assert_eq!(found.count(Excitation::Determined), found.plane.operators());
            let temperature = body.respond(&found.time, &found.input).unwrap();
            let ends = found.legs.iter().map(|leg| leg.to);
            for end in ends {
                let near = |degrees: &&f64| (*degrees - end).abs() < 1e-6 * (1.0 + end.abs());
                assert!(
                    temperature.iter().any(|degrees| near(&degrees)),
                    "{seed}: {end}"
                );
            }
        }
    }
}

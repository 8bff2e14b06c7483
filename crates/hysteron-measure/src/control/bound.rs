//! A loop that knows the plant, on the same course as the controllers.

use crate::result::Result;
use hysteron::control::SimulatedPlant;
use hysteron_sim::plant::{BoucWenPlant, LatentWirePlant};
use hysteron_sim::track::{PlantOptions, Scenario, Window, course};

/// Halvings of the range of the drive.
const HALVINGS: usize = 40;

/// The errors of the drive that brings the true plant, in its true state, to the reference as soon
/// as a drive can. None for plants that take long to copy or to step.
pub(super) fn bound(scenario: &Scenario, windows: &[Window]) -> Result<Option<Vec<f64>>> {
    Ok(Some(match &scenario.plant {
        PlantOptions::LatentWire(options) => {
            known(LatentWirePlant::new(options)?, scenario, windows)?
        }
        PlantOptions::BoucWen(options) => known(BoucWenPlant::new(options)?, scenario, windows)?,
        _ => return Ok(None),
    }))
}

fn known<P: SimulatedPlant + Clone>(
    mut plant: P,
    scenario: &Scenario,
    windows: &[Window],
) -> Result<Vec<f64>> {
    for &(time_s, drive) in &scenario.before {
        plant.write(drive);
        plant.advance(time_s);
    }
    let (dt_s, references) = (scenario.interval_s, scenario.references());
    let due = scenario.shared.delay.unwrap_or(1);
    let mut events = course(&scenario.disturbance, dt_s).into_iter().peekable();
    let mut errors = Vec::new();
    for (n, reference) in references.iter().enumerate() {
        while let Some((_, event)) = events.next_if(|(at, _)| *at <= n) {
            plant.disturb(event)?;
        }
        errors.push(plant.truth().output - reference);
        let target = references[(n + due).min(references.len() - 1)];
        plant.write(drive(&plant, scenario.plant.drives(), target, due, dt_s));
        plant.advance(dt_s);
    }
    let rms = |window: &Window| {
        let place = |time_s: f64| (time_s / dt_s).round() as usize;
        let inside = &errors[place(window.from_s)..place(window.to_s).min(errors.len())];
        (inside.iter().map(|e| e * e).sum::<f64>() / inside.len() as f64).sqrt()
    };
    Ok(windows.iter().map(rms).collect())
}

/// The drive after which the output is `target` in `due` samples.
fn drive<P: SimulatedPlant + Clone>(
    plant: &P,
    (mut low, mut high): (f64, f64),
    target: f64,
    due: usize,
    dt_s: f64,
) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        let mut plant = plant.clone();
        plant.write(middle);
        (0..due).for_each(|_| plant.advance(dt_s));
        match plant.truth().output < target {
            true => low = middle,
            false => high = middle,
        }
    }
    high
}

//! The plants whose physics no model here shares, under control.

use hysteron::control::{
    Compensator, Controller, Device, Reading, Reference, Scheme, SimulatedPlant,
};
use hysteron::{AdaptOptions, Fit, FitOptions, Model, Progress, Recording};
use hysteron_sim::plant::{BoucWenPlant, BoucWenPlantOptions};
use hysteron_sim::track::{Comparison, Kind, Scenario, Tuning, track};

/// The mean over the runs.
fn rmse(found: &Comparison, kind: Kind, window: &str) -> f64 {
    let w = found.windows.iter().position(|w| w.name == window).unwrap();
    let k = found.controllers.iter().position(|k| *k == kind).unwrap();
    let runs = found.scores[k].iter().map(|run| run[w].rmse);
    runs.sum::<f64>() / found.scores[k].len() as f64
}

#[test]
fn what_learns_makes_up_for_changes_of_a_wire_that_binds_heat() {
    let mut scenario = Scenario::load("latent-wire").unwrap();
    scenario.seeds = 1;
    scenario.controllers = vec![Kind::InverseAnticipate, Kind::AdaptiveAnticipate];
    let found = track(&scenario, Progress::NONE).unwrap();
    let changes = ["room 26 degC", "load 3.4 N", "gain 0.92"];
    let changes = changes.map(|change| format!("after {change}, settled"));
    for window in changes.iter().map(String::as_str).chain(["before"]) {
        let [fixed, adaptive] = [Kind::InverseAnticipate, Kind::AdaptiveAnticipate]
            .map(|kind| rmse(&found, kind, window));
        println!("{window}: {fixed:.3} {adaptive:.3} mm");
        assert!(adaptive < 0.5 * fixed, "{window}: {fixed} {adaptive}");
    }
    let windows: Vec<&str> = found.windows.iter().map(|w| w.name.as_str()).collect();
    assert_eq!(windows[0], "unknown start");
    // A window with a name of its own is taken whole.
    assert_eq!(
        windows[windows.len() - 2..],
        ["out of reach", "in reach again"]
    );
}

/// The feedback has made up for a change by the time the model has learned it. An inverse that then
/// turned round by itself, while the reference went on, cost 1.5 times the error of the fixed one.
#[test]
fn what_learns_beside_a_feedback_does_no_harm_to_it() {
    let mut scenario = Scenario::load("latent-wire").unwrap();
    (scenario.seeds, scenario.duration_s) = (3, 360.0);
    scenario.disturbance.retain(|change| change.at_s < 300.0);
    scenario.controllers = vec![Kind::InversePidAnticipate, Kind::AdaptivePidAnticipate];
    for tuning in [Tuning::Relay, Tuning::Model] {
        scenario.shared.tuning = tuning;
        let found = track(&scenario, Progress::NONE).unwrap();
        let mut product = 1.0;
        for change in ["room 26 degC", "load 3.4 N", "gain 0.92"] {
            let window = format!("after {change}, settled");
            let [fixed, adaptive] = [Kind::InversePidAnticipate, Kind::AdaptivePidAnticipate]
                .map(|kind| rmse(&found, kind, &window));
            println!("{tuning:?}, {window}: {fixed:.4} {adaptive:.4} mm");
            product *= adaptive / fixed;
        }
        // 0.3 and 0.7; before, 0.7 and 1.7.
        assert!(product < 1.0, "{tuning:?}: {product}");
    }
}

#[test]
fn what_learns_follows_a_hysteresis_that_is_no_sum_of_operators() {
    let mut scenario = Scenario::load("bouc-wen").unwrap();
    (scenario.seeds, scenario.duration_s) = (1, 3.0);
    scenario.disturbance.clear();
    scenario.controllers = vec![Kind::Pid, Kind::InverseAnticipate, Kind::AdaptiveAnticipate];
    let found = track(&scenario, Progress::NONE).unwrap();
    let errors = found.controllers.iter();
    let errors: Vec<f64> = errors
        .map(|kind| rmse(&found, *kind, "second half"))
        .collect();
    println!("{errors:.3?} um");
    assert!(
        errors[2] < 0.5 * errors[0] && errors[2] < 0.2 * errors[1],
        "{errors:?}"
    );
}

/// A stage that swings at an eighth of the sampling rate.
fn swinging(seed: u64) -> BoucWenPlant {
    let options = BoucWenPlantOptions {
        resonance_hz: 120.0,
        delay_s: 0.0,
        seed,
        ..BoucWenPlantOptions::default()
    };
    BoucWenPlant::new(&options).unwrap()
}

const STEP_S: f64 = 0.001;

/// A model of the stage, from strokes so slow that it does not swing.
fn slow_model() -> Model {
    let mut stage = swinging(1);
    let wave = |n: i32| {
        let turn = std::f64::consts::TAU * f64::from(n) / 1000.0;
        (1.0 - turn.cos()) * 50.0 * (1.0 - f64::from(n) / 6000.0)
    };
    let input: Vec<f64> = (0..6000).map(wave).collect();
    let output = input.iter().map(|&drive| {
        stage.write(drive);
        stage.advance(STEP_S);
        stage.read().output
    });
    let recording = Recording::new(input.clone(), output.collect()).unwrap();
    let options = FitOptions {
        levels: 14,
        smooth: 1e-6.into(),
        ..FitOptions::plain()
    };
    Fit::from(options).run(&recording).unwrap()
}

/// RMS error after the first quarter, of strokes of 8 um that last so many samples.
fn followed(compensator: Compensator, period: f64, seed: u64) -> f64 {
    let scheme = Scheme {
        compensator: Some(compensator),
        ..Scheme::new(STEP_S, (0.0, 100.0))
    };
    let (mut controller, mut stage) = (Controller::new(scheme).unwrap(), swinging(seed));
    let (mut squares, samples) = (0.0, 2000);
    for n in 0..samples {
        let turn = std::f64::consts::TAU * f64::from(n) / period;
        let wanted = 6.0 - 4.0 * turn.cos() * (f64::from(n) / 100.0).min(1.0);
        let reading = Reading {
            output: stage.read().output,
            input: None,
        };
        let reference = Reference {
            output: wanted,
            heading: None,
        };
        let action = controller.step(reference, reading).unwrap();
        stage.write(action.drive);
        stage.advance(STEP_S);
        if n >= samples / 4 {
            squares += (stage.truth().output - wanted).powi(2);
        }
    }
    (squares / f64::from(samples)).sqrt()
}

/// The learner is never told of the resonance, nor the model. Simulated.
#[test]
fn what_learns_does_not_shake_a_stage_that_swings() {
    let model = slow_model();
    for (seed, period) in [(1, 200.0), (2, 150.0), (3, 400.0), (4, 1000.0)] {
        let learner = AdaptOptions::default().adaptive(&model).unwrap();
        let bare = Compensator::adaptive(learner);
        let shadowed = Compensator::shadowed(&model, bare.clone()).unwrap();
        let [fixed, bare, shadowed] = [Compensator::fixed(&model).unwrap(), bare, shadowed]
            .map(|compensator| followed(compensator, period, seed));
        println!("{period} samples: fixed {fixed:.3}, bare {bare:.3}, shadowed {shadowed:.3} um");
        let most = 1.05 * fixed;
        assert!(
            bare < most && shadowed < most,
            "{period}: {fixed} {bare} {shadowed}"
        );
    }
}

#[test]
fn a_scenario_says_what_was_before_it() {
    let text = Scenario::text("latent-wire").unwrap();
    let refused = |from: &str, to: &str| {
        let error = Scenario::parse(&text.replace(from, to), "".as_ref()).unwrap_err();
        error.to_string()
    };
    assert!(refused("[[6, 0.6]", "[[-6, 0.6]").contains("before[0]"));
    assert!(refused("window = \"out of reach\"", "").contains("disturbance[5]"));
    assert!(refused("gain = 0.92", "gain = 2.0").contains("gain"));
}

//! The plants whose physics no model here shares, under control.

use hysteron::Progress;
use hysteron_sim::track::{Comparison, Kind, Scenario, track};

fn rmse(found: &Comparison, kind: Kind, window: &str) -> f64 {
    let w = found.windows.iter().position(|w| w.name == window).unwrap();
    let k = found.controllers.iter().position(|k| *k == kind).unwrap();
    found.scores[k][0][w].rmse
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

//! Controllers compared on both simulated plants, in short runs.

use crate::loops::{RELAYS, RELAYS_SINE, SPRING, SPRING_SINE, scenario};
use hysteron::Progress;
use hysteron_sim::track::{Comparison, Kind, track};

fn rmse(found: &Comparison, kind: Kind, window: usize) -> f64 {
    let place = found.controllers.iter().position(|k| *k == kind).unwrap();
    found.scores[place][0][window].rmse
}

fn compare(base: &str, reference: &str, disturbance: &str) {
    let kinds = r#"controllers = ["pid", "inverse-pid", "adaptive-pid"]"#;
    let found = track(
        &scenario(&[base, kinds, reference, disturbance]),
        Progress::NONE,
    )
    .unwrap();
    let last = found.windows.len() - 1;
    for (w, window) in found.windows.iter().enumerate() {
        let all = found.controllers.iter().map(|kind| rmse(&found, *kind, w));
        println!("{}: {:.3?}", window.name, all.collect::<Vec<_>>());
    }
    assert!(rmse(&found, Kind::InversePid, 0) < 0.7 * rmse(&found, Kind::Pid, 0));
    assert!(rmse(&found, Kind::AdaptivePid, last) < 0.8 * rmse(&found, Kind::InversePid, last));
}

#[test]
fn inverse_beats_pid_and_adaptation_the_fixed_inverse_on_the_spring() {
    let step = "[[disturbance]]\nat_s = 920\nload_n = 10.0";
    compare(SPRING, SPRING_SINE, step);
}

#[test]
fn inverse_beats_pid_and_adaptation_the_fixed_inverse_on_the_relays() {
    let step = "[[disturbance]]\nat_s = 25\nload_n = 10.0";
    compare(RELAYS, RELAYS_SINE, step);
}

#[test]
fn anticipating_pays_where_the_reference_rests() {
    let rests = r#"
[[reference]]
kind = "trapezoid"
low = 3.0
high = 7.0
ramp_s = 60
rest_s = 60
"#;
    let kinds = r#"controllers = ["inverse-pid", "inverse-pid-anticipate"]"#;
    let found = track(&scenario(&[SPRING, kinds, rests]), Progress::NONE).unwrap();
    for (w, window) in found.windows.iter().enumerate() {
        let [hold, anticipate] = [0, 1].map(|k| found.scores[k][0][w]);
        println!(
            "{}: error {:.3} and {:.3} mm, lag {:.1} and {:.1} s",
            window.name, hold.rmse, anticipate.rmse, hold.lag_s, anticipate.lag_s
        );
        // A fifth less as measured; the lag is a few samples of noise more or less.
        assert!(anticipate.rmse < 0.9 * hold.rmse);
    }
}

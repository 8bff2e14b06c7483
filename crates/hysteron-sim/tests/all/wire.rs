//! The wire without a thermometer: the shift of the axis follows room and load.

use hysteron::Progress;
use hysteron::control::{Device, Disturbance, SimulatedPlant};
use hysteron_sim::plant::{WirePlant, WirePlantOptions};
use hysteron_sim::track::{Kind, Reference, Scenario, track};

#[test]
fn the_adaptive_drive_follows_a_warmer_room_and_a_heavier_load() {
    let mut scenario = Scenario::load("wire").unwrap();
    scenario.seeds = 1;
    scenario.controllers = vec![Kind::InverseAnticipate, Kind::AdaptiveAnticipate];
    let found = track(&scenario, Progress::NONE).unwrap();
    let rmse = |k: usize, w: usize| found.scores[k][0][w].rmse;
    let settled: Vec<usize> = (0..found.windows.len())
        .filter(|w| found.windows[*w].settled)
        .collect();
    assert_eq!(settled.len(), 3);
    for &w in &settled {
        // A twentieth of the stroke of 4 mm.
        assert!(
            rmse(1, w) < 0.2,
            "{}: {}",
            found.windows[w].name,
            rmse(1, w)
        );
    }
    // 8 K in a transformation that is some 30 K wide.
    let room = settled[1];
    assert!(rmse(1, room) < 0.3 * rmse(0, room), "{}", rmse(1, room));
    assert!(found.model.thermal.is_some());
}

/// A reference with corners, which a body that cools passively does not follow at once.
#[test]
fn a_drive_that_knows_the_reference_ahead_turns_in_time() {
    let mut scenario = Scenario::load("wire").unwrap();
    scenario.seeds = 1;
    scenario.duration_s = 60.0;
    scenario.disturbance.clear();
    scenario.controllers = vec![Kind::InverseAnticipate];
    scenario.reference = vec![Reference::Trapezoid {
        low: 1.0,
        high: 3.0,
        ramp_s: 2.0,
        rest_s: 3.0,
    }];
    let [late, early] = [0.0, 2.0].map(|preview_s| {
        scenario.shared.preview_s = preview_s;
        let found = track(&scenario, Progress::NONE).unwrap();
        found.scores[0][0].last().unwrap().rmse
    });
    // It sets out earlier by what the body needs, no more: the gain is that of the corners.
    assert!(early < 0.9 * late, "{early} {late}");
}

#[test]
fn a_wire_stays_within_its_physics_whatever_it_is_told() {
    let mut wire = WirePlant::new(&WirePlantOptions::default()).unwrap();
    for (n, drive) in [f64::NAN, 5.0, -1.0, f64::INFINITY, 0.5]
        .into_iter()
        .enumerate()
    {
        wire.write(drive);
        wire.advance([0.0, 1.0, f64::NAN, -1.0, 10.0][n]);
        let truth = wire.truth();
        assert!((0.0..=4.0).contains(&truth.output), "{}", truth.output);
        // Full duty at rest: some 120 K above the room.
        assert!((20.0..160.0).contains(&truth.input.unwrap()));
    }
    let before = wire.truth();
    for wrong in [
        Disturbance::Load(-1.0),
        Disturbance::Load(f64::NAN),
        Disturbance::Room(1000.0),
        Disturbance::Predeformation(1.0),
    ] {
        assert!(wire.disturb(wrong).is_err());
        assert_eq!(wire.truth(), before);
    }
    // A heavier load transforms later: the output falls.
    wire.disturb(Disturbance::Load(8.0)).unwrap();
    assert!(wire.truth().output < before.output);
    let heavy = WirePlantOptions {
        load_n: 21.0,
        ..WirePlantOptions::default()
    };
    assert!(WirePlant::new(&heavy).is_err());
}

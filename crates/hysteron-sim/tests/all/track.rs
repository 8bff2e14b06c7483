//! Scenarios: what they may say, the references they make, tuning, and comparisons that can be
//! repeated.

use crate::loops::{RELAYS, RELAYS_SINE, SPRING, SPRING_SINE, scenario, text};
use hysteron::{Error, Progress};
use hysteron_sim::track::{Scenario, track};
use std::path::Path;

fn refusal(text: &str) -> String {
    match Scenario::parse(text, Path::new("")) {
        Err(error @ Error::Scenario { .. }) => {
            assert_eq!(error.code(), 29);
            error.to_string()
        }
        other => panic!("{other:?}\n{text}"),
    }
}

#[test]
fn the_built_in_scenarios_are_scenarios() {
    for name in Scenario::names() {
        let scenario = Scenario::load(name).unwrap();
        assert!(scenario.references().iter().all(|y| y.is_finite()));
    }
    let error = Scenario::load("no-such-scenario").unwrap_err().to_string();
    assert!(
        error.contains("no-such-scenario") && error.contains("load-step"),
        "{error}"
    );
}

#[test]
fn learners_refuse_what_they_do_not_have() {
    let whole = text(&[SPRING, SPRING_SINE]);
    let method = "method = \"least-squares\"";
    for (to, named) in [
        ("method = \"gradient\"", "take `increments`"),
        ("method = \"newton\"", "one of auto, fixed, refit"),
        (
            "method = \"refit\"",
            "`forgetting` is an option of `drift`, `least-squares`",
        ),
        (
            "method = \"least-squares\"\nadaptation.gain = 0.3",
            "`gain` is an option of `increments`, not of `least-squares`",
        ),
        ("method = \"least-squares\"\nadaptation.gian = 0.3", "gian"),
    ] {
        let said = refusal(&whole.replace(method, to));
        assert!(said.contains(named), "{to}: {said}");
    }
}

#[test]
fn a_refusal_names_the_line() {
    let whole = text(&[SPRING, SPRING_SINE]);
    let line_of =
        |text: &str, part: &str| 1 + text.lines().position(|line| line.contains(part)).unwrap();
    for (from, to, part) in [
        ("interval_s = 0.2", "intervall_s = 0.2", "intervall_s"),
        ("interval_s = 0.2", "interval_s = \"fast\"", "fast"),
        ("seeds = 1", "seeds = -1", "seeds = -1"),
        ("smooth = 1e-8", "smoth = 1e-8", "smoth"),
        ("tolerance = 0.1", "tolerant = 0.1", "tolerant"),
        ("seeds = 1", "seeds = ", "seeds = "),
    ] {
        assert!(whole.contains(from), "{from}");
        let wrong = whole.replace(from, to);
        let said = refusal(&wrong);
        let line = format!("line {}:", line_of(&wrong, part));
        assert!(said.contains(&line), "{to}: {said}, not {line}");
    }
    // What is inside a table with a kind is told by its name.
    for (from, to, named) in [
        ("kind = \"spring\"", "kind = \"sprong\"", "sprong"),
        ("load_n = 6.0", "lod_n = 6.0", "lod_n"),
        ("period_s = 300", "periods = 300", "periods"),
    ] {
        let said = refusal(&whole.replace(from, to));
        assert!(
            said.contains(named) && said.contains("line"),
            "{to}: {said}"
        );
    }
    assert!(refusal("title = \"nothing else\"").contains("duration_s"));
}

#[test]
fn a_refusal_names_file_line_and_field() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    let whole = text(&[SPRING, SPRING_SINE]);
    for (from, to, field) in [
        ("period_s = 300", "period_s = -1", "reference[1].period_s"),
        ("smooth = 1e-8", "smooth = -1", "model.smooth"),
        ("tolerance = 0.1", "tolerance = \"x\"", "loop.tolerance"),
    ] {
        let wrong = whole.replace(from, to);
        std::fs::write(&path, &wrong).unwrap();
        let said = Scenario::load(path.to_str().unwrap())
            .unwrap_err()
            .to_string();
        let line = 1 + wrong.lines().position(|line| line.contains(to)).unwrap();
        let expected = format!("scenario {}, line {line}: `{field}`: ", path.display());
        assert!(said.starts_with(&expected), "{said}, not {expected}");
    }
}

#[test]
fn a_refusal_names_the_field() {
    let reference = |lines: &str| format!("[[reference]]\n{lines}");
    let event = |lines: &str| format!("{SPRING_SINE}[[disturbance]]\n{lines}");
    let cases: Vec<(&str, String, &str)> = vec![
        (
            SPRING,
            format!("duration_s = -1\n{SPRING_SINE}"),
            "`duration_s`",
        ),
        (
            SPRING,
            format!("duration_s = nan\n{SPRING_SINE}"),
            "`duration_s`",
        ),
        (
            SPRING,
            format!("interval_s = 0\n{SPRING_SINE}"),
            "`interval_s`",
        ),
        (
            SPRING,
            format!("settle_s = 1e9\n{SPRING_SINE}"),
            "`settle_s`",
        ),
        (SPRING, format!("seeds = 0\n{SPRING_SINE}"), "`seeds`"),
        (
            SPRING,
            format!("controllers = []\n{SPRING_SINE}"),
            "`controllers`",
        ),
        (SPRING, "reference = []".into(), "`reference`"),
        (
            SPRING,
            format!("loop = {{ filter_s = -1 }}\n{SPRING_SINE}"),
            "`loop.filter_s`",
        ),
        (
            SPRING,
            format!("loop = {{ tolerance = nan }}\n{SPRING_SINE}"),
            "`loop.tolerance`",
        ),
        (
            SPRING,
            format!("loop = {{ speed = 0 }}\n{SPRING_SINE}"),
            "`loop.speed`",
        ),
        (
            SPRING,
            format!("loop = {{ preview_s = -0.1 }}\n{SPRING_SINE}"),
            "`loop.preview_s`",
        ),
        (
            SPRING,
            format!("adaptation.noise = 0\n{SPRING_SINE}"),
            "`adaptation`",
        ),
        (
            SPRING,
            format!("plant = {{ kind = \"spring\", load_n = 99 }}\n{SPRING_SINE}"),
            "`plant`",
        ),
        (
            SPRING,
            format!("model = {{ levels = 1, range = [24, 92], rates = [2, 1] }}\n{SPRING_SINE}"),
            "`model`",
        ),
        (
            SPRING,
            format!("model = {{ levels = 9, range = [24, 92], rates = [2, 0] }}\n{SPRING_SINE}"),
            "`model.rates`",
        ),
        (
            SPRING,
            reference("kind = \"constant\"\nvalue = inf"),
            "`reference[0].value`",
        ),
        (
            SPRING,
            reference("kind = \"sine\"\namplitude = 1\nperiod_s = -5"),
            "`reference[0].period_s`",
        ),
        (
            SPRING,
            reference("kind = \"trapezoid\"\nlow = 1\nhigh = 2\nramp_s = 0\nrest_s = 1"),
            "`reference[0].ramp_s`",
        ),
        (
            SPRING,
            format!(
                "{SPRING_SINE}{}",
                reference("kind = \"steps\"\npoints = [[5, 1], [3, 2]]")
            ),
            "`reference[2].points`",
        ),
        (
            SPRING,
            reference("kind = \"ramps\"\npoints = []"),
            "`reference[0].points`",
        ),
        (SPRING, event("at_s = 100"), "`disturbance[0]`"),
        (
            SPRING,
            event("at_s = -1\nload_n = 7"),
            "`disturbance[0].at_s`",
        ),
        (
            SPRING,
            event("at_s = 100\nload_n = 7\n[[disturbance]]\nat_s = 50\nload_n = 6"),
            "`disturbance[1].at_s`",
        ),
        (
            SPRING,
            event("at_s = 100\nload_n = 700"),
            "`disturbance[0]`",
        ),
        (
            RELAYS,
            format!("{RELAYS_SINE}[[disturbance]]\nat_s = 20\nroom_degc = 30"),
            "`disturbance[0]`",
        ),
    ];
    for (base, part, field) in cases {
        let said = refusal(&text(&[base, &part]));
        assert!(said.contains(field), "{part}: {said}");
    }
}

#[test]
fn a_scenario_put_together_by_hand_is_checked_too() {
    let mut one = scenario(&[SPRING, SPRING_SINE]);
    one.seeds = 0;
    let refused = track(&one, Progress::NONE);
    assert!(matches!(refused, Err(Error::Scenario { .. })));
}

#[test]
fn references_by_hand() {
    let at = |part: &str| {
        let base = [SPRING, "duration_s = 10\ninterval_s = 1\nsettle_s = 1"];
        scenario(&[base[0], base[1], part]).references()
    };
    let part = |lines: &str| format!("[[reference]]\n{lines}\n");
    let close = |a: &[f64], b: [f64; 10]| {
        assert_eq!(a.len(), 10);
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12), "{a:?}");
    };
    let trapezoid = part("kind = \"trapezoid\"\nlow = 1\nhigh = 3\nramp_s = 2\nrest_s = 1");
    close(
        &at(&trapezoid),
        [1.0, 2.0, 3.0, 3.0, 2.0, 1.0, 1.0, 2.0, 3.0, 3.0],
    );
    let steps = part("kind = \"steps\"\npoints = [[2, 5], [4, -1]]");
    close(
        &at(&steps),
        [5.0, 5.0, 5.0, 5.0, -1.0, -1.0, -1.0, -1.0, -1.0, -1.0],
    );
    let ramps = part("kind = \"ramps\"\npoints = [[2, 5], [4, 9], [4, 0], [8, 2]]");
    close(
        &at(&ramps),
        [5.0, 5.0, 5.0, 7.0, 0.0, 0.5, 1.0, 1.5, 2.0, 2.0],
    );
    let sine = part("kind = \"sine\"\namplitude = 2\nperiod_s = 4\nphase_deg = 90");
    close(
        &at(&sine),
        [2.0, 0.0, -2.0, 0.0, 2.0, 0.0, -2.0, 0.0, 2.0, 0.0],
    );
    // Parts are added.
    let both = format!("{sine}{}", part("kind = \"constant\"\nvalue = 1"));
    close(
        &at(&both),
        [3.0, 1.0, -1.0, 1.0, 3.0, 1.0, -1.0, 1.0, 3.0, 1.0],
    );
}

#[test]
fn a_reference_from_a_table() {
    let folder = tempfile::tempdir().unwrap();
    let part =
        "[[reference]]\nkind = \"csv\"\nfile = \"wanted.csv\"\ntime = \"t\"\ncolumn = \"mm\"";
    let whole = text(&[
        SPRING,
        "duration_s = 10\ninterval_s = 1\nsettle_s = 1",
        part,
    ]);
    let missing = Scenario::parse(&whole, folder.path()).unwrap_err();
    assert!(matches!(missing, Error::File { .. }));
    assert!(missing.to_string().contains("wanted.csv"));
    std::fs::write(folder.path().join("wanted.csv"), "t,mm\n0,1\n4,3\n8,3\n").unwrap();
    let found = Scenario::parse(&whole, folder.path()).unwrap().references();
    assert_eq!(found, [1.0, 1.5, 2.0, 2.5, 3.0, 3.0, 3.0, 3.0, 3.0, 3.0]);
    std::fs::write(folder.path().join("wanted.csv"), "t,cm\n0,1\n4,3\n").unwrap();
    let wrong = Scenario::parse(&whole, folder.path()).unwrap_err();
    assert!(wrong.to_string().contains("mm"), "{wrong}");
}

#[test]
fn both_rules_give_gains_on_both_plants() {
    for (base, sine, duration) in [(SPRING, SPRING_SINE, 130), (RELAYS, RELAYS_SINE, 10)] {
        for rule in ["relay", "step"] {
            let more = format!("duration_s = {duration}\ncontrollers = [\"pid\"]");
            let mut one = scenario(&[base, &more, sine]);
            one.shared.tuning = match rule {
                "relay" => hysteron_sim::track::Tuning::Relay,
                _ => hysteron_sim::track::Tuning::Step,
            };
            let found = track(&one, Progress::NONE).unwrap();
            let gains = found.gains.unwrap();
            println!("{rule}: {gains:?}, inside {:?}", found.inner_gains);
            for gains in [Some(gains), found.inner_gains].into_iter().flatten() {
                assert!(gains.gain > 0.0 && gains.gain.is_finite());
                assert!(gains.integral_s > one.interval_s && gains.integral_s < 1000.0);
            }
            assert_eq!(found.inner_gains.is_some(), base == SPRING);
        }
    }
}

#[test]
fn each_controller_has_gains_of_its_own_from_the_model_of_its_run() {
    for (base, sine, duration) in [(SPRING, SPRING_SINE, 130), (RELAYS, RELAYS_SINE, 10)] {
        let more = format!(
            "duration_s = {duration}\ncontrollers = [\"pid\", \"inverse\", \"inverse-pid\"]"
        );
        let mut one = scenario(&[base, &more, sine]);
        one.shared.tuning = hysteron_sim::track::Tuning::Model;
        let found = track(&one, Progress::NONE).unwrap();
        assert!(found.gains.is_none());
        let [pid, inverse, both] = [0, 1, 2].map(|k| &found.tuned[k]);
        assert!(inverse.iter().all(Option::is_none));
        assert_eq!(pid.len(), one.seeds as usize);
        for tuned in pid.iter().chain(both) {
            let tuned = tuned.unwrap();
            assert!(tuned.margin >= 2.0 && tuned.gains.gain > 0.0, "{tuned:?}");
        }
        // The feedback does no harm.
        let [alone, with] = [1, 2].map(|k| found.scores[k][0][0].rmse);
        assert!(with < alone, "{base}: {with} for {alone}");
    }
}

#[test]
fn a_plant_that_does_not_answer_is_refused() {
    let weak = [
        (
            SPRING,
            "plant = { kind = \"spring\", limit_a = 0.1 }",
            SPRING_SINE,
        ),
        (
            RELAYS,
            "plant = { kind = \"preisach\", limit_v = 1 }",
            RELAYS_SINE,
        ),
    ];
    for (base, plant, sine) in weak {
        for rule in ["relay", "step"] {
            let shared =
                format!("loop = {{ filter_s = 0.1, tolerance = 0.1, tuning = \"{rule}\" }}");
            let more = format!("{plant}\n{shared}\ncontrollers = [\"pid\"]");
            let refused = track(&scenario(&[base, &more, sine]), Progress::NONE).unwrap_err();
            assert!(matches!(refused, Error::Scenario { .. }), "{refused}");
            assert!(
                refused.to_string().contains("no PID can be tuned"),
                "{refused}"
            );
        }
    }
}

#[test]
fn the_same_seeds_give_the_same_scores() {
    let more = "duration_s = 20\nseeds = 2\ncontrollers = [\"pid\", \"adaptive-pid\"]";
    let one = scenario(&[RELAYS, more, RELAYS_SINE]);
    let scores = || format!("{:?}", track(&one, Progress::NONE).unwrap().scores);
    let found = scores();
    assert_eq!(found, scores());
    assert!(!found.is_empty());
}

#[test]
fn twice_the_samples_track_alike() {
    let rmse = |interval: &str| {
        let more =
            format!("duration_s = 1000\nseeds = 2\ncontrollers = [\"inverse-pid\"]\n{interval}");
        let found = track(&scenario(&[SPRING, &more, SPRING_SINE]), Progress::NONE).unwrap();
        found.medians()[1].score.rmse
    };
    let (coarse, fine) = (rmse("interval_s = 0.2"), rmse("interval_s = 0.1"));
    println!("0.2 s: {coarse:.4} mm, 0.1 s: {fine:.4} mm");
    // Model and gains are identified anew at each interval.
    assert!((0.7..1.43).contains(&(fine / coarse)), "{fine} {coarse}");
}

#[test]
fn a_loop_aims_by_its_delay_and_else_by_that_of_the_model() {
    let kinds = r#"controllers = ["inverse"]"#;
    let found = |delay: &str| {
        let text = text(&[RELAYS, "duration_s = 10", kinds, RELAYS_SINE]);
        let text = text.replace("tolerance = 0.5", &format!("tolerance = 0.5{delay}"));
        track(
            &Scenario::parse(&text, Path::new("")).unwrap(),
            Progress::NONE,
        )
        .unwrap()
    };
    let default = found("");
    let due = 1 + default.model.delay().at(Some(0.01));
    let drives = |delay: usize| found(&format!(", delay = {delay}")).traces[0].drive.clone();
    assert_eq!(drives(due), default.traces[0].drive);
    assert_ne!(drives(due + 1), default.traces[0].drive);
    let refused = text(&[RELAYS, kinds, RELAYS_SINE]).replace("filter_s = 0.01", "delay = 1002");
    let said = refusal(&refused);
    assert!(said.contains("loop.delay"), "{said}");
}

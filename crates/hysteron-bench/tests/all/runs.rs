//! Runs that go well: each mode, the row of a log, slew, beginning without a bump, going on.

use super::bench::{PID, bench, column, config, folder, plain, rows};
use super::device::{DT, Fault, SAFE, start};
use hysteron::{Delay, FirstOrder, Model, Operator, Plane, Sign};
use hysteron_bench::{Config, End, Error, Options, Summary, dry_run};

const RECORD: &str = "mode = 'record'\nlog = 'run.csv'\nlimits = { drive = [0, 8] }\n\
                      profile = { table = 'profile.csv' }\n";

#[test]
fn a_recording_has_cause_and_effect_in_one_row() {
    let ran = bench(RECORD, &[]);
    assert_eq!((&ran.summary.end, ran.summary.samples), (&End::Done, 80));
    let log = ran.folder.path().join("run.csv");
    let names: Vec<String> = rows(&log)[0].iter().map(|(name, _)| name.clone()).collect();
    let expected =
        "time reference drive command output temperature output_model status learner sample";
    assert_eq!(names.join(" "), expected);
    let [time, drive, command] = ["time", "drive", "command"].map(|name| column(&log, name));
    assert_eq!(drive[0], SAFE);
    assert_eq!(
        drive[1..],
        command[..79],
        "the drive of a row is the command of the one before"
    );
    for (time, command) in time.iter().zip(&command).take(79) {
        let due = 4.0 - 3.5 * (3.0 * time).cos();
        assert!((due - command).abs() < 1e-6, "{time}");
    }
    assert_eq!(command[79], SAFE);
}

#[test]
fn a_profile_beyond_the_limits_is_clipped_there() {
    let ran = bench(&RECORD.replace("[0, 8]", "[2, 6]"), &[]);
    let log = ran.folder.path().join("run.csv");
    let within = |drive: &f64| (2.0..=6.0).contains(drive) || *drive == SAFE;
    assert!(column(&log, "command").iter().all(within));
    assert!(
        rows(&log)
            .iter()
            .any(|row| row.iter().any(|(_, cell)| cell == "limited"))
    );
}

#[test]
fn monitoring_leaves_the_drive_safe() {
    let ran = bench("mode = 'monitor'\nlog = 'run.csv'\nduration_s = 1\n", &[]);
    assert!(ran.report.drives.iter().all(|(_, drive)| *drive == SAFE));
    assert_eq!((ran.summary.end, ran.summary.samples), (End::Done, 20));
}

#[test]
fn a_pid_follows_begins_where_the_drive_is_and_keeps_to_its_slew() {
    for slew in [40.0, 2.0] {
        let ran = bench(&PID.replace("slew = 40", &format!("slew = {slew}")), &[]);
        let log = ran.folder.path().join("run.csv");
        let command = column(&log, "command");
        assert!((command[0] - SAFE).abs() < 0.3, "{}", command[0]);
        let last = command.len() - 1; // it goes safe
        for pair in command[..last].windows(2) {
            assert!((pair[1] - pair[0]).abs() <= slew * DT + 1e-6, "{pair:?}");
        }
        if slew > 10.0 {
            let [reference, output] = ["reference", "output"].map(|name| column(&log, name));
            let late = 30..60;
            let largest = late
                .map(|n| (reference[n] - output[n]).abs())
                .fold(0.0, f64::max);
            // Of the 10 that the reference goes; the lag alone would leave 3.7.
            assert!(largest < 2.0, "{largest}");
        }
    }
}

/// A model of the device without its lag.
fn lagless() -> Model {
    let plane = Plane::new(1.0, 10.0, 10).unwrap();
    let weights = (1..=10).flat_map(|j| (1..=j).map(move |i| if i == j { 2.0 } else { 0.0 }));
    Model::new(Operator::Mkp, plane, weights.collect(), 0.0, Sign::Positive).unwrap()
}

fn model(folder: &tempfile::TempDir) {
    lagless().write(&folder.path().join("model.json")).unwrap();
}

#[test]
fn every_kind_of_controller_follows() {
    let tail = "mode = 'control'\nlog = 'run.csv'\nreference = { table = 'reference.csv' }\n\
                limits = { drive = [0, 8] }\n";
    for (kind, more) in [
        ("inverse", ""),
        ("inverse-anticipate", ""),
        ("inverse-pid", ""),
        ("pid", ", tuning = 'model'"),
        ("adaptive-inverse", ", learner = 'auto'"),
        ("adaptive-inverse-pid", ", learner = 'least-squares'"),
        (
            "adaptive-pid",
            ", learner = 'refit', tuning = { proportional = 0.2, integral_s = 0.2 }",
        ),
        ("adaptive-inverse", ", learner = 'load'"),
    ] {
        let folder = folder();
        model(&folder);
        let text = format!("{tail}controller = {{ kind = '{kind}', model = 'model.json'{more} }}");
        let (address, served) = start(vec![]);
        let config = config(&folder, &text, &format!("tcp = '{address}'"));
        let options = Options::default();
        let found = plain(&config, &options).unwrap();
        let report = served.join().unwrap();
        assert_eq!(
            (&found.end, report.drive),
            (&End::Done, SAFE),
            "{kind}: {}",
            found.end
        );
        let log = folder.path().join("run.csv");
        let [reference, output, command] =
            ["reference", "output", "command"].map(|name| column(&log, name));
        assert!((command[0] - SAFE).abs() < 1.0, "{kind}: {}", command[0]);
        let squares = (40..80)
            .map(|n| (reference[n] - output[n]).powi(2))
            .sum::<f64>();
        let rmse = (squares / 40.0).sqrt();
        println!("{kind}{more}: {rmse:.3} {:?}", found.tuned);
        // The model does not say how fast the device is: alone, its slow integral lags behind.
        let most = if kind == "pid" { 3.5 } else { 2.5 };
        assert!(rmse < most, "{kind}: {rmse}");
        let expected = column(&log, "output_model")
            .iter()
            .filter(|y| y.is_finite())
            .count();
        assert_eq!(expected > 70, kind != "pid", "{kind}");
    }
}

#[test]
fn an_output_far_beyond_the_model_ends_a_run_unless_limits_are_given() {
    for (limits, astray) in [("", true), (", output = [-40, 40]", false)] {
        let folder = folder();
        model(&folder);
        let text = format!(
            "mode = 'control'\nlog = 'run.csv'\nreference = {{ table = 'reference.csv' }}\n\
             limits = {{ drive = [0, 8]{limits} }}\n\
             controller = {{ kind = 'inverse-pid', model = 'model.json' }}"
        );
        let (address, served) = start(vec![(20, Fault::Turned)]);
        let config = config(&folder, &text, &format!("tcp = '{address}'"));
        let found = plain(&config, &Options::default()).unwrap();
        let report = served.join().unwrap();
        assert_eq!(report.drive, SAFE);
        assert_eq!(matches!(found.end, End::Astray(_)), astray, "{}", found.end);
        assert_eq!(found.end.code(), if astray { 5 } else { 0 });
    }
}

/// What a run on a device comes to, which may go on with the log in the folder.
fn gone_on(
    folder: &tempfile::TempDir,
    text: &str,
    resume: bool,
) -> (Result<Summary, Error>, Options, Config) {
    let (address, served) = start(vec![]);
    let config = config(folder, text, &format!("tcp = '{address}'"));
    let options = Options {
        resume,
        ..Options::default()
    };
    let found = plain(&config, &options);
    served.join().unwrap();
    (found, options, config)
}

#[test]
fn a_log_is_gone_on_with_by_the_same_run_only() {
    let folder = folder();
    let short = PID.replace("duration_s = 3", "duration_s = 1");
    let go = |text: &str, resume: bool| {
        let (found, options, config) = gone_on(&folder, text, resume);
        let found = found.map_err(|error| error.to_string());
        (
            found,
            dry_run(&config, &options).map_err(|error| error.to_string()),
        )
    };
    go(&short, false).0.unwrap();
    let before = std::fs::read(folder.path().join("run.csv")).unwrap();
    let (over, dry) = go(&short, true);
    for error in [over.unwrap_err(), dry.unwrap_err()] {
        assert!(error.contains("nothing is left"), "{error}");
    }
    let options = Options {
        resume: true,
        ..Options::default()
    };
    let longer = config(&folder, PID, "simulated = 'spring'");
    let lines = dry_run(&longer, &options).unwrap();
    let after = "resumes   after sample 20, at 1 s".to_owned();
    assert!(lines.contains(&after), "{lines:?}");
    model(&folder);
    let other = PID.replace("kind = 'pid'", "kind = 'inverse-pid', model = 'model.json'");
    let (refused, dry) = go(&other, true);
    for error in [refused.unwrap_err(), dry.unwrap_err()] {
        assert!(error.contains("another controller"), "{error}");
    }
    assert_eq!(
        std::fs::read(folder.path().join("run.csv")).unwrap(),
        before
    );
}

#[test]
fn a_run_goes_on_where_it_ended() {
    let folder = folder();
    let text = PID.replace("duration_s = 3", "duration_s = 1");
    let go = |text: &str, resume: bool| gone_on(&folder, text, resume).0.unwrap();
    assert_eq!(go(&text, false).samples, 20);
    let log = folder.path().join("run.csv");
    // A kill has left half a row.
    let whole = std::fs::read(&log).unwrap();
    std::fs::write(&log, [whole.as_slice(), b"1.05,2.1,"].concat()).unwrap();
    let found = go(PID, true);
    assert_eq!((&found.end, found.samples), (&End::Done, 40));
    let [time, sample, reference] = ["time", "sample", "reference"].map(|name| column(&log, name));
    assert_eq!(time.len(), 60);
    for n in 0..60 {
        assert!(
            (time[n] - DT * (n as f64 + 1.0)).abs() < 1e-6,
            "{n}: {}",
            time[n]
        );
        assert_eq!(sample[n], n as f64 + 1.0);
        let due = 6.0 - 5.0 * (2.0 * time[n]).cos();
        assert!((reference[n] - due).abs() < 0.01, "{n}");
    }
}

#[test]
fn parquet_has_the_same_rows() {
    let text = RECORD.replace("run.csv", "run.parquet");
    let folder = folder();
    let (address, served) = start(vec![]);
    let config = config(&folder, &text, &format!("tcp = '{address}'"));
    let found = plain(&config, &Options::default());
    served.join().unwrap();
    assert_eq!(found.unwrap().end, End::Done);
    let path = folder.path().join("run.parquet");
    let mut table = hysteron::TableReader::open(&path).unwrap();
    let mut count = 0;
    while table.advance().unwrap() {
        count += 1;
    }
    assert_eq!((count, table.header()[2].as_str()), (80, "drive"));
    assert!(!folder.path().join("run.parquet.rows.csv").exists());
}

#[test]
fn a_log_of_somebody_else_is_kept() {
    let folder = folder();
    let log = folder.path().join("run.csv");
    std::fs::write(&log, "mine").unwrap();
    let config = config(&folder, RECORD, "tcp = '127.0.0.1:1'");
    let refused = plain(&config, &Options::default());
    assert!(
        refused
            .unwrap_err()
            .to_string()
            .contains("not a log of hysteron")
    );
    assert_eq!(std::fs::read_to_string(&log).unwrap(), "mine");
    let dry = Options {
        log: Some(folder.path().join("other.csv")),
        ..Options::default()
    };
    let lines = dry_run(&config, &dry).unwrap().join("\n");
    assert!(
        lines.contains("0 to 8") && lines.contains("nothing was sent"),
        "{lines}"
    );
    assert!(!folder.path().join("other.csv").exists());
}

#[test]
fn a_simulated_plant_needs_no_device() {
    for kind in ["spring", "preisach", "wire"] {
        let folder = folder();
        let text = RECORD.replace("limits = { drive = [0, 8] }\n", "");
        let config = config(&folder, &text, &format!("simulated = '{kind}'"));
        let found = plain(&config, &Options::default());
        assert_eq!(found.unwrap().end, End::Done, "{kind}");
    }
}

#[test]
fn what_no_run_can_be_is_refused_with_its_line() {
    let tail = "\n[device]\ntcp = 'x:1'\n";
    for (text, says) in [
        ("mode = 'record'", "profile"),
        ("mode = 'control'", "reference"),
        ("mode = 'drive'", "drive"),
        ("mode = 'monitor'\nduration_s = -1", "line 2"),
        ("mode = 'monitor'\nspeed = 1", "line 2"),
        ("mode = 'monitor'\n[limits]\ndrive = [2, 1]", "line 3"),
        ("mode = 'monitor'\n[limits]\nslew = 0", "limits.slew"),
        ("mode = 'monitor'\n[safety]\nlost_s = 0", "safety.lost_s"),
        (
            "mode = 'control'\nreference = { table = 'r.csv' }\ncontroller = { kind = 'pid' }",
            "gains",
        ),
        (
            "mode = 'control'\nreference = { table = 'r.csv' }\ncontroller = { kind = 'inverse' }",
            "needs a model",
        ),
        (
            "mode = 'control'\nreference = { table = 'r.csv' }\n\
             controller = { kind = 'pid', proportional = 1, learner = 'auto' }",
            "does not learn",
        ),
        (
            "mode = 'control'\nreference = { table = 'r.csv' }\ncontroller = { kind = 'pi-rls' }",
            "of `track` alone",
        ),
    ] {
        let error = Config::parse(&format!("{text}{tail}"), "run.toml".as_ref()).unwrap_err();
        assert!(error.to_string().contains(says), "{text}: {error}");
    }
    let two = Config::parse(
        "mode = 'monitor'\n[device]\ntcp = 'x:1'\nserial = 'y'",
        "r".as_ref(),
    );
    assert!(two.unwrap_err().to_string().contains("one of"));
}

#[test]
fn limits_wider_than_the_devices_are_refused_and_it_is_told_to_quit() {
    let folder = folder();
    let (address, served) = start(vec![]);
    let text = RECORD.replace("[0, 8]", "[0, 11]");
    let config = config(&folder, &text, &format!("tcp = '{address}'"));
    let refused = plain(&config, &Options::default());
    assert!(refused.unwrap_err().to_string().contains("wider"));
    let report = served.join().unwrap();
    assert!(report.quit && report.drives.is_empty());
}

#[test]
fn a_controller_aims_by_its_key_and_else_by_the_dead_time_of_the_model() {
    let commands = |model: Model, key: &str| {
        let folder = folder();
        model.write(&folder.path().join("model.json")).unwrap();
        let text = format!(
            "mode = 'control'\nlog = 'run.csv'\nreference = {{ table = 'reference.csv' }}\n\
             limits = {{ drive = [0, 8] }}\n\
             controller = {{ kind = 'inverse', model = 'model.json'{key} }}"
        );
        let (address, served) = start(vec![]);
        let config = config(&folder, &text, &format!("tcp = '{address}'"));
        plain(&config, &Options::default()).unwrap();
        served.join().unwrap();
        column(&folder.path().join("run.csv"), "command")
    };
    let late = || lagless().with_delay(Delay::new(1, 2.0 * DT).unwrap());
    // Two samples of the device, whose interval is half that of the recording.
    let [one, three] = [", delay = 1", ", delay = 3"].map(|key| commands(lagless(), key));
    assert_eq!(commands(lagless(), ""), one);
    assert_eq!(commands(late(), ""), three);
    assert_eq!(commands(late(), ", delay = 1"), one);
    // Aimed two samples further, the same inputs come two samples earlier.
    let least = |shift: usize| {
        let pairs = three[10..60].iter().zip(&one[10 + shift..]);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    assert!(
        least(2) < 1e-9 && least(0) > 0.1,
        "{} {}",
        least(2),
        least(0)
    );
}

#[test]
fn a_delay_without_end_is_refused() {
    let folder = folder();
    model(&folder);
    let text = "mode = 'control'\nlog = 'run.csv'\nreference = { table = 'reference.csv' }\n\
                limits = { drive = [0, 8] }\n\
                controller = { kind = 'inverse', model = 'model.json', delay = 1002 }";
    let (address, served) = start(vec![]);
    let config = config(&folder, text, &format!("tcp = '{address}'"));
    let said = plain(&config, &Options::default()).unwrap_err().to_string();
    assert!(said.contains("`delay` must be at most 1001"), "{said}");
    assert_eq!(served.join().unwrap().drive, SAFE);
}

/// The plane of a wire is one of temperatures. Its profile is one of drives, within the limits.
#[test]
fn a_design_for_a_body_is_a_profile_of_drives() {
    let folder = folder();
    let plane = Plane::new(20.0, 80.0, 6).unwrap();
    let mut wire = Model::new(Operator::Mkp, plane, vec![0.1; 21], 0.0, Sign::Positive).unwrap();
    wire.thermal = Some(FirstOrder {
        ambient: 15.0,
        gain: 1.0,
        tau_heating: 0.4,
        tau_cooling: 0.9,
    });
    std::fs::write(folder.path().join("wire.json"), wire.to_json()).unwrap();
    let lines = |more: &str| {
        let text = format!(
            "mode = 'record'\nlog = 'run.csv'\nlimits = {{ drive = [0, 75] }}\n\
             profile = {{ table = 'design', model = 'wire.json'{more} }}\n"
        );
        let config = config(&folder, &text, "simulated = 'wire'");
        dry_run(&config, &Options::default())
    };
    let course = |lines: &[String]| -> Vec<f64> {
        let line = lines
            .iter()
            .find(|line| line.starts_with("course"))
            .unwrap();
        let words = line.split([' ', ',']).filter_map(|word| word.parse().ok());
        words.collect()
    };
    let [low, high, end] = course(&lines("").unwrap())[..] else {
        panic!("a course has two ends and a duration")
    };
    assert!(0.0 <= low && low < high && high <= 75.0, "{low} to {high}");
    let slower = course(&lines(", rates = [2, 2]").unwrap())[2];
    assert!(slower > end, "{slower} s, and {end} s as fast as it can");
    let refused = lines(", rates = [1e6, 2]").unwrap_err().to_string();
    assert!(refused.contains("slower rates"), "{refused}");
    // Without a body nobody knows how fast.
    wire.thermal = None;
    std::fs::write(folder.path().join("wire.json"), wire.to_json()).unwrap();
    let refused = lines("").unwrap_err().to_string();
    assert!(refused.contains("profile.rates"), "{refused}");
}

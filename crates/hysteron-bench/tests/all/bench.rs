//! What the tests run, and what has to hold of every run.

use super::device::{Fault, Report, SAFE, start};
use hysteron_bench::{Config, End, Error, Options, Stop, Summary, run};
use std::path::Path;
use tempfile::TempDir;

/// A PID that follows a sine, for three seconds of the device's time.
pub const PID: &str = "mode = 'control'
log = 'run.csv'
duration_s = 3
limits = { drive = [0, 8], slew = 40 }
safety = { lost_s = 0.4, stuck_s = 0.5 }
reference = { table = 'reference.csv' }
controller = { kind = 'pid', proportional = 0.6, integral_s = 0.2, derivative_s = 0.02 }
";

pub struct Ran {
    pub folder: TempDir,
    pub summary: Summary,
    pub report: Report,
}

/// A folder with a profile and a reference.
pub fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let table = |name: &str, column: &str, last: i32, at: fn(f64) -> f64| {
        let rows = (0..=last).map(|n| 0.05 * f64::from(n));
        let rows = rows
            .map(|time| format!("{time},{}\n", at(time)))
            .collect::<String>();
        std::fs::write(folder.path().join(name), format!("time,{column}\n{rows}")).unwrap();
    };
    table("reference.csv", "reference", 80, |time| {
        6.0 - 5.0 * (2.0 * time).cos()
    });
    table("profile.csv", "drive", 80, |time| {
        4.0 - 3.5 * (3.0 * time).cos()
    });
    table("slow.csv", "drive", 200, |time| {
        4.0 - 3.5 * (std::f64::consts::TAU * time / 5.0).cos()
    });
    folder
}

/// Runs a file on a device with these faults.
pub fn bench(text: &str, faults: &[(u64, Fault)]) -> Ran {
    let folder = folder();
    let (address, served) = start(faults.to_vec());
    let config = config(&folder, text, &format!("tcp = '{address}'"));
    let summary = plain(&config, &Options::default());
    let ran = Ran {
        summary: summary.unwrap(),
        report: served.join().unwrap(),
        folder,
    };
    check(&ran);
    ran
}

/// A run that nobody watches or stops.
pub fn plain(config: &Config, options: &Options) -> Result<Summary, Error> {
    run(config, options, &Stop::default(), &mut |_| {}, &mut |_| {})
}

pub fn config(folder: &TempDir, text: &str, device: &str) -> Config {
    let text = format!("{text}\n[device]\n{device}\n");
    Config::parse(&text, &folder.path().join("run.toml")).unwrap()
}

/// The rows of a log, by the names of its columns.
pub fn rows(log: &Path) -> Vec<Vec<(String, String)>> {
    let text = std::fs::read_to_string(log).unwrap();
    assert!(text.ends_with('\n'), "half a row");
    let mut lines = text
        .lines()
        .map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let names = lines.next().unwrap();
    lines
        .map(|cells| {
            assert_eq!(cells.len(), names.len(), "{cells:?}");
            names.iter().cloned().zip(cells).collect()
        })
        .collect()
}

pub fn column(log: &Path, name: &str) -> Vec<f64> {
    let rows = rows(log);
    let cell = |row: &Vec<(String, String)>| {
        let found = row.iter().find(|(own, _)| own == name).unwrap();
        found.1.parse().unwrap_or(f64::NAN)
    };
    rows.iter().map(cell).collect()
}

/// What holds whatever happened.
pub fn check(ran: &Ran) {
    let Ran {
        folder,
        summary,
        report,
    } = ran;
    assert_eq!(report.wrong, 0, "every line that was sent has its check");
    let within = |drive: &f64| (0.0..=8.0).contains(drive) || *drive == SAFE;
    assert!(report.drives.iter().all(|(_, drive)| within(drive)));
    assert_eq!(report.drive, SAFE, "{:?}", summary.end);
    let log = folder.path().join("run.csv");
    let numbers = column(&log, "sample");
    assert_eq!(numbers.len() as u64, summary.samples);
    assert!(numbers.windows(2).all(|pair| pair[0] < pair[1]));
    let times = column(&log, "time");
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
    let gaps = numbers
        .last()
        .map_or(0.0, |last| last - numbers[0] + 1.0 - numbers.len() as f64);
    assert!(summary.lost as f64 >= gaps);
    // The drive of a row is the command of an earlier one, or the safe one.
    let (drives, commands) = (column(&log, "drive"), column(&log, "command"));
    for (n, drive) in drives.iter().enumerate() {
        assert!(
            *drive == SAFE || commands[..n].contains(drive),
            "{n} {drive}"
        );
    }
    assert_eq!(summary.end == End::Done, summary.end.code() == 0);
}

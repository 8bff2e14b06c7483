//! Somebody stops a run, or its log cannot be written.

use super::bench::{PID, config, folder};
use super::device::{SAFE, start};
use hysteron_bench::{End, Options, Stop, run};

#[test]
fn whoever_stops_a_run_leaves_the_drive_safe() {
    let folder = folder();
    let (address, served) = start(vec![]);
    let config = config(&folder, PID, &format!("tcp = '{address}'"));
    let stop = Stop::default();
    let mut count = 0;
    let mut observe = |_: &hysteron_bench::Seen<'_>| {
        count += 1;
        if count == 25 {
            stop.stop();
        }
    };
    let found = run(
        &config,
        &Options::default(),
        &stop,
        &mut |_| {},
        &mut observe,
    )
    .unwrap();
    let report = served.join().unwrap();
    assert_eq!(
        (&found.end, found.samples, found.end.code()),
        (&End::Stopped, 25, 130)
    );
    assert_eq!((report.drive, report.quit), (SAFE, true));
}

#[cfg(unix)]
#[test]
fn a_log_that_cannot_be_written_ends_a_run() {
    use std::io::{BufRead, BufReader};
    let folder = folder();
    // A pipe whose reader goes away is a disk that is full.
    let path = folder.path().join("pipe");
    let mode = rustix::fs::Mode::from_raw_mode(0o600);
    rustix::fs::mknodat(rustix::fs::CWD, &path, rustix::fs::FileType::Fifo, mode, 0).unwrap();
    let there = path.clone();
    let reader = std::thread::spawn(move || {
        let lines = BufReader::new(std::fs::File::open(there).unwrap()).lines();
        lines.take(11).count()
    });
    let (address, served) = start(vec![]);
    let config = config(&folder, PID, &format!("tcp = '{address}'"));
    let options = Options {
        log: Some(path),
        ..Options::default()
    };
    // The run waits here until the reader has gone: on a busy machine it may be the slower one.
    let mut reader = Some(reader);
    let mut count = 0;
    let mut observe = |_: &hysteron_bench::Seen<'_>| {
        count += 1;
        if let Some(reader) = reader.take_if(|_| count == 20) {
            assert_eq!(reader.join().unwrap(), 11);
        }
    };
    let stop = Stop::default();
    let found = run(&config, &options, &stop, &mut |_| {}, &mut observe).unwrap();
    let report = served.join().unwrap();
    assert!(matches!(found.end, End::Log(_)), "{}", found.end);
    assert_eq!((report.drive, report.quit), (SAFE, true));
}

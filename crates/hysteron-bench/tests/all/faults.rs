//! What cables, sensors and boards do, and what a run makes of it.

use super::bench::{PID, Ran, bench, column, config, folder, plain};
use super::device::{Fault, SAFE};
use hysteron_bench::{End, Options};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn drives(ran: &Ran) -> Vec<f64> {
    column(&ran.folder.path().join("run.csv"), "command")
}

/// The table of docs/measured/bench-faults.md:
/// `cargo test -p hysteron-bench --test all -- --nocapture every_fault`.
#[test]
fn every_fault_ends_as_it_has_to() {
    let plain = drives(&bench(PID, &[]));
    println!("| Fault | Times | Drive | Samples lost | End |\n| --- | --- | --- | --- | --- |");
    let seven = |fault: Fault| (0..7).map(|n| (12 + 6 * n, fault)).collect::<Vec<_>>();
    type Case = (&'static str, Vec<(u64, Fault)>, &'static str);
    let cases: [Case; 15] = [
        ("none", vec![], "done"),
        ("a sample is dropped", seven(Fault::Drop), "done"),
        ("a sample comes twice", seven(Fault::Double), "done"),
        (
            "a sample comes late, out of order",
            seven(Fault::Old),
            "done",
        ),
        ("a bit turns", seven(Fault::Corrupt), "done"),
        ("half a line comes", seven(Fault::Cut), "done"),
        ("500 lines of nonsense", seven(Fault::Flood), "done"),
        ("a sample is 60 ms late", seven(Fault::Delay(60)), "done"),
        ("a drive is dropped", seven(Fault::NoDrive), "done"),
        ("a reading is `nan`", seven(Fault::Nan(1)), "done"),
        ("a spike of 50", seven(Fault::Spike(50.0)), "done"),
        ("the sensor stands still", vec![(20, Fault::Stuck)], "stuck"),
        (
            "readings are `nan` for good",
            vec![(20, Fault::Nan(10_000))],
            "lost",
        ),
        ("the device freezes", vec![(20, Fault::Freeze)], "lost"),
        ("the line breaks", vec![(20, Fault::Kill)], "closed"),
    ];
    for (name, faults, end) in cases {
        let ran = bench(PID, &faults);
        assert_eq!(ran.summary.end.word(), end, "{name}: {}", ran.summary.end);
        let commands = drives(&ran);
        let highest = commands.iter().copied().fold(0.0, f64::max);
        let drive = match end {
            "done" => "goes on",
            _ => "safe",
        };
        println!(
            "| {name} | {} | {drive}, at most {highest:.2} | {} | {end} |",
            faults.len(),
            ran.summary.lost
        );
        // No fault drives to the limit, which the plain run does not come near.
        let usual = plain.iter().copied().fold(0.0, f64::max);
        assert!(usual < 7.5 && highest < 7.9, "{name}: {highest}");
        if end == "done" {
            let lost = ran.summary.samples + ran.summary.lost;
            assert!((59..=61).contains(&lost), "{name}: {lost}");
        }
    }
}

#[test]
fn a_spike_does_not_move_the_drive() {
    let plain = drives(&bench(PID, &[]));
    for size in [-1e6, -3.0, 2.0, 1e6] {
        for at in [15, 30, 31, 55] {
            let spiked = drives(&bench(PID, &[(at, Fault::Spike(size))]));
            let pairs = plain.iter().zip(&spiked);
            let moved = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            // The feedback holds for one sample; what it would have moved by is all that differs.
            assert!(moved < 0.4, "{size} at {at}: {moved}");
        }
    }
}

#[test]
fn the_devices_word_ends_a_run() {
    let ran = bench(PID, &[(20, Fault::Ends)]);
    assert_eq!(ran.summary.end, End::Device("limit".into()));
    assert_eq!(ran.summary.end.code(), 6);
}

#[test]
fn an_output_beyond_its_limits_ends_a_run() {
    let text = PID.replace("slew = 40", "slew = 40, output = [-1, 8]");
    let ran = bench(&text, &[]);
    assert!(matches!(ran.summary.end, End::Limit(output) if output > 8.0));
    assert_eq!(drives(&ran).last(), Some(&SAFE));
    // A spike alone is not the output.
    let calm = text.replace("duration_s = 3", "duration_s = 1");
    let spiked = bench(&calm, &[(15, Fault::Spike(50.0))]);
    assert_eq!(spiked.summary.end, End::Done);
}

#[test]
fn random_faults_leave_the_drive_safe_and_the_log_whole() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    for case in 0..40 {
        let count = rng.random_range(1..8);
        let faults: Vec<(u64, Fault)> = (0..count)
            .map(|_| {
                let fault = match rng.random_range(0..16) {
                    0 => Fault::Drop,
                    1 => Fault::Double,
                    2 => Fault::Corrupt,
                    3 => Fault::Cut,
                    4 => Fault::Old,
                    5 => Fault::Flood,
                    6 => Fault::Delay(rng.random_range(1..100)),
                    7 => Fault::Nan(rng.random_range(1..20)),
                    8 | 9 => Fault::Spike(10f64.powi(rng.random_range(-2..8))),
                    10 => Fault::Stuck,
                    11 | 12 => Fault::NoDrive,
                    13 => Fault::Freeze,
                    14 => Fault::Kill,
                    _ => Fault::Ends,
                };
                (rng.random_range(1..60), fault)
            })
            .collect();
        // `bench` checks what holds whatever happens.
        let ran = bench(PID, &faults);
        let gone = |(_, fault): &(u64, Fault)| fault.is_fatal() && *fault != Fault::Stuck;
        let fatal = faults.iter().any(gone);
        assert!(!fatal || ran.summary.end != End::Done, "{case}: {faults:?}");
    }
}

/// A profile that takes 5 s there and back, twice.
fn record(faults: &[(u64, Fault)], more: &str) -> Ran {
    let text = format!(
        "mode = 'record'
log = 'run.csv'
limits = {{ drive = [0.3, 7.7] }}
safety = {{ lost_s = 0.4{more} }}
profile = {{ table = 'slow.csv' }}
"
    );
    bench(&text, faults)
}

#[test]
fn a_profile_that_moves_nothing_ends_with_its_first_sweep() {
    let short = ", stuck_s = 1";
    assert_eq!(record(&[], short).summary.end, End::Done);
    // The last reading is one of the first: nothing is known of what moved.
    for fault in [Fault::Stuck, Fault::Jam] {
        let ran = record(&[(1, fault)], short);
        let End::Unmoved(found) = ran.summary.end else {
            panic!("{}", ran.summary.end);
        };
        let (first, last) = found.samples;
        assert!(first == 1 && (90..=101).contains(&last), "{found:?}");
        assert!(found.drives.0 < 0.6 && found.drives.1 > 7.4, "{found:?}");
        assert!(found.outputs.1 - found.outputs.0 < 0.008, "{found:?}");
        assert_eq!(ran.summary.samples, last);
        assert_eq!(drives(&ran).last(), Some(&SAFE));
        let said = ran.summary.end.to_string();
        assert!(
            said.starts_with("stuck: the output moved by no more"),
            "{said}"
        );
        assert_eq!(ran.summary.end.code(), 4);
        // A slow actuator has its time.
        let ran = record(&[(1, fault)], ", stuck_s = 7");
        assert!(matches!(ran.summary.end, End::Unmoved(found) if found.samples.1 >= 140));
    }
    // Without `stuck_s` it has more time than this profile takes.
    assert_eq!(record(&[(1, Fault::Jam)], "").summary.end, End::Done);
    // One that moved may come to rest.
    assert_eq!(record(&[(60, Fault::Jam)], short).summary.end, End::Done);
}

/// Of the simulated ones the spring is the slowest: it takes a minute to become warm.
#[test]
fn simulated_plants_are_never_stopped() {
    let folder = folder();
    for (kind, most) in [("spring", 2.0), ("preisach", 150.0), ("wire", 1.0)] {
        for period in [3.0, 10.0, 30.0, 90.0] {
            for share in [0.6, 0.89, 0.91, 1.0] {
                let rows = (0..200).map(|n| {
                    let phase = std::f64::consts::TAU * f64::from(n) / period;
                    format!("{n},{}\n", share * most * (0.5 - 0.5 * phase.cos()))
                });
                let text = format!("time,drive\n{}", rows.collect::<String>());
                std::fs::write(folder.path().join("own.csv"), text).unwrap();
                let text = "mode = 'record'\nlog = 'run.csv'\nprofile = { table = 'own.csv' }\n";
                let device = format!("simulated = '{kind}'");
                let config = config(&folder, text, &device);
                let options = Options {
                    force: true,
                    ..Options::default()
                };
                let found = plain(&config, &options).unwrap();
                assert_eq!(found.end, End::Done, "{kind}: {share} in {period} s");
            }
        }
    }
}

//! A fault in a recording does no harm: with the command that is advised, a model errs on a clean
//! second recording at most 1.15 times as much as that of the clean one, or the recording is
//! refused. A clean recording comes out as it went in.

use crate::faulty::advised::{Came, advised, allowed, fit, plain, put};
use crate::faulty::clean;
use crate::faulty::fault::{FAULTS, Fault};
use hysteron::{PrepareOptions, Progress, Recording, prepare, range};

/// Recordings with each fault.
const SEEDS: u64 = 4;
/// Whether a preparation can mend it. Other faults can only be refused, and so are rows that are
/// missing where the input turned.
fn mended(fault: Fault) -> bool {
    use Fault::{Bursts, ClockForward, Held, Noise, Quantised, Spikes, Zeros};
    matches!(
        fault,
        Spikes | Bursts | Zeros | Held | ClockForward | Quantised | Noise
    )
}

fn no_harm(pair: &[Recording; 2]) {
    let [first, second] = pair;
    let clean = plain(first, second, &fit()).unwrap();
    let mut harmed = Vec::new();
    for fault in FAULTS {
        let mut refused = 0;
        for seed in 0..SEEDS {
            let dirty = put(fault, first, seed);
            match advised(&dirty, second, &fit()) {
                Ok(Came::To(error)) => {
                    let allowed = allowed(fault, pair, clean, seed).unwrap();
                    if error > allowed {
                        let what = format!("{}, seed {seed}", fault.name());
                        harmed.push(format!("{what}: {error:.3}, allowed {allowed:.3}"));
                    }
                }
                Ok(Came::Refused(why)) => {
                    assert!(!why.is_empty());
                    refused += 1;
                }
                Err(_) => refused += 1,
            }
        }
        // To refuse all would keep the bound, too.
        assert!(
            !mended(fault) || 2 * refused <= SEEDS,
            "{fault:?}: {refused} of {SEEDS} are refused"
        );
    }
    assert_eq!(harmed, [""; 0], "clean {clean:.3}");
}

#[test]
fn faults_in_a_recording_of_a_spring_do_no_harm() {
    no_harm(&clean::spring().unwrap());
}

#[test]
fn faults_in_a_recording_of_plays_do_no_harm() {
    no_harm(&clean::plays(1).unwrap());
}

#[test]
fn faults_in_another_recording_of_plays_do_no_harm() {
    no_harm(&clean::plays(2).unwrap());
}

#[test]
fn the_noise_is_told() {
    let [first, _] = clean::plays(1).unwrap();
    for seed in 0..SEEDS {
        let dirty = put(Fault::Noise, &first, seed);
        let (_, report) = prepare(&dirty, &PrepareOptions::default(), Progress::NONE).unwrap();
        let found = [report.input_noise, report.output_noise];
        for (found, values) in found.into_iter().zip([&first.input, &first.output]) {
            let (low, high) = range(values);
            let share = found / (high - low);
            assert!((0.004..0.0125).contains(&share), "{share}");
        }
    }
}
#[test]
fn a_clean_recording_comes_out_as_it_went_in() {
    let mut clean = vec![("a spring".to_owned(), clean::spring().unwrap().to_vec())];
    for seed in 0..20 {
        clean.push((
            format!("plays {seed}"),
            clean::plays(seed).unwrap().to_vec(),
        ));
    }
    for (name, recordings) in clean {
        for recording in recordings {
            let prepared = prepare(&recording, &PrepareOptions::default(), Progress::NONE);
            assert_eq!(prepared.unwrap().0, recording, "{name}");
        }
    }
}

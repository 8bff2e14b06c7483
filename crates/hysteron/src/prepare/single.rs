//! Repairs single readings: lost signs where they are asked for, and readings that were lost.

use super::change::Change;
use super::fill;
use super::judge::Judge;
use super::options::{PrepareOptions, Step};
use super::report::{Repairs, Spikes};
use super::sign;
use crate::recording::Recording;
use crate::series::lost::wrong;
use crate::series::spikes::usual_deviations;

pub(super) fn repair(
    work: &mut Recording,
    options: &PrepareOptions,
    judge: &mut Judge<'_>,
) -> Option<Spikes> {
    if !options.signs && options.spikes == Step::Off {
        return None;
    }
    let mut signs = [Vec::new(), Vec::new()];
    if options.signs {
        signs = [&mut work.input, &mut work.output].map(|values| sign::restore(values));
    }
    let deviations = match options.spikes {
        Step::Off => None,
        Step::Auto => Some(usual_deviations(work.len())),
        Step::Value(deviations) => Some(deviations),
    };
    let mut removed = [Vec::new(), Vec::new()];
    if let Some(deviations) = deviations {
        let how = options.spikes;
        let runs = how == Step::Auto;
        let [input, output] = [true, false].map(|input| lost(work, input, deviations, runs));
        if runs {
            judge.ignore(output.clone());
        }
        removed = [(true, input), (false, output)].map(|(input, found)| {
            if found.is_empty() || replace(work, input, &found, how, judge) {
                return found;
            }
            // Spikes alone, without bursts and held readings.
            let spikes = lost(work, input, deviations, false);
            let other = !spikes.is_empty() && spikes != found;
            match other && replace(work, input, &spikes, how, judge) {
                true => spikes,
                false => Vec::new(),
            }
        });
    }
    let [input, output] = [0, 1].map(|n| Repairs::new(&signs[n], &removed[n]));
    Some(Spikes {
        deviations,
        input,
        output,
    })
}

/// The recording without the wrong readings that the preparation would replace if asked to.
pub(super) fn without_wrong(recording: &Recording) -> Recording {
    let options = PrepareOptions {
        spikes: Step::Auto,
        ..PrepareOptions::all(Step::Off)
    };
    let mut mended = recording.clone();
    repair(&mut mended, &options, &mut Judge::new(recording));
    mended
}

/// The readings of the input or of the output that were lost, with `runs` in bursts and held too.
fn lost(work: &Recording, input: bool, deviations: f64, runs: bool) -> Vec<usize> {
    match input {
        true => wrong(&work.input, Some(&work.output), deviations, runs),
        false => wrong(&work.output, None, deviations, runs),
    }
}

/// Replaces what was lost of one series; what is left to the data, only if it helps. Returns
/// whether it did.
fn replace(
    work: &mut Recording,
    input: bool,
    lost: &[usize],
    how: Step,
    judge: &mut Judge<'_>,
) -> bool {
    let (name, change) = match input {
        true => (
            "spikes of the input",
            Change::Input(fill::input(work, lost)),
        ),
        false => (
            "spikes of the output",
            Change::Output(fill::output(work, lost)),
        ),
    };
    judge.offer(name, how, work, change)
}

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
    let usual = usual_deviations(work.len());
    let deviations = match options.spikes {
        Step::Off => None,
        Step::Auto => Some(usual),
        Step::Value(deviations) => Some(deviations),
    };
    let mut outputs = None;
    if options.spikes == Step::Auto {
        let suspect = wrong(&work.output, None, usual, true);
        judge.ignore(suspect.clone());
        outputs = Some(suspect);
    }
    let mut of = |input: bool, known: Option<Vec<usize>>| {
        let how = options.spikes;
        let removed = deviations.map(|above| remove(work, input, (how, above), known, judge));
        Repairs::new(&signs[usize::from(!input)], &removed.unwrap_or_default())
    };
    Some(Spikes {
        deviations,
        input: of(true, None),
        output: of(false, outputs),
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

/// Replaces what was lost of one series. What is left to the data is taken with bursts and held
/// readings, or with spikes alone, or not at all. What is lost with bursts may be `known`.
fn remove(
    work: &mut Recording,
    input: bool,
    (how, deviations): (Step, f64),
    mut known: Option<Vec<usize>>,
    judge: &mut Judge<'_>,
) -> Vec<usize> {
    let kinds: &[bool] = match how {
        Step::Auto => &[true, false],
        _ => &[false],
    };
    let mut tried = Vec::new();
    for runs in kinds {
        let found = known.take().unwrap_or_else(|| match input {
            true => wrong(&work.input, Some(&work.output), deviations, *runs),
            false => wrong(&work.output, None, deviations, *runs),
        });
        if found.is_empty() || found == tried {
            break;
        }
        let (name, change) = match input {
            true => (
                "spikes of the input",
                Change::Input(fill::input(work, &found)),
            ),
            false => (
                "spikes of the output",
                Change::Output(fill::output(work, &found)),
            ),
        };
        if judge.offer(name, how, work, change) {
            return found;
        }
        tried = found;
    }
    Vec::new()
}

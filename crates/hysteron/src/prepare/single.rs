//! Repairs single readings: lost signs where they are asked for, and spikes.

use super::judge::Judge;
use super::options::{PrepareOptions, Step};
use super::report::{Repairs, Spikes};
use super::sign;
use crate::recording::Recording;
use crate::series::jumps::remove_bursts;
use crate::series::spikes::{self, DEVIATIONS};

/// Rounds of one repair: a spike beside another one is seen only when that one is gone.
const ROUNDS: usize = 4;

pub(super) fn repair(
    work: &mut Recording,
    options: &PrepareOptions,
    judge: &mut Judge<'_>,
) -> Option<Spikes> {
    if !options.signs && options.spikes == Step::Off {
        return None;
    }
    let deviations = match options.spikes {
        Step::Off => None,
        Step::Auto => Some(DEVIATIONS),
        Step::Value(deviations) => Some(deviations),
    };
    let mut signs = [Vec::new(), Vec::new()];
    if options.signs {
        signs = [&mut work.input, &mut work.output].map(|values| sign::restore(values));
    }
    let mut of = |signs: &[usize], name, series: fn(&mut Recording) -> &mut Vec<f64>| {
        let spikes = deviations
            .map(|deviations| remove(work, name, series, options.spikes, deviations, judge));
        Repairs::new(signs, &spikes.unwrap_or_default())
    };
    Some(Spikes {
        deviations,
        input: of(&signs[0], "spikes of the input", |work| &mut work.input),
        output: of(&signs[1], "spikes of the output", |work| &mut work.output),
    })
}

/// Replaces the spikes of one series. Those that are left to the data are taken with bursts, or
/// without them, or not at all.
fn remove(
    work: &mut Recording,
    name: &'static str,
    series: fn(&mut Recording) -> &mut Vec<f64>,
    how: Step,
    deviations: f64,
    judge: &mut Judge<'_>,
) -> Vec<usize> {
    let kinds: &[bool] = match how {
        Step::Auto => &[true, false],
        _ => &[false],
    };
    let mut tried = None;
    for bursts in kinds {
        let mut candidate = work.clone();
        let values = series(&mut candidate);
        let mut found = Vec::new();
        for _ in 0..if how == Step::Auto { ROUNDS } else { 1 } {
            let before = found.len();
            if *bursts {
                found.extend(remove_bursts(values));
            }
            found.extend(spikes::remove(values, deviations));
            if found.len() == before {
                break;
            }
        }
        found.sort_unstable();
        found.dedup();
        if tried.as_ref() == Some(&found) {
            break;
        }
        if judge.offer(name, how, work, candidate) {
            return found;
        }
        tried = Some(found);
    }
    Vec::new()
}

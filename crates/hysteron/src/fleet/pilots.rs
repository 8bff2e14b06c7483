//! The pilots of a fleet: actuators spread over the data, whose choices the others take.

use super::choice::{FleetChoice, FleetShared};
use super::one::{Ready, guarded};
use super::options::FleetOptions;
use super::palette::Palette;
use super::reading::{Job, Reading};
use super::signs::Signs;
use super::sources::Source;
use crate::error::Result;
use crate::identify::Chosen;
use crate::parallel;
use crate::progress::{Progress, ended_by_callback};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

/// Of a smaller fleet each actuator chooses for itself.
const FEWEST: usize = 24;

/// Number of actuators that may be pilots.
const MOST: usize = 32;

/// So many pilots choose first. As many more say whether the choice serves them; if it does not,
/// they choose too, and others are asked.
const ASKED: usize = 8;

/// So many of those asked may not be served: they are fitted by themselves then.
const UNSERVED: usize = 1;

/// What the pilots choose for all; `None` where each actuator chooses for itself.
///
/// # Errors
/// The error that `progress` returns.
pub(super) fn choose(
    sources: &[Source],
    options: &FleetOptions<'_>,
    ended: &AtomicBool,
    progress: Progress<'_>,
) -> Result<Option<FleetShared>> {
    let timed = options.columns.time.is_some();
    if options.choice == FleetChoice::Each || !options.fit.leaves_choices(timed) {
        return Ok(None);
    }
    // A fit that the callback ends is no fit that fails.
    ended_by_callback(progress, |progress| {
        asked(sources, options, ended, progress)
    })
}

/// As [`choose`], where there is something to choose.
fn asked(
    sources: &[Source],
    options: &FleetOptions<'_>,
    ended: &AtomicBool,
    progress: Progress<'_>,
) -> Result<Option<FleetShared>> {
    let found = match options.by {
        Some(_) => of_tables(sources, options, ended, progress)?,
        None => of_files(sources, options, ended),
    };
    let mut found = found.unwrap_or_default().into_iter();
    let mut palette = Palette::default();
    let mut pilots: Vec<Ready> = Vec::new();
    let mut shared: Option<FleetShared> = None;
    loop {
        let share = pilots.len() as f64 / MOST as f64;
        let report = |_: &'static str, _: f64| progress.tell("pilots", share);
        let progress = Progress::new(&report);
        let jobs: Vec<Job> = found.by_ref().take(ASKED).collect();
        if jobs.is_empty() {
            return Ok(shared);
        }
        let asked = parallel::map(jobs.len(), |n| own(&jobs[n], options, progress))?;
        let asked: Vec<_> = asked.into_iter().flatten().collect();
        let begin = pilots.len();
        let mut chosen = Vec::new();
        for (ready, choice, error) in asked {
            pilots.push(ready);
            chosen.push(choice);
            palette.add(error);
        }
        let tested = |pilot: usize, chosen: &Chosen| {
            progress.tell("pilots", share)?;
            let tested = || Ok(pilots[pilot].tested_with(chosen, options, progress));
            Ok(guarded(tested).unwrap_or(Signs::NONE))
        };
        palette.fill(tested)?;
        let before = palette.shared();
        let kinds = |shared: &FleetShared| -> Vec<Chosen> {
            let kinds = shared.kinds.iter();
            kinds.map(|kind| kind.chosen.clone()).collect()
        };
        let known = before.as_ref().map(|(shared, _)| kinds(shared));
        let ratios = before.map(|(_, ratios)| ratios).unwrap_or_default();
        let is_served = |n: usize| ratios.get(begin + n).is_some_and(|r| Palette::serves(*r));
        let unserved: Vec<usize> = (0..chosen.len()).filter(|n| !is_served(*n)).collect();
        let few = unserved.len() <= UNSERVED;
        for n in unserved {
            palette.suggest(chosen[n].clone());
        }
        palette.fill(tested)?;
        shared = palette.shared().map(|(shared, _)| shared);
        // Those that are not served may have no choice that serves more than one of them.
        if begin > 0 && (few || shared.as_ref().map(kinds) == known) {
            return Ok(shared);
        }
    }
}

type Own = (Ready, Chosen, f64);

/// What a pilot chooses by itself; `None` for one that cannot be fitted.
fn own(job: &Job, options: &FleetOptions<'_>, progress: Progress<'_>) -> Result<Option<Own>> {
    progress.tell("pilots", f64::NAN)?;
    let Ok((recording, notes)) = &job.recording else {
        return Ok(None);
    };
    let own = || {
        let ready = Ready::new(recording.clone(), notes, options, progress)?;
        let (chosen, error) = ready.own_choice(options, progress)?;
        Ok((ready, chosen, error))
    };
    let found: Result<Own> = guarded(own);
    Ok(found.ok().filter(|(.., error)| error.is_finite()))
}

/// Of files, no others are read.
fn of_files(
    sources: &[Source],
    options: &FleetOptions<'_>,
    ended: &AtomicBool,
) -> Option<Vec<Job>> {
    if sources.len() < FEWEST {
        return None;
    }
    let drawn = sources.iter().map(|source| (lot(&source.name), source));
    let mut drawn: Vec<([u8; 32], &Source)> = drawn.collect();
    drawn.sort_by_key(|(lot, _)| *lot);
    let drawn = drawn.into_iter().take(MOST);
    let drawn: Vec<Source> = drawn.map(|(_, source)| source.clone()).collect();
    let mut reading = Reading::new(&drawn, options, ended);
    Some(std::iter::from_fn(|| reading.next()).collect())
}

/// Of tables, all are read, and few are held.
fn of_tables(
    sources: &[Source],
    options: &FleetOptions<'_>,
    ended: &AtomicBool,
    progress: Progress<'_>,
) -> Result<Option<Vec<Job>>> {
    let whole: u64 = sources.iter().map(|source| source.bytes).sum();
    let mut reading = Reading::new(sources, options, ended);
    let (mut drawn, mut count) = (BTreeMap::new(), 0);
    while let Some(job) = reading.next() {
        let share = job.bytes as f64 / whole.max(1) as f64;
        count += 1;
        drawn.insert(lot(&job.id), job);
        if drawn.len() > MOST {
            drawn.pop_last();
        }
        if count >= FEWEST {
            progress.tell("reading", share.min(1.0))?;
        }
    }
    Ok((count >= FEWEST).then(|| drawn.into_values().collect()))
}

/// The lot of an actuator: those with the smallest ones are pilots. They are spread over the data
/// whatever its order, and are the same in each run. Equal distances would miss a kind that comes at
/// the same distances.
fn lot(id: &str) -> [u8; 32] {
    Sha256::digest(id).into()
}

//! Parts a recording: what is fitted, and what is held out to test the fit.

use crate::error::{Error, Result};
use crate::recording::Recording;
use crate::series::{Runs, branch_spans, range, usual_tolerance};
use std::ops::{Range, RangeInclusive};
use std::str::FromStr;

/// The largest share of the branches that can be held out. Beyond it, neighbours would be left out
/// together, and the turning point between them with both.
const MOST: f64 = 1.0 / 3.0;

/// Branches with fewer samples than this are not held out.
const SHORTEST: usize = 3;

/// An end stands for the rest where its input moves over this share of the whole range at least.
/// The last loops of an input that dies down would be easier than most.
const ALIKE: f64 = 0.5;

/// What takes no part in a fit, to test it.
///
/// A text says it as on the command line: `branches:20%` or just `20%`, `rows:100-200`, or
/// `rows:100-200,350-400`.
///
/// ```
/// use hysteron::HoldOut;
/// assert_eq!("branches:20%".parse::<HoldOut>()?, HoldOut::Branches(0.2));
/// assert_eq!("20%".parse::<HoldOut>()?, HoldOut::Branches(0.2));
/// assert_eq!("rows:100-200".parse::<HoldOut>()?, HoldOut::Rows(vec![100..=200]));
/// assert_eq!("rows:1-9,20-30".parse::<HoldOut>()?, HoldOut::Rows(vec![1..=9, 20..=30]));
/// assert!("rows:100".parse::<HoldOut>().is_err());
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub enum HoldOut {
    /// This share of the branches, above 0 and up to a third. They are spread over the recording,
    /// in turn rising and falling. The first branch is not among them. For a model that depends on
    /// time they are the last ones, because such a model needs every sample before a row; see
    /// [`crate::fit_holding_out`].
    Branches(f64),
    /// The rows of these spans, counted from 1, through all recordings one after the other.
    Rows(Vec<RangeInclusive<usize>>),
    /// Other recordings, as a whole.
    Recordings(Vec<Recording>),
    /// A part of the recordings fitted, and other recordings as a whole: see [`HoldOut::together`].
    Both(Box<HoldOut>, Vec<Recording>),
}

impl HoldOut {
    /// A part of the recordings fitted together with other recordings; `None` for neither.
    ///
    /// ```
    /// use hysteron::{HoldOut, Recording};
    /// let other = Recording::new(vec![0.0, 1.0, 0.0], vec![0.0, 2.0, 1.0])?;
    /// let what = HoldOut::together(Some("20%".parse()?), vec![other]);
    /// assert!(matches!(what, Some(HoldOut::Both(..))));
    /// assert_eq!(HoldOut::together(None, Vec::new()), None);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    #[must_use]
    pub fn together(part: Option<Self>, recordings: Vec<Recording>) -> Option<Self> {
        match (part, recordings.is_empty()) {
            (None, true) => None,
            (None, false) => Some(Self::Recordings(recordings)),
            (Some(part), true) => Some(part),
            (Some(part), false) => Some(Self::Both(part.into(), recordings)),
        }
    }

    /// What is held out of the recordings fitted; `None` for nothing of them.
    #[must_use]
    pub fn part(&self) -> Option<&Self> {
        match self {
            Self::Branches(_) | Self::Rows(_) => Some(self),
            Self::Recordings(_) => None,
            Self::Both(part, _) => part.part(),
        }
    }

    /// The other recordings that are held out.
    #[must_use]
    pub fn recordings(&self) -> Vec<&Recording> {
        match self {
            Self::Branches(_) | Self::Rows(_) => Vec::new(),
            Self::Recordings(all) => all.iter().collect(),
            Self::Both(part, all) => part.recordings().into_iter().chain(all).collect(),
        }
    }
}

impl FromStr for HoldOut {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let needed = |what: &str| Error::Fit(format!("`{text}` cannot be held out: {what}"));
        let share = text.trim().ends_with('%').then_some(("branches", text));
        match text.split_once(':').or(share) {
            Some(("branches", share)) => {
                let number = share.trim().trim_end_matches('%').trim_end().parse::<f64>();
                let percent = number
                    .ok()
                    .filter(|percent| (0.0..=100.0).contains(percent));
                let percent =
                    percent.ok_or_else(|| needed("a share is needed, such as `branches:20%`"))?;
                Ok(Self::Branches(percent / 100.0))
            }
            Some(("rows", rows)) => {
                let span = |text: &str| {
                    let (first, last) = text.split_once('-')?;
                    Some(first.trim().parse().ok()?..=last.trim().parse().ok()?)
                };
                let spans = rows.split(',').map(span).collect::<Option<_>>();
                let spans = spans
                    .ok_or_else(|| needed("two row numbers are needed, such as `rows:100-200`"))?;
                Ok(Self::Rows(spans))
            }
            _ => Err(needed(
                "`branches:20%`, `rows:100-200` or another recording is needed",
            )),
        }
    }
}

/// A recording in two parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Split {
    /// What is left to be fitted: a recording for each part between rows that are held out.
    pub training: Vec<Recording>,
    /// For each sample of the whole recording, whether it is held out.
    pub held_out: Vec<bool>,
    /// Whether a recording in `training` begins after rows that were held out. The state of the
    /// operators is not known there.
    pub begins_inside: bool,
    /// Whether `training` is the beginning of the recording without a gap.
    pub is_head: bool,
}

impl Recording {
    /// Parts the recording. No output that is held out is in the training part. Where only other
    /// recordings are held out, all of this one is there.
    ///
    /// A branch is held out without the turning point at its end, because the next branch begins
    /// there. So the operators remember the same with and without that branch: its input is
    /// monotone, apart from reversals up to [`usual_tolerance`].
    ///
    /// ```
    /// use hysteron::{HoldOut, Recording};
    /// let input: Vec<f64> = [0, 1, 2, 3, 2, 1, 0, 1, 2, 3].map(f64::from).to_vec();
    /// let recording = Recording::new(input.clone(), input)?;
    /// let split = recording.split(&HoldOut::Branches(0.3))?;
    /// // The last branch, from 0 up to 3. Its first sample is a turning point, and stays.
    /// assert_eq!(split.training[0].input, [0.0, 1.0, 2.0, 3.0, 2.0, 1.0, 0.0]);
    /// let split = recording.split(&HoldOut::Rows(vec![8..=10]))?;
    /// assert_eq!(split.training[0].len(), 7);
    /// assert!(split.held_out[7..].iter().all(|held_out| *held_out));
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Fit`] for a share or rows out of range, for rows that leave nothing, or if there
    /// are fewer than three branches.
    pub fn split(&self, what: &HoldOut) -> Result<Split> {
        self.check()?;
        match what {
            HoldOut::Branches(share) => self.split_branches(*share),
            HoldOut::Rows(rows) => Ok(self.parted(marked(rows, self.len())?)),
            HoldOut::Both(part, _) => self.split(part),
            HoldOut::Recordings(_) => Ok(Split {
                training: vec![self.clone()],
                held_out: vec![false; self.len()],
                begins_inside: false,
                is_head: true,
            }),
        }
    }

    /// Only the samples for which `kept` is true; `None` if there are none.
    #[must_use]
    pub fn only(&self, kept: impl Fn(usize) -> bool) -> Option<Self> {
        let kept: Runs<bool> = (0..self.len()).map(kept).collect();
        let spans = || kept.iter().filter(|(_, is_kept)| *is_kept);
        spans().next()?;
        let pick = |series: &[f64]| {
            let parts = spans().map(|(samples, _)| &series[samples]);
            parts.collect::<Vec<_>>().concat()
        };
        let first = kept.iter().next().is_some_and(|(_, is_kept)| is_kept);
        Some(Self {
            rest: self.rest.filter(|_| first),
            ..self.picked(pick)
        })
    }

    /// Only these samples.
    pub(crate) fn part(&self, samples: Range<usize>) -> Self {
        let rest = self.rest.filter(|_| samples.start == 0);
        Self {
            rest,
            ..self.picked(|series| series[samples.clone()].to_vec())
        }
    }

    /// Every series as it is picked.
    pub(crate) fn picked(&self, pick: impl Fn(&[f64]) -> Vec<f64>) -> Self {
        Self {
            time: self.time.as_deref().map(&pick),
            input: pick(&self.input),
            output: pick(&self.output),
            load: self.load.as_deref().map(&pick),
            input_quantity: self.input_quantity.clone(),
            output_quantity: self.output_quantity.clone(),
            load_quantity: self.load_quantity.clone(),
            origin: self.origin,
            source: self.source.clone(),
            undone: self.undone,
            rest: self.rest,
        }
    }

    /// The branches that can be held out, among `all`.
    fn branches(&self, share: f64) -> Result<(Vec<Range<usize>>, Vec<usize>)> {
        if !(share > 0.0 && share <= MOST + 1e-9) {
            return Err(Error::Fit(format!(
                "{} % of the branches cannot be held out: take more than 0 and up to 33 %",
                100.0 * share
            )));
        }
        let all: Vec<Range<usize>> =
            branch_spans(&self.input, usual_tolerance(&self.input)).collect();
        let can_be: Vec<usize> = (1..all.len())
            .filter(|b| all[*b].len() >= SHORTEST)
            .collect();
        if all.len() < 3 || can_be.is_empty() {
            return Err(Error::Fit(format!(
                "the recording has {} branches: three or more are needed to hold one out; hold out \
                 rows or another recording",
                all.len()
            )));
        }
        Ok((all, can_be))
    }

    fn split_branches(&self, share: f64) -> Result<Split> {
        let (all, can_be) = self.branches(share)?;
        let mut held_out = vec![false; self.len()];
        for b in spread(&can_be, share, all.len()) {
            let last = b + 1 == all.len();
            let end = all[b].end - usize::from(!last);
            held_out[all[b].start..end].fill(true);
        }
        let training = self.only(|n| !held_out[n]).into_iter().collect();
        Ok(Split {
            training,
            is_head: false,
            begins_inside: false,
            held_out,
        })
    }

    /// As [`Recording::split`] with [`HoldOut::Branches`], but the last branches are held out. The
    /// rest is the recording's beginning.
    ///
    /// # Errors
    /// As [`Recording::split`].
    pub fn split_end(&self, share: f64) -> Result<Split> {
        self.check()?;
        let (all, can_be) = self.branches(share)?;
        let count = ((share * all.len() as f64).round() as usize).max(1);
        let held = &can_be[can_be.len().saturating_sub(count)..];
        let first = held.first().map_or(self.len(), |b| all[*b].start);
        Ok(self.parted((0..self.len()).map(|n| n >= first).collect()))
    }

    /// Whether the end behind so many samples is like the rest: its input stays within the range of
    /// the rest, and moves over a good part of it.
    fn end_is_alike(&self, first: usize) -> bool {
        let (low, high) = range(&self.input[..first]);
        let (from, to) = range(&self.input[first..]);
        let slight = usual_tolerance(&self.input);
        let is_within = from >= low - slight && to <= high + slight;
        is_within && to - from >= ALIKE * (high - low)
    }

    /// The parts on both sides of what is held out.
    fn parted(&self, held_out: Vec<bool>) -> Split {
        let mut training = Vec::new();
        let mut begins = Vec::new();
        let runs: Runs<bool> = held_out.iter().copied().collect();
        for (samples, _) in runs.iter().filter(|(_, is_held_out)| !is_held_out) {
            begins.push(samples.start);
            training.push(self.part(samples));
        }
        Split {
            begins_inside: begins.iter().any(|begin| *begin > 0),
            is_head: begins.iter().all(|begin| *begin == 0),
            training,
            held_out,
        }
    }
}

/// Parts each recording as [`Recording::split`] does. Rows are counted through all of them, and may
/// hold a whole recording out.
pub(crate) fn split_each(recordings: &[Recording], what: &HoldOut) -> Result<Vec<Split>> {
    let Some(HoldOut::Rows(rows)) = what.part() else {
        return recordings.iter().map(|one| one.split(what)).collect();
    };
    recordings.iter().try_for_each(Recording::check)?;
    let lengths = recordings.iter().map(Recording::len);
    let mut held_out = marked(rows, lengths.sum())?.into_iter();
    let parted = |one: &Recording| one.parted(held_out.by_ref().take(one.len()).collect());
    Ok(recordings.iter().map(parted).collect())
}

/// Each recording parted as [`Recording::split_end`] does, and whether every end is like the rest;
/// `None` where something else than [`HoldOut::Branches`] is held out.
pub(crate) fn split_ends(
    recordings: &[Recording],
    what: &HoldOut,
) -> Result<Option<(Vec<Split>, bool)>> {
    let Some(HoldOut::Branches(share)) = what.part() else {
        return Ok(None);
    };
    let ends = recordings.iter().map(|one| one.split_end(*share));
    let ends = ends.collect::<Result<Vec<_>>>()?;
    let first = |split: &Split| split.training.first().map_or(0, Recording::len);
    let mut pairs = recordings.iter().zip(&ends);
    let are_alike = pairs.all(|(one, split)| one.end_is_alike(first(split)));
    Ok(Some((ends, are_alike)))
}

/// Which of so many rows are in these spans.
fn marked(rows: &[RangeInclusive<usize>], count: usize) -> Result<Vec<bool>> {
    if rows.is_empty() {
        return Err(Error::Fit(
            "no rows are named that are to be held out".into(),
        ));
    }
    let mut held_out = vec![false; count];
    for span in rows {
        let refused = || {
            Error::Fit(format!(
                "rows {} to {} cannot be held out: there are rows 1 to {count}, and some have to \
                 be left",
                span.start(),
                span.end(),
            ))
        };
        let samples = (1 <= *span.start() && span.start() <= span.end())
            .then(|| held_out.get_mut(span.start() - 1..*span.end()));
        samples.flatten().ok_or_else(refused)?.fill(true);
        if held_out.iter().all(|held| *held) {
            return Err(refused());
        }
    }
    Ok(held_out)
}

/// Branches spread over those that can be held out, no two of them neighbours. Neighbouring
/// branches differ in direction, so numbers in turn even and odd are directions in turn.
fn spread(can_be: &[usize], share: f64, all: usize) -> Vec<usize> {
    let most = can_be.len().div_ceil(3);
    let count = ((share * all as f64).round() as usize).clamp(1, most);
    let stride = can_be.len() as f64 / count as f64;
    let mut found: Vec<usize> = Vec::new();
    for k in 0..count {
        let place = ((k as f64 + 0.5) * stride) as usize;
        let other = |b: &usize| found.last().is_none_or(|last| (b - last) % 2 == 1);
        let apart = |b: &usize| found.last().is_none_or(|last| *b > last + 1);
        let from_here = || {
            can_be[place.min(can_be.len() - 1)..]
                .iter()
                .take(2)
                .copied()
        };
        let choice = from_here().find(|b| apart(b) && other(b));
        found.extend(choice.or_else(|| from_here().find(apart)));
    }
    found
}

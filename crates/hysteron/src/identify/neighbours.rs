//! Whether a reading agrees with its neighbours in input and branch, whatever a model says.

use crate::recording::Recording;
use crate::series::{branch_spans, range, usual_tolerance};
use std::ops::Range;

/// Inputs that differ by less than this share of their range are the same.
const SAME: f64 = 1e-4;

/// Beyond the end of a branch, the output may go on this many times as steeply.
const STEEPER: f64 = 2.0;
/// And for at most this many times the distance of the readings that it is known from.
const REACH: f64 = 2.0;

/// The readings of a recording, of which some are suspect.
pub(super) struct Neighbours<'a> {
    recording: &'a Recording,
    /// The samples of each branch.
    branches: Vec<Range<usize>>,
    /// Samples that are suspect, ascending.
    suspect: Vec<usize>,
    /// Those of them that were measured again.
    repeated: Vec<usize>,
    /// Outputs that differ by less are the same.
    same: f64,
}

impl<'a> Neighbours<'a> {
    /// `same` is the largest distance between outputs that agree.
    pub(super) fn new(recording: &'a Recording, suspect: &[(usize, f64)], same: f64) -> Self {
        let branches = match suspect.is_empty() {
            true => Vec::new(),
            false => branch_spans(&recording.input, usual_tolerance(&recording.input)).collect(),
        };
        let mut neighbours = Self {
            recording,
            branches,
            suspect: suspect.iter().map(|(sample, _)| *sample).collect(),
            repeated: Vec::new(),
            same,
        };
        neighbours.repeated = neighbours.find_repeated();
        neighbours
    }

    /// Whether a suspect reading is data: it was measured again, or lies between the readings
    /// before and after it on its branch. At a turning point, it may also be where the branch on
    /// one side leads to.
    pub(super) fn agree(&self, sample: usize) -> bool {
        if self.repeated.binary_search(&sample).is_ok() {
            return true;
        }
        let Some(branch) = self.branch_of(sample) else {
            return false;
        };
        // The turning point where a branch begins is the last sample of the branch before it.
        let own = &self.branches[branch];
        let first = own.start.saturating_sub(1);
        let before = self.trusted((first..sample).rev());
        let after = self.trusted(sample + 1..own.end);
        if let ([a, ..], [b, ..]) = (before.as_slice(), after.as_slice()) {
            return self.within(sample, self.output(*a), self.output(*b));
        }
        let beyond = match self.branches.get(branch + 1) {
            Some(next) if after.is_empty() => self.trusted(sample + 1..next.end),
            _ => after,
        };
        [before, beyond].iter().any(|side| match side[..] {
            [a, b] => self.within(sample, self.output(a), self.led_to(sample, a, b)),
            _ => false,
        })
    }

    /// The first two of the samples that are not suspect.
    fn trusted(&self, samples: impl Iterator<Item = usize>) -> Vec<usize> {
        let trusted = samples.filter(|n| self.suspect.binary_search(n).is_err());
        trusted.take(2).collect()
    }

    fn output(&self, sample: usize) -> f64 {
        self.recording.output[sample]
    }

    fn within(&self, sample: usize, a: f64, b: f64) -> bool {
        let (low, high) = (a.min(b) - self.same, a.max(b) + self.same);
        (low..=high).contains(&self.output(sample))
    }

    /// The output that the line through two readings leads to at the input of a sample, or the
    /// furthest that it may lead to.
    fn led_to(&self, sample: usize, near: usize, far: usize) -> f64 {
        let input = &self.recording.input;
        let run = input[near] - input[far];
        let slope = match run {
            0.0 => 0.0,
            run => (self.output(near) - self.output(far)) / run,
        };
        // Two readings close together tell nothing about an input far away.
        let reach = REACH * run.abs();
        let way = (input[sample] - input[near]).clamp(-reach, reach);
        self.output(near) + STEEPER * slope * way
    }

    fn branch_of(&self, sample: usize) -> Option<usize> {
        let place = self.branches.partition_point(|own| own.end <= sample);
        (place < self.branches.len()).then_some(place)
    }

    /// Whether the input rises on a branch.
    fn rises(&self, branch: usize) -> bool {
        let own = &self.branches[branch];
        let first = own.start.saturating_sub(1);
        self.recording.input[own.end - 1] > self.recording.input[first]
    }

    /// The suspect readings that at least half of the other visits to the same input in the same
    /// direction agree with. A visit is what one branch has there: readings in a row that agree are
    /// one excursion, and prove nothing.
    fn find_repeated(&self) -> Vec<usize> {
        let Recording { input, output, .. } = self.recording;
        let (low, high) = range(input);
        let near = SAME * (high - low);
        let mut suspects = self.suspect.clone();
        suspects.sort_by(|a, b| input[*a].total_cmp(&input[*b]));
        let own: Vec<_> = suspects.iter().map(|n| self.branch_of(*n)).collect();
        let rises: Vec<bool> = (0..self.branches.len()).map(|n| self.rises(n)).collect();
        let mut visits: Vec<Vec<Visit>> = vec![Vec::new(); suspects.len()];
        for (branch, samples) in self.branches.iter().enumerate() {
            for n in samples.clone() {
                let from = suspects.partition_point(|s| input[*s] < input[n] - near);
                let close = suspects[from..]
                    .iter()
                    .take_while(|s| input[**s] <= input[n] + near);
                for (k, sample) in (from..).zip(close) {
                    let other = own[k].filter(|own| *own != branch);
                    if other.is_none_or(|own| rises[own] != rises[branch]) {
                        continue;
                    }
                    if visits[k].last().is_none_or(|last| last.branch != branch) {
                        visits[k].push(Visit {
                            branch,
                            readings: 0,
                            agree: 0,
                        });
                    }
                    if let Some(visit) = visits[k].last_mut() {
                        visit.readings += 1;
                        let apart = (output[n] - output[*sample]).abs();
                        visit.agree += u32::from(apart <= self.same);
                    }
                }
            }
        }
        let is_repeated = |visits: &[Visit]| {
            let agree = visits
                .iter()
                .filter(|visit| 2 * visit.agree > visit.readings);
            let agree = agree.count();
            agree > 0 && 2 * agree >= visits.len()
        };
        let pairs = suspects.into_iter().zip(&visits);
        let mut repeated: Vec<usize> = pairs
            .filter(|(_, visits)| is_repeated(visits))
            .map(|(sample, _)| sample)
            .collect();
        repeated.sort_unstable();
        repeated
    }
}

/// What a branch has at the input of a suspect reading.
#[derive(Clone)]
struct Visit {
    branch: usize,
    readings: u32,
    /// Those of them that agree with it.
    agree: u32,
}

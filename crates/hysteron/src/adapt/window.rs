//! Which of the past samples a refit uses: the last cycles of the input, or a number of samples.

use super::sums::{Row, Sums};
use crate::error::{Error, Result};
use crate::identify::{SparseForm, Term};
use crate::model::OperatorState;
use crate::series::Turning;
use hysteron_core::Direction;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use std::ops::Range;

/// The input turns where it comes back by more than this share of the plane.
pub(super) const TURN: f64 = 0.1;

/// A window of cycles is at least this share as wide as the widest of so many times as many cycles.
/// So a small loop does not make a refit forget the large one before it.
const COVERED: f64 = 0.9;
const REACH: usize = 8;

/// Largest number of samples in a window. Beyond it the oldest leave, whatever the cycle.
pub(super) const MOST: usize = 1 << 16;

/// The sums are computed anew after so many times the window's samples have left it. So rounding
/// errors do not add up, and it costs a sixteenth of a sample for each sample.
const ANEW: usize = 16;

/// The samples that a refit uses.
///
/// **Cycles.** The last cycle begins where the input last passed its present value in its present
/// direction. So it has each input of the present branch once, on the way up and on the way down.
/// The input turns where it comes back by more than a tenth of the plane. Smaller reversals belong
/// to the branch they are on. Where the last cycle is small, the window takes in the cycles before
/// it, until it is nine tenths as wide as the widest of the last eight. The width of a cycle is the
/// lesser of its way there and its way back. Until the first cycle is complete, the window has all
/// samples.
///
/// It is written `cycles:1` or `samples:500`, and so it is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub enum Window {
    /// So many of the last cycles of the input, from 1.
    Cycles(usize),
    /// So many of the last samples, from 2.
    Samples(usize),
}

impl Default for Window {
    fn default() -> Self {
        Self::Cycles(1)
    }
}

impl Serialize for Window {
    fn serialize<S: serde::Serializer>(
        &self,
        serializer: S,
    ) -> std::result::Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl std::fmt::Display for Window {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Cycles(count) => write!(f, "cycles:{count}"),
            Self::Samples(count) => write!(f, "samples:{count}"),
        }
    }
}

impl std::str::FromStr for Window {
    type Err = Error;

    /// `cycles:N` or `samples:N`.
    fn from_str(text: &str) -> Result<Self> {
        let window = text.split_once(':').and_then(|(what, count)| {
            let count = count.parse().ok()?;
            match what {
                "cycles" => Some(Self::Cycles(count)),
                "samples" => Some(Self::Samples(count)),
                _ => None,
            }
        });
        let window = window.filter(|window| window.is_usable());
        window
            .ok_or_else(|| Error::Fit(format!("`window` is `{text}`: it must be {}", Self::RANGE)))
    }
}

impl TryFrom<String> for Window {
    type Error = Error;

    fn try_from(text: String) -> Result<Self> {
        text.parse()
    }
}

impl Window {
    /// What there is, in words.
    pub(super) const RANGE: &str = "cycles:1 to cycles:1000, or samples:2 to samples:65536";

    pub(super) fn is_usable(self) -> bool {
        match self {
            Self::Cycles(count) => (1..=1000).contains(&count),
            Self::Samples(count) => (2..=MOST).contains(&count),
        }
    }
}

/// Samples on the same branch, from `first` to the next run.
#[derive(Debug, Clone)]
struct Run {
    first: usize,
    memory: Vec<Term>,
}

/// The samples of the window and their sums. Samples are counted from the beginning of time.
#[derive(Debug, Clone)]
pub(super) struct Samples {
    window: Window,
    /// The samples from `oldest` on, each with its position.
    kept: VecDeque<(Row, f64)>,
    oldest: usize,
    runs: VecDeque<Run>,
    /// Where the window begins.
    begin: usize,
    /// The samples that are in the sums.
    summed: Range<usize>,
    sums: Sums,
    /// Number of samples taken away since the sums were computed anew.
    taken: usize,
    tolerance: f64,
    turning: Turning,
    /// The turning points of the input and their positions. The last one begins the present branch.
    turns: VecDeque<(usize, f64)>,
    /// The sample that `turning` counts as the first.
    turning_from: usize,
    heading: Direction,
    /// [`OperatorState::held`] of the last sample, while the last run goes on.
    held: Option<usize>,
}

impl Samples {
    pub(super) fn new(window: Window, levels: usize, operators: usize) -> Self {
        let tolerance = TURN * levels as f64;
        Self {
            window,
            kept: VecDeque::new(),
            oldest: 0,
            runs: VecDeque::new(),
            begin: 0,
            summed: 0..0,
            sums: Sums::new(operators),
            taken: 0,
            tolerance,
            turning: Turning::new(tolerance),
            turns: VecDeque::new(),
            turning_from: 0,
            heading: Direction::Rising,
            held: None,
        }
    }

    /// Number of samples in the window.
    pub(super) fn len(&self) -> usize {
        self.end() - self.begin
    }

    fn end(&self) -> usize {
        self.oldest + self.kept.len()
    }

    /// Forgets all samples.
    pub(super) fn clear(&mut self) {
        let end = self.end();
        self.kept.clear();
        self.runs.clear();
        self.sums.clear();
        (self.oldest, self.begin, self.summed) = (end, end, end..end);
        self.taken = 0;
        self.break_off();
    }

    /// Tells that others moved the state: the next sample continues no branch.
    pub(super) fn break_off(&mut self) {
        self.turning = Turning::new(self.tolerance);
        self.turning_from = self.end();
        self.turns.clear();
        self.held = None;
    }

    /// Follows the state where no sample enters the window. What was remembered of the branch holds
    /// until a turning point comes or goes.
    pub(super) fn follow(&mut self, state: &OperatorState) {
        if self.held != Some(state.held()) {
            self.held = None;
        }
    }

    /// Takes a sample in. Returns whether the input turned.
    pub(super) fn push(&mut self, form: &SparseForm, state: &OperatorState, output: f64) -> bool {
        let (now, position) = (self.end(), state.position());
        self.follow(state);
        let terms = match self.held {
            Some(_) => form.row(state, None),
            None => {
                let mut memory = Vec::new();
                let terms = form.row(state, Some(&mut memory));
                self.runs.push_back(Run { first: now, memory });
                self.held = Some(state.held());
                terms
            }
        };
        self.kept.push_back((Row { terms, output }, position));
        let turned = self.turn(position);
        self.advance(position);
        self.forget();
        turned
    }

    /// Whether the input turned, at a sample that may be some way back.
    fn turn(&mut self, position: f64) -> bool {
        let Some((index, heading)) = self.turning.push(position) else {
            return false;
        };
        self.heading = heading;
        let turn = self.turning_from + index;
        let place = turn.checked_sub(self.oldest);
        let at = place.and_then(|place| self.kept.get(place));
        self.turns.push_back((turn, at.map_or(position, |at| at.1)));
        let needed = match self.window {
            Window::Cycles(count) => 2 * REACH * count + 1,
            Window::Samples(_) => 1,
        };
        while self.turns.len() > needed {
            self.turns.pop_front();
        }
        // The start of the series is no turn.
        self.turns.len() > 1 || matches!(self.window, Window::Samples(_)) && index > 0
    }

    /// Moves the beginning of the window on.
    fn advance(&mut self, position: f64) {
        let end = self.end();
        match self.window {
            Window::Samples(count) => self.begin = self.begin.max(end.saturating_sub(count)),
            Window::Cycles(count) => {
                self.begin = self.begin.max(end.saturating_sub(MOST));
                let Some(old) = self.first_branch(count, position) else {
                    return;
                };
                self.begin = self.begin.max(self.turns[old].0);
                let passed = |at: f64| match self.heading {
                    Direction::Rising => at < position,
                    Direction::Falling => at > position,
                };
                while self.begin < self.turns[old + 1].0
                    && passed(self.kept[self.begin - self.oldest].1)
                {
                    self.begin += 1;
                }
            }
        }
    }

    /// The turning point that begins the branch on which a window of `count` cycles begins.
    fn first_branch(&self, count: usize, position: f64) -> Option<usize> {
        let present = self.turns.len().checked_sub(1)?;
        let range = |from: usize| {
            let turns = self.turns.range(from..).map(|turn| turn.1);
            let (low, high) = turns.fold((position, position), |(low, high), at| {
                (low.min(at), high.max(at))
            });
            high - low
        };
        let places = || self.turns.iter().map(|turn| turn.1).chain([position]);
        let ways = || places().zip(places().skip(1)).map(|(a, b)| (a - b).abs());
        let widths = ways().zip(ways().skip(1)).map(|(a, b)| a.min(b));
        let covered = COVERED * widths.fold(0.0, f64::max);
        let most = REACH * count;
        (count..=most)
            .map_while(|cycles| Some((cycles, present.checked_sub(2 * cycles)?)))
            .find(|(cycles, branch)| *cycles == most || range(branch + 1) >= covered)
            .map(|(_, branch)| branch)
    }

    /// Drops the samples that are neither in the window nor in the sums.
    fn forget(&mut self) {
        if self.begin >= self.summed.end {
            if !self.summed.is_empty() {
                self.sums.clear();
                self.taken = 0;
            }
            self.summed = self.begin..self.begin;
        }
        while self.oldest < self.summed.start.min(self.begin) {
            self.kept.pop_front();
            self.oldest += 1;
        }
        while self.runs.get(1).is_some_and(|run| run.first <= self.oldest) {
            self.runs.pop_front();
        }
    }

    /// The sums over the samples of the window.
    pub(super) fn sums(&mut self) -> &Sums {
        let Range { start, end } = self.summed;
        self.taken += self.begin - start;
        if self.taken > ANEW * self.len() {
            self.sums.clear();
            self.taken = 0;
            self.add(1.0, self.begin..self.end());
        } else {
            self.add(-1.0, start..self.begin);
            self.add(1.0, end..self.end());
        }
        self.summed = self.begin..self.end();
        self.forget();
        &self.sums
    }

    fn add(&mut self, sign: f64, range: Range<usize>) {
        let ends = self.runs.iter().skip(1).map(|run| run.first);
        for (run, end) in self.runs.iter().zip(ends.chain([usize::MAX])) {
            let (from, to) = (run.first.max(range.start), end.min(range.end));
            if from < to {
                let rows = self.kept.range(from - self.oldest..to - self.oldest);
                self.sums.add(sign, &run.memory, rows.map(|(row, _)| row));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::model::{Model, Plane, Sign};
    use hysteron_core::{Operator, operators};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// A window, and all that ever came into it: states, outputs and positions.
    struct Trial {
        samples: Samples,
        form: SparseForm,
        model: Model,
        state: OperatorState,
        seen: Vec<(Vec<f64>, f64, f64)>,
    }

    impl Trial {
        fn new(window: Window, levels: usize, operator: Operator) -> Self {
            let plane = Plane::new(0.0, 1.0, levels).unwrap();
            let weights = vec![1.0; plane.operators()];
            let model = Model::new(operator, plane, weights, 0.0, Sign::Positive).unwrap();
            Self {
                samples: Samples::new(window, levels, plane.operators()),
                form: SparseForm::new(plane, operator).unwrap(),
                state: model.plain().unwrap().start(),
                model,
                seen: Vec::new(),
            }
        }

        fn go(&mut self, input: f64) {
            let core = self.model.plain().unwrap();
            core.step(&mut self.state, input).unwrap();
            self.samples.follow(&self.state);
        }

        fn push(&mut self, input: f64, output: f64) {
            self.go(input);
            self.samples.push(&self.form, &self.state, output);
            let levels = self.model.plane().levels();
            let of = |(i, j)| self.state.gamma(i, j).unwrap();
            let states = operators(levels).map(of).collect();
            self.seen.push((states, output, self.state.position()));
        }

        /// The sums over the window against those from the states themselves.
        fn check(&mut self) {
            let begin = self.samples.begin;
            let found = self.samples.sums().centred(&self.form);
            let rows = &self.seen[begin..];
            let Some(found) = found else {
                assert!(rows.is_empty());
                return;
            };
            let (count, n) = (rows[0].0.len(), rows.len() as f64);
            let mean = |k: usize| rows.iter().map(|row| row.0[k]).sum::<f64>() / n;
            let means: Vec<f64> = (0..count).map(mean).collect();
            let output = rows.iter().map(|row| row.1).sum::<f64>() / n;
            // At most 18 windows of 90 samples have been added or taken away, each with products
            // of size three in some of N² corners, and N² corners make an element: 18 · 90 · 3 ·
            // 28² roundings of 1e-16.
            let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-9, "{a} {b}");
            for a in 0..count {
                let products = rows
                    .iter()
                    .map(|row| (row.0[a] - means[a]) * (row.1 - output));
                close(found.right[a], products.sum());
                for b in 0..count {
                    let products = rows
                        .iter()
                        .map(|row| (row.0[a] - means[a]) * (row.0[b] - means[b]));
                    close(found.gram[a * count + b], products.sum());
                }
            }
            let weights: Vec<f64> = (0..count).map(|k| k as f64 / count as f64).collect();
            let at_means: f64 = means.iter().zip(&weights).map(|(m, w)| m * w).sum();
            close(found.offset(&weights), output - at_means);
        }
    }

    #[test]
    fn sums_added_and_taken_away_are_those_computed_anew() {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        for round in 0..60 {
            let window = match round % 2 {
                0 => Window::Samples(rng.random_range(2..90)),
                _ => Window::Cycles(rng.random_range(1..4)),
            };
            let operator = [Operator::Mkp, Operator::Kp, Operator::Relay][round % 3];
            let mut trial = Trial::new(window, rng.random_range(2..8), operator);
            let often = [0.5, 0.05, 0.005][round / 6 % 3];
            let (mut x, mut heading) = (0.0_f64, 0.2);
            for _ in 0..rng.random_range(20..1500) {
                if !(0.0..1.0).contains(&x) || rng.random_bool(0.05) {
                    heading = if x > 0.5 { -heading } else { 0.2 };
                }
                x += heading * rng.random_range(-0.2..1.0);
                let jump = rng.random_bool(0.01);
                let input = if jump { rng.random_range(-0.5..1.5) } else { x };
                match rng.random_range(0..1000) {
                    0 => {
                        trial.samples.clear();
                        trial.check();
                    }
                    1 => {
                        trial.model.plain().unwrap();
                        trial.state = trial.model.plain().unwrap().start();
                        trial.samples.break_off();
                    }
                    2..100 => trial.go(input),
                    _ => trial.push(input, rng.random_range(-1.0..2.0)),
                }
                if rng.random_bool(often) {
                    trial.check();
                }
            }
            trial.check();
            let kept = trial.samples.kept.len();
            assert!(kept <= 2 * trial.samples.len() + 2 || matches!(window, Window::Cycles(_)));
        }
    }

    /// Between 0.1 and 0.9, with a ripple below a tenth of the plane.
    #[test]
    fn a_cycle_begins_where_the_input_last_was_here_in_this_direction() {
        for cycles in 1..4 {
            let mut trial = Trial::new(Window::Cycles(cycles), 20, Operator::Mkp);
            let period = 200;
            for n in 0..1500 {
                let turn = std::f64::consts::TAU * n as f64 / period as f64;
                let ripple = if n % 40 == 0 { 0.04 } else { 0.0 };
                trial.push(0.5 - 0.4 * turn.cos() + ripple * turn.sin(), 0.0);
                let length = trial.samples.len();
                let whole = cycles * period;
                match n < whole {
                    // No cycle is complete: all samples.
                    true => assert_eq!(length, n + 1),
                    // It takes a tenth of the plane to see a turn, 41 samples; a ripple leaves the
                    // window some samples early.
                    false if n >= whole + 50 => {
                        assert!(length.abs_diff(whole) < 50, "{n}: {length} for {whole}");
                    }
                    false => {}
                }
            }
        }
    }

    /// One cycle over the plane, then small ones.
    #[test]
    fn a_small_cycle_does_not_drop_the_large_one_at_once() {
        let mut trial = Trial::new(Window::Cycles(1), 20, Operator::Mkp);
        let wave = |n: usize| 0.5 - 0.5 * (std::f64::consts::TAU * n as f64 / 100.0).cos();
        for n in 0..300 {
            trial.push(wave(n), 0.0);
        }
        assert!(trial.samples.len().abs_diff(100) < 30);
        // The large cycle is among the last eight, or the ninth before it is known to have turned.
        for n in 0..2000 {
            trial.push(0.3 * wave(n), 0.0);
            let length = trial.samples.len();
            match n {
                ..=700 => assert!(length >= n + 50, "{n}: {length}"),
                1000.. => assert!(length.abs_diff(100) < 30, "{n}: {length}"),
                _ => {}
            }
        }
    }

    /// The same cycle, on another part of the plane: the way there is no cycle.
    #[test]
    fn a_cycle_that_moved_is_the_last_cycle() {
        let mut trial = Trial::new(Window::Cycles(1), 20, Operator::Mkp);
        let wave = |n: usize| 0.2 - 0.2 * (std::f64::consts::TAU * n as f64 / 100.0).cos();
        for n in 0..1000 {
            let moved = if n < 500 { 0.0 } else { 0.5 };
            trial.push(moved + wave(n), 0.0);
            if n >= 650 {
                assert!(trial.samples.len() < 130, "{n}: {}", trial.samples.len());
            }
        }
    }

    #[test]
    fn a_window_is_read_as_it_is_written() {
        for window in [Window::Cycles(3), Window::Samples(500), Window::default()] {
            assert_eq!(window.to_string().parse::<Window>().unwrap(), window);
        }
        for wrong in [
            "",
            "cycles",
            "cycles:0",
            "samples:1",
            "samples:1e3",
            "days:3",
            "cycles:-1",
        ] {
            let said = wrong.parse::<Window>().unwrap_err().to_string();
            assert!(said.contains("must be cycles:1 to"), "{wrong}: {said}");
        }
    }
}

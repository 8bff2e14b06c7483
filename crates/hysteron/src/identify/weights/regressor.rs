//! The regressor of a whole experiment: several recordings, each with its own start, and weights
//! that may depend on the load.
//!
//! A **column** belongs to one operator. It is the part of the operator's weight that starts on in
//! certain recordings and off in the others. With a known start there is one column per operator.
//!
//! With an unknown start, consider an operator whose state the first sample does not determine. The
//! product `ν` of weight and initial state is between 0 and `μ`. Since
//! `Φ_off μ + (Φ_on − Φ_off) ν = Φ_off (μ − ν) + Φ_on ν`, this is a column that starts off and one
//! that starts on, both with non-negative weights. Over several recordings the set `0 ≤ ν_s ≤ μ` is
//! the cone of all patterns of on and off. [`Regressor::take_missing`] finds the patterns that
//! reduce the error.

use crate::error::Result;
use crate::identify::initial::Initial;
use crate::identify::options::FitOptions;
use crate::identify::weights::column::Column;
use crate::identify::weights::corner_gram::{CornerGram, CornerSums, OfBlocks};
use crate::identify::weights::experiment::Experiment;
use crate::identify::weights::gram::{Gram, MANY};
use crate::identify::weights::layout::{Block, Layout};
use crate::identify::weights::nested::Squares;
use crate::identify::weights::room::check_dense;
use crate::identify::weights::rows::Term;
use crate::identify::weights::sparse::{OPEN, SparseForm, Square};
use crate::model::Plane;
use crate::model::Start;
use crate::progress::Progress;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// Columns in blocks, and the function of the load and the start of each block.
type Blocks = (Arc<Layout>, Vec<(usize, Initial)>);

/// The columns of the regressor. Its products are computed from the samples of an experiment.
pub(crate) struct Regressor {
    form: SparseForm,
    /// For each operator, bit `s` is set if the first sample of recording `s` does not determine
    /// its state. Empty if the start is known.
    open: Vec<u64>,
    columns: Vec<Column>,
    /// Where searches begin, once one was made.
    squares: OnceLock<Arc<Squares>>,
    /// The state of the operators that do not start on.
    known: Initial,
    /// Number of operators whose state the first sample of some recording does not determine.
    pub(crate) open_at_start: usize,
}

impl Regressor {
    pub(crate) fn new(plane: Plane, options: &FitOptions, experiment: &Experiment) -> Result<Self> {
        let form = SparseForm::new(plane, options.operator)?;
        let mut regressor = Self {
            form,
            open: Vec::new(),
            open_at_start: 0,
            columns: Vec::new(),
            squares: OnceLock::new(),
            known: match options.initial() {
                // Columns say themselves that they start on.
                Initial::On => Initial::Off,
                known => known,
            },
        };
        let on = match options.start {
            Start::On => u64::MAX,
            _ => 0,
        };
        let operators = regressor.form.operators();
        let all =
            |on| move |part| (0..operators).map(move |operator| Column { part, operator, on });
        let parts = 0..experiment.parts.len();
        regressor.columns = parts.clone().flat_map(all(on)).collect();
        let open = regressor.undetermined(experiment)?;
        regressor.open_at_start = open.iter().filter(|on| **on != 0).count();
        if options.start == Start::Unknown {
            let on = |part| {
                let some = open.iter().enumerate().filter(|(_, on)| **on != 0);
                some.map(move |(operator, &on)| Column { part, operator, on })
            };
            regressor.columns.extend(parts.flat_map(on));
            regressor.open = open;
        }
        Ok(regressor)
    }

    /// For each operator, the recordings whose first sample does not determine its state.
    fn undetermined(&self, experiment: &Experiment) -> Result<Vec<u64>> {
        let mut open = vec![0; self.form.operators()];
        for (s, range) in experiment.recordings.iter().enumerate() {
            let parts = self.form.open(experiment.input[range.start])?;
            for (open, part) in open.iter_mut().zip(parts) {
                *open |= u64::from(part > OPEN) << s;
            }
        }
        Ok(open)
    }

    /// The states from which operators can start.
    fn initials(&self) -> [Initial; 2] {
        [self.known, Initial::On]
    }

    /// The state from which the operator of a column starts in a recording.
    pub(super) fn initial(&self, column: &Column, recording: usize) -> Initial {
        match column.is_on_in(recording) {
            true => Initial::On,
            false => self.known,
        }
    }

    pub(super) fn unknown_start(&self) -> bool {
        !self.open.is_empty()
    }

    pub(super) fn form(&self) -> &SparseForm {
        &self.form
    }

    pub(crate) fn plane(&self) -> &Plane {
        self.form.plane()
    }

    pub(crate) fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Where a search for smooth weights from zero begins.
    pub(super) fn squares(&self) -> Arc<Squares> {
        let squares = || Arc::new(Squares::new(&self.columns, self.plane().levels()));
        self.squares.get_or_init(squares).clone()
    }

    /// Number of functions of the load.
    pub(crate) fn parts(&self) -> usize {
        self.columns.iter().map(|c| c.part + 1).max().unwrap_or(0)
    }

    /// The weights for each function of the load, summed over all patterns of starts.
    pub(crate) fn weights(&self, x: &[f64]) -> Vec<Vec<f64>> {
        let mut weights = vec![vec![0.0; self.form.operators()]; self.parts()];
        for (column, x) in self.columns.iter().zip(x) {
            weights[column.part][column.operator] += x;
        }
        weights
    }

    /// `A x` at every sample.
    pub(crate) fn forward(&self, experiment: &Experiment, x: &[f64]) -> Result<Vec<f64>> {
        let mut output = vec![0.0; experiment.input.len()];
        for (s, range) in experiment.recordings.iter().enumerate() {
            for (part, values) in experiment.parts.iter().enumerate() {
                for from in self.initials() {
                    let mut weights = vec![0.0; self.form.operators()];
                    let mut any = false;
                    for (column, &x) in self.columns.iter().zip(x) {
                        if column.part == part && self.initial(column, s) == from && x != 0.0 {
                            weights[column.operator] += x;
                            any = true;
                        }
                    }
                    if any {
                        let input = &experiment.input[range.clone()];
                        let add = |n: usize, h: f64| {
                            output[range.start + n] += values[range.start + n] * h;
                        };
                        self.form.forward(&weights, input, from, add)?;
                    }
                }
            }
        }
        Ok(output)
    }

    /// `Aᵀ r`, where `residual` gives `r` at a sample.
    pub(crate) fn adjoint(
        &self,
        experiment: &Experiment,
        residual: impl Fn(usize) -> f64,
    ) -> Result<Vec<f64>> {
        let all = self.adjoints(experiment, residual, 1, |_| Some(0))?;
        Ok(all.into_iter().next().unwrap_or_default())
    }

    /// `Aᵀ r` over the samples of each of `count` groups. Samples without a group do not count.
    pub(crate) fn adjoints(
        &self,
        experiment: &Experiment,
        residual: impl Fn(usize) -> f64,
        count: usize,
        group: impl Fn(usize) -> Option<usize>,
    ) -> Result<Vec<Vec<f64>>> {
        let mut results = vec![vec![0.0; self.columns.len()]; count];
        // Recordings in which all columns start in the same way share their sums.
        for recordings in self.alike(experiment) {
            let all = self.products(experiment, recordings.clone(), &residual, count, &group)?;
            for (result, products) in results.iter_mut().zip(all) {
                for (result, column) in result.iter_mut().zip(&self.columns) {
                    let from = self.initial(column, recordings.start);
                    *result += products.product(column.part, from, column.operator);
                }
            }
        }
        Ok(results)
    }

    /// For each of the coefficients `x`, `A x` at the samples of its group; zero at samples without
    /// a group.
    pub(crate) fn forwards(
        &self,
        experiment: &Experiment,
        x: &[Vec<f64>],
        group: impl Fn(usize) -> Option<usize>,
    ) -> Result<Vec<f64>> {
        let mut output = vec![0.0; experiment.input.len()];
        for (s, range) in experiment.recordings.iter().enumerate() {
            let starts = self.starts(s);
            for (part, values) in experiment.parts.iter().enumerate() {
                for &from in &starts {
                    let corners = |x: &Vec<f64>| {
                        let mut weights = vec![0.0; self.form.operators()];
                        for (column, x) in self.columns.iter().zip(x) {
                            if column.part == part && self.initial(column, s) == from {
                                weights[column.operator] += x;
                            }
                        }
                        self.form.corners_of(&mut weights);
                        weights
                    };
                    let corners: Vec<Vec<f64>> = x.iter().map(corners).collect();
                    let own = |n: usize| group(range.start + n);
                    let add = |n: usize, h: f64| {
                        output[range.start + n] += values[range.start + n] * h;
                    };
                    let input = &experiment.input[range.clone()];
                    self.form.add_forward(input, from, &corners, own, add)?;
                }
            }
        }
        Ok(output)
    }

    /// Runs of recordings in which no column changes its start.
    pub(super) fn alike(&self, experiment: &Experiment) -> Vec<Range<usize>> {
        let count = experiment.recordings.len();
        // One recording per run, or all recordings in one run.
        let length = if self.unknown_start() {
            1
        } else {
            count.max(1)
        };
        (0..count).step_by(length).map(|s| s..s + length).collect()
    }

    /// The starts that columns have in the recording.
    pub(super) fn starts(&self, recording: usize) -> Vec<Initial> {
        let has = |from: &Initial| {
            self.columns
                .iter()
                .any(|column| self.initial(column, recording) == *from)
        };
        self.initials().into_iter().filter(has).collect()
    }

    fn products(
        &self,
        experiment: &Experiment,
        recordings: Range<usize>,
        residual: impl Fn(usize) -> f64,
        count: usize,
        group: impl Fn(usize) -> Option<usize>,
    ) -> Result<Vec<Products>> {
        let starts = self.starts(recordings.start);
        let mut all = vec![Vec::new(); count];
        for values in &experiment.parts {
            for &from in &starts {
                let mut sums = vec![vec![0.0; self.form.operators()]; count];
                for range in &experiment.recordings[recordings.clone()] {
                    let r = |n: usize| values[range.start + n] * residual(range.start + n);
                    let own = |n: usize| group(range.start + n);
                    let input = &experiment.input[range.clone()];
                    self.form.add_adjoints(input, from, r, own, &mut sums)?;
                }
                for (all, mut w) in all.iter_mut().zip(sums) {
                    self.form.operators_of(&mut w);
                    all.push(w);
                }
            }
        }
        let products = |sums| Products {
            starts: starts.clone(),
            sums,
        };
        Ok(all.into_iter().map(products).collect())
    }

    /// `Aᵀ A` over the samples of each of `count` groups, row by row, in one pass over the samples.
    /// Samples without a group do not count.
    pub(crate) fn grams(
        &self,
        experiment: &Experiment,
        count: usize,
        group: impl Fn(usize) -> Option<usize>,
        progress: Progress<'_>,
    ) -> Result<Vec<Vec<f64>>> {
        let (operators, columns) = (self.form.operators(), self.columns.len());
        check_dense(columns)?;
        let mut grams = vec![Vec::new(); count];
        for recordings in self.alike(experiment) {
            let starts = self.starts(recordings.start);
            let pairs =
                (0..experiment.parts.len()).flat_map(|p| starts.iter().map(move |f| (p, *f)));
            let pairs: Vec<(usize, Initial)> = pairs.collect();
            for (g, &(p, from)) in pairs.iter().enumerate() {
                for &(q, other) in &pairs[g..] {
                    let mut blocks = vec![vec![0.0; operators * operators]; count];
                    for range in &experiment.recordings[recordings.clone()] {
                        let scale = |n: usize| {
                            let n = range.start + n;
                            experiment.parts[p][n] * experiment.parts[q][n]
                        };
                        let own = |n: usize| group(range.start + n);
                        let input = &experiment.input[range.clone()];
                        let starts = (from, other);
                        let mut squares: Vec<Square<'_>> = blocks
                            .iter_mut()
                            .map(|block| Square::new(block, operators))
                            .collect();
                        self.form
                            .add_outer(input, starts, scale, own, &mut squares, progress)?;
                    }
                    blocks.iter_mut().for_each(|block| self.form.gram_of(block));
                    if pairs.len() == 1 && !self.unknown_start() {
                        return Ok(blocks);
                    }
                    let members = |part, from| {
                        let columns = self.columns.iter().enumerate();
                        columns
                            .filter(move |(_, c)| {
                                c.part == part && self.initial(c, recordings.start) == from
                            })
                            .map(|(n, c)| (n, c.operator))
                            .collect::<Vec<_>>()
                    };
                    let (left, right) = (members(p, from), members(q, other));
                    for (gram, block) in grams.iter_mut().zip(blocks) {
                        gram.resize(columns * columns, 0.0);
                        for &(a, i) in &left {
                            for &(b, j) in &right {
                                let value = block[i * operators + j];
                                gram[a * columns + b] += value;
                                if (p, from) != (q, other) {
                                    gram[b * columns + a] += value;
                                }
                            }
                        }
                    }
                }
            }
        }
        Ok(grams)
    }

    /// As [`Regressor::grams`], in the form that solves faster.
    pub(crate) fn compact_grams(
        &self,
        experiment: &Experiment,
        count: usize,
        group: impl Fn(usize) -> Option<usize>,
        progress: Progress<'_>,
    ) -> Result<Vec<Gram>> {
        if self.columns.len() >= MANY
            && let Some(all) = self.corner_grams(experiment, count, &group, progress)?
        {
            return Gram::of_corners(all);
        }
        let all = self.grams(experiment, count, group, progress)?;
        Ok(all.into_iter().map(Gram::Dense).collect())
    }

    /// As [`Regressor::grams`], over corners; `None` where several recordings have unknown starts.
    pub(super) fn corner_grams(
        &self,
        experiment: &Experiment,
        count: usize,
        group: impl Fn(usize) -> Option<usize>,
        progress: Progress<'_>,
    ) -> Result<Option<Vec<CornerGram>>> {
        let Some((layout, blocks)) = self.layout(experiment) else {
            return Ok(None);
        };
        let mut all: Vec<CornerSums> = (0..count).map(|_| CornerSums::default()).collect();
        for (a, &(p, from)) in blocks.iter().enumerate() {
            for (b, &(q, other)) in blocks.iter().enumerate().skip(a) {
                let [left, right] = [a, b].map(|n| &layout.blocks[n].columns[..]);
                let mirror = a != b;
                let of = |sums| OfBlocks {
                    sums,
                    left,
                    right,
                    mirror,
                };
                let mut sums: Vec<OfBlocks<'_>> = all.iter_mut().map(of).collect();
                for range in &experiment.recordings {
                    let scale = |n: usize| {
                        let n = range.start + n;
                        experiment.parts[p][n] * experiment.parts[q][n]
                    };
                    let own = |n: usize| group(range.start + n);
                    let input = &experiment.input[range.clone()];
                    let starts = (from, other);
                    self.form
                        .add_outer(input, starts, scale, own, &mut sums, progress)?;
                }
            }
        }
        let all = all.into_iter().map(|sums| sums.into_gram(&layout));
        Ok(Some(all.collect()))
    }

    /// The columns in blocks of one function of the load and one start, where every recording
    /// starts in the same way.
    fn layout(&self, experiment: &Experiment) -> Option<Blocks> {
        if self.unknown_start() && experiment.recordings.len() > 1 {
            return None;
        }
        let mut kinds: Vec<(usize, Initial)> = Vec::new();
        let mut blocks: Vec<Block> = Vec::new();
        for (n, column) in self.columns.iter().enumerate() {
            let kind = (column.part, self.initial(column, 0));
            let place = kinds.iter().position(|other| *other == kind);
            let place = place.unwrap_or_else(|| {
                kinds.push(kind);
                blocks.push(Block {
                    part: column.part,
                    columns: vec![Term::NOWHERE; self.form.operators()],
                });
                blocks.len() - 1
            });
            blocks[place].columns[column.operator] = n as u32;
        }
        let layout = Layout::new(&self.form, &self.columns, blocks)?;
        Some((Arc::new(layout), kinds))
    }

    /// For each operator and each function of the load, finds the pattern of starts that reduces
    /// the error most. Adds its column if the descent is more than `slack`. Returns whether any
    /// column was added.
    ///
    /// `Σ_s max(Φ_offᵀ r, Φ_onᵀ r)_s − (P x)` is the steepest descent over all patterns. `slopes`
    /// is `P x`, one value per column.
    pub(crate) fn take_missing(
        &mut self,
        experiment: &Experiment,
        residual: &[f64],
        slopes: &[f64],
        slack: f64,
    ) -> Result<bool> {
        if !self.unknown_start() || experiment.recordings.len() < 2 {
            return Ok(false);
        }
        let all: Vec<Products> = self
            .alike(experiment)
            .into_iter()
            .map(|recordings| {
                let all = self.products(experiment, recordings, |n| residual[n], 1, |_| Some(0))?;
                Ok(all.into_iter().next())
            })
            .collect::<Result<Option<_>>>()?
            .unwrap_or_default();
        let before = self.columns.len();
        for part in 0..experiment.parts.len() {
            for operator in 0..self.form.operators() {
                // The first columns are those that start off, in this order. The penalty does not
                // depend on starts.
                let first = part * self.form.operators() + operator;
                let (mut on, mut descent) = (0, -slopes[first]);
                for (s, products) in all.iter().enumerate() {
                    let [off, started_on] = self
                        .initials()
                        .map(|from| products.product(part, from, operator));
                    let open = self.open[operator] >> s & 1 == 1;
                    on |= u64::from(open && started_on > off) << s;
                    descent += if open { off.max(started_on) } else { off };
                }
                let column = Column { part, operator, on };
                if descent > slack && !self.columns.contains(&column) {
                    self.columns.push(column);
                    self.squares = OnceLock::new();
                }
            }
        }
        Ok(self.columns.len() > before)
    }
}

/// `Φᵀ r` for each function of the load and each start.
struct Products {
    starts: Vec<Initial>,
    sums: Vec<Vec<f64>>,
}

impl Products {
    fn product(&self, part: usize, from: Initial, operator: usize) -> f64 {
        let place = self.starts.iter().position(|start| *start == from);
        place.map_or(f64::NEG_INFINITY, |place| {
            self.sums[part * self.starts.len() + place][operator]
        })
    }
}

//! `Aᵀ r` over units of samples, such as branches. With other signs of the units it is summed anew
//! without a pass over the samples.
//!
//! A unit touches few triangles of the plane, so its sums are kept sparse, before the prefix sums
//! ([`SparseForm::operators_of`](super::sparse::SparseForm::operators_of)). Those are linear, and
//! taken once for all units together.

use crate::error::Result;
use crate::identify::initial::Initial;
use crate::identify::weights::experiment::Experiment;
use crate::identify::weights::regressor::Regressor;
use crate::identify::weights::rows::Term;
use crate::identify::weights::units::Units;

/// The sums of every unit.
pub(crate) struct UnitSums {
    slots: Vec<Slot>,
}

/// The sums over recordings in which every column starts in the same way, for one function of the
/// load and one start.
struct Slot {
    part: usize,
    recording: usize,
    from: Initial,
    /// Units and their sums; a unit may occur several times.
    units: Vec<(usize, Vec<Term>)>,
}

impl UnitSums {
    /// The samples of a unit are next to each other.
    pub(crate) fn new(
        regressor: &Regressor,
        experiment: &Experiment,
        residual: &[f64],
        units: &Units,
    ) -> Result<Self> {
        let mut slots = Vec::new();
        for recordings in regressor.alike(experiment) {
            for (part, values) in experiment.parts.iter().enumerate() {
                for from in regressor.starts(recordings.start) {
                    let mut found = Vec::new();
                    for range in &experiment.recordings[recordings.clone()] {
                        let mut scratch = Scratch::new(regressor.form().operators());
                        let mut rows = regressor.form().rows(from)?;
                        let (mut held, mut at) = (0.0, None);
                        for n in range.clone() {
                            let left_branch = rows.leaves_branch(experiment.input[n])?;
                            let unit = units.unit(n);
                            if left_branch || unit != at {
                                scratch.add(rows.memory(), held);
                                held = 0.0;
                            }
                            if unit != at {
                                found.extend(at.map(|unit| (unit, scratch.take())));
                                at = unit;
                            }
                            if left_branch {
                                rows.remember();
                            }
                            if at.is_some() {
                                let r = values[n] * residual[n];
                                held += r;
                                scratch.add(&rows.branch(), r);
                            }
                        }
                        scratch.add(rows.memory(), held);
                        found.extend(at.map(|unit| (unit, scratch.take())));
                    }
                    slots.push(Slot {
                        part,
                        recording: recordings.start,
                        from,
                        units: found,
                    });
                }
            }
        }
        Ok(Self { slots })
    }

    /// `Aᵀ (s r)`, where `s` at each sample is the number in `signs` of its unit.
    pub(crate) fn with_signs(&self, regressor: &Regressor, signs: &[f64]) -> Vec<f64> {
        let columns = regressor.columns();
        let mut result = vec![0.0; columns.len()];
        let mut sums = vec![0.0; regressor.form().operators()];
        for slot in &self.slots {
            sums.fill(0.0);
            for (unit, terms) in &slot.units {
                for term in terms {
                    sums[term.place as usize] += signs[*unit] * term.factor;
                }
            }
            regressor.form().operators_of(&mut sums);
            for (result, column) in result.iter_mut().zip(columns) {
                if column.part == slot.part
                    && regressor.initial(column, slot.recording) == slot.from
                {
                    *result += sums[column.operator];
                }
            }
        }
        result
    }
}

/// Sums of one unit, and which of them are in use.
struct Scratch {
    sums: Vec<f64>,
    used: Vec<bool>,
    places: Vec<u32>,
}

impl Scratch {
    fn new(count: usize) -> Self {
        Self {
            sums: vec![0.0; count],
            used: vec![false; count],
            places: Vec::new(),
        }
    }

    fn add(&mut self, terms: &[Term], scale: f64) {
        for term in terms {
            let place = term.place as usize;
            self.sums[place] += scale * term.factor;
            if !self.used[place] {
                self.used[place] = true;
                self.places.push(term.place);
            }
        }
    }

    /// The sums, which begin anew.
    fn take(&mut self) -> Vec<Term> {
        let places = std::mem::take(&mut self.places);
        let term = |place: u32| {
            self.used[place as usize] = false;
            let factor = std::mem::take(&mut self.sums[place as usize]);
            Term { place, factor }
        };
        places.into_iter().map(term).collect()
    }
}

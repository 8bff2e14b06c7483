//! A model in the number type of the target.

use super::parts::Parts;
use super::real::{Number, unfit};
use super::rounding::missed;
use super::stages::{CSampling, Staged};
use super::written::CMemory;
use hysteron::{Model, Operator, Result, Sign};
use hysteron_core::{Plane, RATE_NUMBERS, Real, STATE_NUMBERS, table_len, turn_capacity};

/// What the C needs of a model, all of it computed by the core in that type.
pub(super) struct Constants<T> {
    pub(super) weights: Vec<T>,
    pub(super) core: hysteron_core::Model<T, Vec<T>>,
    pub(super) offset: T,
    pub(super) falls: bool,
    /// That of the inverse, where there is one.
    pub(super) rounding: Option<T>,
    /// What a target may be missed by that its inverse reports as reached, in the output's unit.
    pub(super) missed: Option<f64>,
    /// The stages around the operators, where there are any.
    pub(super) stages: Option<Staged<T>>,
    /// Turning points and input that the model starts with, where its fit found them.
    pub(super) start: Option<(Vec<T>, T)>,
}

impl<T: Number> Constants<T> {
    pub(super) fn new(model: &Model, sampling: &CSampling) -> Result<Self> {
        let convert = |what: &str, number: f64| {
            T::nearest(number).ok_or_else(|| unfit(&format!("{what} of {number:e}")))
        };
        let plane = model.plane();
        let (min, max) = (
            convert("a level", plane.min())?,
            convert("a level", plane.max())?,
        );
        let weights = model.weights().iter().map(|&mu| convert("a weight", mu));
        let weights = weights.collect::<Result<Vec<T>>>()?;
        let offset = convert("an offset", model.offset())?;
        let levels = plane.levels();
        let plane = Plane::new(min, max, levels).map_err(|_| unfit("the range of the levels"))?;
        let table = vec![T::ZERO; table_len(levels)];
        let core = hysteron_core::Model::new(plane, model.operator(), &weights, table)
            .map_err(|_| unfit("the sum of the weights"))?;
        let rounding = core.inverse().ok().map(|inverse| inverse.rounding());
        // Outputs of KP and relays reach twice as far, and sums of small weights have small
        // rounding.
        let (off, on) = core.output_range();
        let ends = [off + offset, on + offset, off - offset, on - offset];
        let small = rounding.is_some_and(|rounding| rounding > T::ZERO && rounding < T::SMALLEST);
        if small || !ends.into_iter().all(Real::is_finite) {
            return Err(unfit("the range of the output"));
        }
        let start = model.fitted().map(|state| -> Result<_> {
            // A position so small that the type does not have it is at the bottom.
            let points = state.turning_points();
            let points = points.map(|x| T::nearest(x).unwrap_or(T::ZERO)).collect();
            Ok((points, convert("an input", state.input())?))
        });
        let mut constants = Self {
            weights,
            core,
            offset,
            falls: model.sign() == Sign::Negative,
            rounding,
            missed: None,
            stages: None,
            start: start.transpose()?,
        };
        let offset_and_sign = (constants.offset, constants.falls);
        constants.stages = Staged::new(model, &constants.core, offset_and_sign, sampling)?;
        if constants.stages.as_ref().is_some_and(Staged::is_negative) {
            constants.rounding = None;
        }
        if constants.rounding.is_some() {
            constants.missed = Some(missed::<T>(model, sampling)?);
        }
        Ok(constants)
    }

    /// Offset and sign of the operators alone: those of the output are among the stages, where
    /// there are any.
    pub(super) fn operators_own(&self) -> (T, bool) {
        match self.stages {
            None => (self.offset, self.falls),
            Some(_) => (T::ZERO, false),
        }
    }

    /// The number of `hys_model.kind`.
    pub(super) fn kind(&self) -> usize {
        match self.core.operator() {
            Operator::Mkp => 0,
            Operator::Kp => 1,
            Operator::Relay => 2,
        }
    }

    /// The table without what follows it in the core's memory; those of all parts where the
    /// weights depend on the load.
    pub(super) fn table(&self) -> &[T] {
        if let Some(Some(parts)) = self.stages.as_ref().map(|stages| &stages.parts) {
            return &parts.tables;
        }
        let levels = self.core.plane().levels();
        &self.core.table()[..table_len(levels)]
    }

    /// By the structs in the headers.
    ///
    /// `learns`: for what learns on the target, the bytes of its constants beside the weights, and the
    /// numbers of its memory.
    /// `word`: the bytes of a pointer and of a size. An AVR, whose have 2, aligns nothing.
    /// `around`: for a control loop, the drives that are under way, and its parts.
    pub(super) fn memory(
        &self,
        word: usize,
        learns: Option<(usize, usize)>,
        around: Option<(usize, Parts)>,
    ) -> CMemory {
        let aligned = |bytes: usize| match word {
            2 => bytes,
            _ => bytes.next_multiple_of(T::BYTES),
        };
        let model = aligned(2 * word + 10 * T::BYTES + 3);
        let operators = aligned(4 * word + 6 * T::BYTES);
        // `hys_mixed` and its table.
        let len = table_len(self.core.plane().levels());
        let mixed = match &self.stages {
            Some(staged) if staged.parts.is_some() => {
                model + aligned(2 * word) + (2 + len) * T::BYTES
            }
            _ => 0,
        };
        // `hys_actuator`.
        let actuator = self.stages.as_ref().map_or(0, |staged| {
            let lists = 1 + staged.arrays().count();
            let numbers = 10 + RATE_NUMBERS + staged.core().behind.slopes().count();
            aligned(aligned((3 + 2 * lists) * word) + numbers * T::BYTES + 3)
        });
        let (stages, state) = match &self.stages {
            None => (0, operators),
            Some(staged) => (
                actuator
                    + staged
                        .parts
                        .as_ref()
                        .map_or(0, |_| aligned(3 * word) + 2 * T::BYTES)
                    + staged.numbers() * T::BYTES,
                operators + aligned(3 * word) + (STATE_NUMBERS - 1) * T::BYTES + mixed,
            ),
        };
        let start = match (&self.start, &self.stages) {
            (None, _) => 0,
            // Without stages the input is a constant of its own.
            (Some((points, _)), stages) => points.len() + usize::from(stages.is_none()),
        };
        let options = 4 * word + 11 * T::BYTES;
        let trial = aligned(4 * T::BYTES + word);
        let gate = aligned(4 * T::BYTES + 2 * word);
        let piece = aligned(7 * T::BYTES + word);
        let run = aligned(19 * T::BYTES + word);
        let trail = aligned(7 * T::BYTES + run + piece + 2);
        let watch = aligned(2 * trail + 3 * T::BYTES + word);
        let own = options + 2 * trial + gate + watch;
        let adaptive = aligned(model + own + aligned(22 * word) + 10 * T::BYTES + 4);
        let (table, weights) = (self.table().len(), self.weights.len());
        CMemory {
            table: table * T::BYTES,
            learners: learns.map_or(0, |(bytes, _)| bytes),
            constants: model
                + stages
                + (table + start) * T::BYTES
                + learns.map_or(0, |(bytes, _)| weights * T::BYTES + bytes)
                + around.map_or(0, |(_, parts)| {
                    let numbers = usize::from(parts.gate) + usize::from(parts.filter);
                    let mut bytes = 2 * word + 13 * T::BYTES + 2 + usize::from(parts.bits() > 0);
                    if numbers > 0 {
                        bytes = aligned(bytes) + numbers * T::BYTES;
                    }
                    if parts.time {
                        bytes = if word > 2 {
                            bytes.next_multiple_of(word)
                        } else {
                            bytes
                        } + word;
                    }
                    let clock = match parts.clock {
                        true => aligned(2 * word) + RATE_NUMBERS * T::BYTES,
                        false => 0,
                    };
                    aligned(bytes) + clock
                }),
            state,
            mixed,
            turns: turn_capacity(self.core.plane().levels()) * 2 * T::BYTES,
            controller: around.map(|(late, parts)| {
                let gate = usize::from(parts.gate) * (18 * T::BYTES + aligned(3));
                let filter = usize::from(parts.filter) * 3;
                let numbers = (20 + late + filter + usize::from(parts.time)) * T::BYTES;
                // On an AVR all constants are in RAM.
                let model = match parts.clock && word > 2 {
                    true => actuator,
                    false => 0,
                };
                aligned(5 * word) + numbers + aligned(5) + gate + model
            }),
            adaptation: learns.map(|(_, numbers)| adaptive + numbers * T::BYTES),
        }
    }
}

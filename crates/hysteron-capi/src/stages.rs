//! The constants of the stages around the operators, as a structure of numbers and arrays.

use crate::codes::HYSTERON_VALUE;
use crate::fault::{Fault, Result, guard};
use crate::model::MODELS;
use crate::parts::GivenParts;
use crate::pointer::Arguments;
use crate::types::sign as sign_of;
use hysteron::{Model, Sign};
use hysteron_core::{Axis, Body, Creep, Load, Stages};
use std::ptr::null;

/// The constants of the stages around the operators. All zeros, and `sign` 1, is a model without
/// stages.
///
/// ```text
/// T = body(drive)    x = W(a(load) T - s(load))    h = operators(x)
/// y = offset + o(load) + sign * lag(creep(g(load) h))
/// ```
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct HysteronStages {
    /// 1 for a thermal body, whose input is a drive; 0 for none.
    pub body: i32,
    /// 1: the output rises with the operators' sum; −1: it falls.
    pub sign: i32,
    /// The output where the operators' sum is zero.
    pub offset: f64,
    /// Body: temperature at rest without a drive.
    pub ambient: f64,
    /// Body: temperature at rest per unit of the drive, above 0.
    pub gain: f64,
    /// Body: time constant of heating in seconds, above 0.
    pub tau_heating: f64,
    /// Body: time constant of cooling in seconds, above 0.
    pub tau_cooling: f64,
    /// Number of loads at which the curves are known; 0 without a load. Beyond the outermost loads
    /// the curves stay as they are there.
    pub load_count: usize,
    /// The loads, ascending.
    pub loads: *const f64,
    /// The shift `s` of the axis at each load, in the unit of the temperature. Null for 0.
    pub shifts: *const f64,
    /// The scale `a` of the axis at each load, above 0. Null for 1.
    pub scales: *const f64,
    /// The gain `g` at each load, above 0. Null for 1.
    pub gains: *const f64,
    /// The offset `o` at each load, in the output's unit. Null for 0.
    pub offsets: *const f64,
    /// Number of corners of the grid: `K + 1`, or 0 for levels at equal distances.
    pub spacing_count: usize,
    /// The temperatures at the corners, ascending, from level 0, the bottom of the plane, on.
    pub spacing: *const f64,
    /// Number of creep terms, up to `HYSTERON_CREEP_TERMS`.
    pub creep_count: usize,
    /// The share of the operators' sum that creeps, of each term, from 0.
    pub creep: *const f64,
    /// The time constant of each creep term in seconds, above 0.
    pub creep_taus: *const f64,
    /// Time constant of a lag of the whole in seconds; 0 for none.
    pub lag: f64,
    /// Number of parts of weights that depend on the load, up to `HYSTERON_PARTS`; 0 for weights
    /// that do not. `offset` and the weights of the model have no effect then.
    pub part_count: usize,
    /// Number of weights of one part: `K (K + 1) / 2`.
    pub part_weight_count: usize,
    /// The output of each part where its sum is zero.
    pub part_offsets: *const f64,
    /// The weights of the parts, one part after the other. Their factors are the Bernstein
    /// polynomials of the load.
    pub part_weights: *const f64,
    /// The load of the first part, where `part_count` is not 0. A smaller load acts as this one.
    pub load_min: f64,
    /// The load of the last part, above `load_min`. A larger load acts as this one.
    pub load_max: f64,
}

/// The arrays of stages.
fn arrays<'a>(stages: &Stages<'a, f64>) -> [&'a [f64]; 8] {
    let Stages { axis, creep, .. } = stages;
    [
        axis.load.loads,
        axis.load.shifts,
        axis.load.scales,
        axis.load.gains,
        axis.load.offsets,
        axis.spacing,
        creep.coefficients,
        creep.taus,
    ]
}

/// How many numbers the arrays of stages have.
pub(crate) fn numbers(stages: &Stages<'_, f64>) -> usize {
    arrays(stages).iter().map(|array| array.len()).sum()
}

/// The same stages with their arrays in `place`, which has [`numbers`] elements.
pub(crate) fn copied(stages: &Stages<'_, f64>, place: &'static mut [f64]) -> Stages<'static, f64> {
    let mut rest = place;
    let [
        loads,
        shifts,
        scales,
        gains,
        offsets,
        spacing,
        coefficients,
        taus,
    ] = arrays(stages).map(|array| {
        let (copy, after) = std::mem::take(&mut rest).split_at_mut(array.len());
        rest = after;
        copy.copy_from_slice(array);
        &*copy
    });
    let load = Load {
        loads,
        shifts,
        scales,
        gains,
        offsets,
    };
    Stages {
        axis: Axis { load, spacing },
        creep: Creep { coefficients, taus },
        body: stages.body,
        lag: stages.lag,
        offset: stages.offset,
        falling: stages.falling,
    }
}

impl Arguments {
    /// The constants of stages and the arrays that they point to, with the parts of the weights.
    /// Take them last, so that shared memory is found first.
    ///
    /// # Safety
    /// `stages` is null or valid for a read; each of its pointers is null or valid for reads of as
    /// many elements as its count says, which nobody writes during `'a`.
    pub(crate) unsafe fn stages<'a>(
        &mut self,
        stages: *const HysteronStages,
    ) -> Result<(Stages<'a, f64>, Option<GivenParts<'a>>)> {
        // SAFETY: the caller's promise; every bit pattern is a value of each field.
        let given = unsafe { self.value(stages, "stages")? };
        let curve = |values: *const f64| {
            if values.is_null() {
                0
            } else {
                given.load_count
            }
        };
        // SAFETY: the caller's promise.
        let (load, spacing, creep) = unsafe {
            (
                Load {
                    loads: self.array(given.loads, given.load_count, "loads")?,
                    shifts: self.array(given.shifts, curve(given.shifts), "shifts")?,
                    scales: self.array(given.scales, curve(given.scales), "scales")?,
                    gains: self.array(given.gains, curve(given.gains), "gains")?,
                    offsets: self.array(given.offsets, curve(given.offsets), "offsets")?,
                },
                self.array(given.spacing, given.spacing_count, "spacing")?,
                Creep {
                    coefficients: self.array(given.creep, given.creep_count, "creep")?,
                    taus: self.array(given.creep_taus, given.creep_count, "creep_taus")?,
                },
            )
        };
        let body = Body {
            ambient: given.ambient,
            gain: given.gain,
            tau_heating: given.tau_heating,
            tau_cooling: given.tau_cooling,
        };
        let body = match given.body {
            0 => None,
            1 => Some(body),
            _ => return Err(Fault::Call(HYSTERON_VALUE, "body")),
        };
        let stages = Stages {
            body,
            axis: Axis { load, spacing },
            creep,
            lag: given.lag,
            offset: given.offset,
            falling: sign_of(given.sign)? == Sign::Negative,
        };
        if given.part_count == 0 {
            return Ok((stages, None));
        }
        let (count, each) = (given.part_count, given.part_weight_count);
        let all = count.checked_mul(each);
        let all = all.ok_or(Fault::Call(HYSTERON_VALUE, "part_count"))?;
        // SAFETY: the caller's promise.
        let (offsets, weights) = unsafe {
            (
                self.array(given.part_offsets, count, "part_offsets")?,
                self.array(given.part_weights, all, "part_weights")?,
            )
        };
        let range = (given.load_min, given.load_max);
        let parts = GivenParts {
            range,
            offsets,
            weights,
            each,
        };
        Ok((stages, Some(parts)))
    }
}

/// Writes the constants of the stages of `model`, for `hysteron_core_stages_init`. The arrays are
/// those of the model: they end when it and its states are freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hysteron_model_stages(model: u64, stages: *mut HysteronStages) -> i32 {
    guard(|| {
        // SAFETY: the contract of the crate.
        let stages = unsafe { Arguments::default().out(stages, "stages")? };
        stages.set(of(&*MODELS.get(model, "model")?));
        Ok(())
    })
}

fn of(model: &Model) -> HysteronStages {
    let by_load = model.load.as_ref().filter(|load| load.parts().len() > 1);
    let (part_offsets, part_weights) = by_load.map_or((&[][..], &[][..]), |load| load.joined());
    let (load_min, load_max) = by_load.map_or((0.0, 0.0), |load| load.range());
    let Stages {
        body,
        axis: Axis { load, spacing },
        creep,
        lag,
        offset,
        falling,
    } = model.stages();
    let none = Body {
        ambient: 0.0,
        gain: 0.0,
        tau_heating: 0.0,
        tau_cooling: 0.0,
    };
    let constants = body.unwrap_or(none);
    let start = |values: &[f64]| {
        if values.is_empty() {
            null()
        } else {
            values.as_ptr()
        }
    };
    HysteronStages {
        body: body.is_some().into(),
        sign: if falling { -1 } else { 1 },
        offset,
        ambient: constants.ambient,
        gain: constants.gain,
        tau_heating: constants.tau_heating,
        tau_cooling: constants.tau_cooling,
        load_count: load.loads.len(),
        loads: start(load.loads),
        shifts: start(load.shifts),
        scales: start(load.scales),
        gains: start(load.gains),
        offsets: start(load.offsets),
        spacing_count: spacing.len(),
        spacing: start(spacing),
        creep_count: creep.taus.len(),
        creep: start(creep.coefficients),
        creep_taus: start(creep.taus),
        lag,
        part_count: part_offsets.len(),
        part_weight_count: if by_load.is_some() {
            model.weights().len()
        } else {
            0
        },
        part_offsets: start(part_offsets),
        part_weights: start(part_weights),
        load_min,
        load_max,
    }
}

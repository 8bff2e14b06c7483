//! The constants of the stages around the operators, as lists of numbers with names.

use crate::codes::HYSTERON_VALUE;
use crate::fault::{Fault, Result, guard};
use crate::model::MODELS;
use crate::parts::GivenParts;
use crate::pointer::{Arguments, Pointers, name};
use crate::types::sign as sign_of;
use hysteron::{Model, Sign};
use hysteron_core::{Constant, Stages};
use std::ffi::{CString, c_char};
use std::ptr::null;
use std::sync::LazyLock;

/// Room for the constants of stages. There are fewer.
pub const HYSTERON_CONSTANTS: usize = 32;

/// The pointers of a call that takes stages: their constants, two for the parts, and its own.
pub(crate) type StageArguments = Pointers<{ HYSTERON_CONSTANTS + 8 }>;

/// A constant of a stage: a list of numbers. The names, units and ranges are those of
/// `docs/model.md`. Without a name it is ignored.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct HysteronConstant {
    /// Its name; null for none.
    pub name: *const c_char,
    /// Its numbers; null for none.
    pub numbers: *const f64,
    /// How many there are. A stage whose constants have no numbers is not there.
    pub count: usize,
}

/// The constants of the stages around the operators. All zeros, and `sign` 1, is a model without
/// stages.
///
/// ```text
/// T = body(drive)    x = W(a(load) T - s(load))    h = operators(x)
/// y = offset + o(load) + sign * behind(g(load) h)
/// ```
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct HysteronStages {
    /// 1: the output rises with the operators' sum; −1: it falls.
    pub sign: i32,
    /// The output where the operators' sum is zero.
    pub offset: f64,
    /// The constants of all stages, in any order, each once.
    pub constants: [HysteronConstant; HYSTERON_CONSTANTS],
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

/// The constants that stages declare.
fn table() -> impl Iterator<Item = &'static Constant> {
    Stages::<f64>::declared().flat_map(|stage| stage.constants)
}

/// The names of all constants, for C.
static NAMES: LazyLock<Vec<CString>> = LazyLock::new(|| {
    // No name has a zero byte.
    let name = |constant: &Constant| CString::new(constant.name).unwrap_or_default();
    table().map(name).collect()
});

/// How many numbers the lists of stages have.
pub(crate) fn numbers(stages: &Stages<'_, f64>) -> usize {
    stages.constants().map(|(_, list)| list.len()).sum()
}

/// The same stages with their lists in `place`, which has [`numbers`] elements.
pub(crate) fn copied(
    stages: &Stages<'_, f64>,
    place: &'static mut [f64],
) -> Result<Stages<'static, f64>> {
    let mut rest = place;
    let mut lists = stages.constants();
    let copies = Stages::of_lists(|| {
        let list = lists.next().map_or(&[][..], |(_, list)| list);
        let (copy, after) = std::mem::take(&mut rest).split_at_mut(list.len());
        rest = after;
        copy.copy_from_slice(list);
        copy
    })?;
    Ok(Stages {
        offset: stages.offset,
        falling: stages.falling,
        ..copies
    })
}

impl StageArguments {
    /// The constants of stages and the lists that they point to, with the parts of the weights.
    /// Take them last, so that shared memory is found first.
    ///
    /// # Safety
    /// `stages` is null or valid for a read; each of its pointers is null or valid for reads of as
    /// many elements as the count beside it says, or a text that ends with a zero byte. Nobody
    /// writes them during `'a`.
    pub(crate) unsafe fn stages<'a>(
        &mut self,
        stages: *const HysteronStages,
    ) -> Result<(Stages<'a, f64>, Option<GivenParts<'a>>)> {
        // SAFETY: the caller's promise; every bit pattern is a value of each field.
        let given = unsafe { self.value(stages, "stages")? };
        let mut lists: [&[f64]; HYSTERON_CONSTANTS] = [&[]; HYSTERON_CONSTANTS];
        let mut seen = [false; HYSTERON_CONSTANTS];
        for list in given.constants.iter().filter(|list| !list.name.is_null()) {
            // SAFETY: the caller's promise.
            let named = unsafe { name(list.name, "constants")? };
            let unknown = Fault::Call(HYSTERON_VALUE, "constants");
            let mut known = table().enumerate();
            let known = known.find(|(n, known)| known.name == named && !seen[*n]);
            let Some((place, constant)) = known else {
                return Err(unknown);
            };
            seen[place] = true;
            // SAFETY: the caller's promise.
            lists[place] = unsafe { self.array(list.numbers, list.count, constant.name)? };
        }
        let mut next = lists.into_iter();
        let stages = Stages {
            offset: given.offset,
            falling: sign_of(given.sign)? == Sign::Negative,
            ..Stages::of_lists(|| next.next().unwrap_or(&[]))?
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

/// Writes the constants of the stages of `model`, for `hysteron_core_stages_init`. The lists are
/// those of the model: they end when it and its states are freed. Every constant has its name, also
/// where it has no numbers.
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
    let start = |values: &[f64]| {
        if values.is_empty() {
            null()
        } else {
            values.as_ptr()
        }
    };
    let nothing = HysteronConstant {
        name: null(),
        numbers: null(),
        count: 0,
    };
    let mut constants = [nothing; HYSTERON_CONSTANTS];
    let lists = model.stage_lists();
    for ((place, name), list) in constants.iter_mut().zip(NAMES.iter()).zip(lists) {
        *place = HysteronConstant {
            name: name.as_ptr(),
            numbers: start(list),
            count: list.len(),
        };
    }
    HysteronStages {
        sign: if model.sign() == Sign::Negative {
            -1
        } else {
            1
        },
        offset: model.offset(),
        constants,
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_is_room_for_all_constants() {
        assert!(table().count() <= HYSTERON_CONSTANTS);
    }
}

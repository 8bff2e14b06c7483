//! What handles of states and of learners stand for. Their numbers are in memory of the library or
//! of the caller; the functions of C do not know which.

use crate::codes::{HYSTERON_HANDLE, HYSTERON_VALUE};
use crate::fault::{Fault, Result};
use crate::handles::Table;
use crate::limits::HysteronLimits;
use crate::memory::{Lent, Room, Size};
use crate::pointer::Arguments;
use crate::shift_options::HysteronShift;
use crate::types::{HYSTERON_START_FITTED, HYSTERON_START_OFF, HYSTERON_START_ON};
use hysteron::control::Compensator;
use hysteron::{Learning, Model, Sample, Wanted};
use hysteron_core::{Output, STATE_NUMBERS, Solution};
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

pub(crate) static STATES: Table<Object<dyn Moves>> = Table::new(2);
pub(crate) static LEARNERS: Table<Object<dyn Learns>> = Table::new(3);

/// A state, together with its model.
pub(crate) trait Moves: Send {
    fn model(&self) -> &Model;
    /// After an error nothing has moved.
    fn step(&mut self, sample: Sample) -> Result<Output<f64>>;
    /// As [`Moves::step`] for inputs alone; the slices have the same length.
    fn run(&mut self, input: &[f64], output: &mut [f64]) -> Result<()>;
    /// After an error nothing has moved.
    fn solve(&mut self, wanted: Wanted, limits: Option<HysteronLimits>) -> Result<Solution<f64>>;
    fn start(&mut self, start: Start) -> Result<()>;
    /// The last input of the operators.
    fn input(&self) -> f64;
    /// The number of turning points, and each of them.
    fn turning_points(&self, each: &mut dyn FnMut(f64)) -> usize;
    fn restore(&mut self, turning_points: &[f64], input: f64) -> Result<()>;
    fn stage_numbers(&self) -> [f64; STATE_NUMBERS];
    fn restore_stages(&mut self, numbers: &[f64; STATE_NUMBERS]) -> Result<()>;
    /// The number of inputs that are under way, and each of them.
    fn under_way(&self, _: &mut dyn FnMut(f64)) -> usize {
        0
    }
    fn restore_under_way(&mut self, inputs: &[f64]) -> Result<()> {
        match inputs.is_empty() {
            true => Ok(()),
            false => too_many(),
        }
    }
    fn half_width(&self) -> Result<Option<f64>>;
    /// Notes where the state is, for [`Moves::undo`].
    fn keep(&mut self);
    fn undo(&mut self);
}

/// More inputs are to be under way than the dead time has samples.
pub(crate) fn too_many() -> Result<()> {
    Err(Fault::Call(HYSTERON_VALUE, "inputs"))
}

/// Where a state starts.
pub(crate) enum Start {
    Fitted,
    Off,
    On,
}

impl TryFrom<i32> for Start {
    type Error = Fault;

    fn try_from(start: i32) -> Result<Self> {
        match start {
            HYSTERON_START_FITTED => Ok(Self::Fitted),
            HYSTERON_START_OFF => Ok(Self::Off),
            HYSTERON_START_ON => Ok(Self::On),
            _ => Err(Fault::Call(HYSTERON_VALUE, "start")),
        }
    }
}

/// A model that learns, with its state and that of its inverse.
pub(crate) trait Learns: Send {
    fn step(&mut self, sample: Sample, measured: f64) -> Result<Learning<f64>>;
    fn simulate(&mut self, sample: Sample) -> Result<f64>;
    fn solve(&mut self, wanted: Wanted) -> Result<Solution<f64>>;
    fn model(&self) -> Result<Model>;
    fn reset(&mut self) -> Result<()>;
    fn align(&mut self) -> Result<()>;
    fn freeze(&mut self, frozen: bool);
    fn keep(&mut self) -> Result<()> {
        Err(OTHER_KIND)
    }
    fn roll_back(&mut self) -> Result<()> {
        Err(OTHER_KIND)
    }
    fn shift(&self) -> Result<HysteronShift> {
        Err(OTHER_KIND)
    }
    /// A copy for a control loop.
    fn in_loop(&self) -> Result<Compensator> {
        Err(OTHER_KIND)
    }
}

/// The learner learns something else.
const OTHER_KIND: Fault = Fault::Call(HYSTERON_HANDLE, "adaptive");

/// An object, and the addresses of the caller's memory that it uses.
pub(crate) struct Object<T: ?Sized> {
    memory: Range<usize>,
    object: Mutex<Box<T>>,
}

impl<T: ?Sized> From<Box<T>> for Object<T> {
    fn from(object: Box<T>) -> Self {
        let object = Mutex::new(object);
        Self {
            memory: 0..0,
            object,
        }
    }
}

impl<T: ?Sized> Table<Object<T>> {
    /// Calls `work` with the object. Its memory may not be that of another argument.
    pub(crate) fn with<R>(
        &self,
        handle: u64,
        name: &'static str,
        arguments: &mut Arguments,
        work: impl FnOnce(&mut T) -> Result<R>,
    ) -> Result<R> {
        let object = self.get(handle, name)?;
        if !object.memory.is_empty() {
            arguments.claim(object.memory.start, object.memory.len(), name)?;
        }
        let mut object = object.object.lock().unwrap_or_else(PoisonError::into_inner);
        work(&mut object)
    }

    /// Makes an object in memory of the caller. Objects that were there end.
    pub(crate) fn place(
        &self,
        room: Room,
        size: Size,
        make: impl FnOnce(&mut Lent) -> Result<Box<T>>,
    ) -> Result<u64> {
        let mut lent = room.lend(size, |range| {
            STATES.end_where(|object| object.uses(range));
            LEARNERS.end_where(|object| object.uses(range));
        })?;
        let object = Mutex::new(make(&mut lent)?);
        let memory = lent.range;
        self.insert(Object { memory, object })
    }
}

impl<T: ?Sized> Object<T> {
    fn uses(&self, range: &Range<usize>) -> bool {
        self.memory.start < range.end && range.start < self.memory.end
    }
}

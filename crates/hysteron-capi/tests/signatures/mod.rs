//! The functions of the header that take two pointers or more, each with arguments that it accepts.

mod calls;

pub use calls::CALLS;
use hysteron_capi::*;
use std::ffi::{CStr, c_void};

pub const LEVELS: usize = 2;
pub const WEIGHTS: [f64; 3] = [1.0, 2.0, 1.0];
const MODEL_TEXT: &str = r#"{"format": "hysteron-model", "version": 1, "operator": "mkp",
    "plane": {"min": 0, "max": 1, "levels": 2}, "weights": [1, 2, 1]}"#;

/// The same behind a load and a lag.
const LOADED_TEXT: &CStr = cr#"{"format": "hysteron-model", "version": 2, "operator": "mkp",
    "plane": {"min": 0, "max": 1, "levels": 2}, "weights": [1, 2, 1], "lag": 0.5,
    "load": {"min": 1, "max": 2, "parts": [{"offset": 0, "weights": [1, 2, 1]}],
        "curves": {"loads": [1, 2], "shifts": [0, 0.5]}}}"#;

/// A function, its pointers by their names in the header, and a call with these pointers.
pub struct Call {
    pub name: &'static str,
    pub arguments: &'static [(&'static str, Argument)],
    pub run: fn(&Handles, &[*mut c_void]) -> i32,
}

/// What a pointer points to.
#[derive(Clone, Copy)]
pub enum Argument {
    Doubles(&'static [f64]),
    Integers(usize),
    Characters(usize),
    /// A handle, a size or a pointer.
    Word,
    /// The handle of a model, to read.
    ModelHandle,
    Options,
    Limits,
    Control,
    /// The path of a model file, and its text.
    Path,
    Json,
    /// Options of the estimator of the shift.
    ShiftOptions,
    /// Memory for an object.
    Memory(fn(&Handles) -> usize),
}

/// What calls need beside pointers.
pub struct Handles {
    folder: tempfile::TempDir,
    pub model: u64,
    pub state: u64,
    pub loaded: u64,
    pub adaptive: u64,
    pub batch: u64,
    pub plain_batch: u64,
    pub controller: u64,
}

impl Handles {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("model.json"), MODEL_TEXT).unwrap();
        let (mut model, mut state, mut adaptive) = (0, 0, 0);
        let (mut other, mut loaded) = (0, 0);
        let (mut batch, mut plain_batch, mut controller) = (0, 0, 0);
        let count = WEIGHTS.len();
        // SAFETY: live memory of the sizes given.
        let made = unsafe {
            [
                hysteron_model_new(
                    HYSTERON_MKP,
                    0.0,
                    1.0,
                    LEVELS,
                    WEIGHTS.as_ptr(),
                    count,
                    0.0,
                    1,
                    &mut model,
                ),
                hysteron_state_new(model, &mut state),
                hysteron_adaptive_new(model, std::ptr::null(), &mut adaptive),
                hysteron_model_parse(LOADED_TEXT.as_ptr(), &mut other),
                hysteron_state_new(other, &mut loaded),
                hysteron_batch_of(other, 3, &mut batch),
                hysteron_batch_of(model, 3, &mut plain_batch),
                hysteron_controller_new(&control(), model, 0, &mut controller),
            ]
        };
        assert_eq!(made, [HYSTERON_OK; 8]);
        Self {
            folder,
            model,
            state,
            loaded,
            adaptive,
            batch,
            plain_batch,
            controller,
        }
    }

    fn path(&self) -> String {
        let path = self.folder.path().join("model.json");
        path.to_str().unwrap().into()
    }
}

pub fn options() -> HysteronAdaptation {
    // SAFETY: all fields are numbers.
    let mut options = unsafe { std::mem::zeroed() };
    // SAFETY: a live structure.
    let filled = unsafe { hysteron_adaptation_default(HYSTERON_INCREMENTS, &mut options) };
    assert_eq!(filled, HYSTERON_OK);
    options
}

pub fn control() -> HysteronControl {
    // SAFETY: all fields are numbers.
    let mut control = unsafe { std::mem::zeroed() };
    // SAFETY: a live structure.
    let filled = unsafe { hysteron_control_default(0, 0.1, 0.0, 1.0, &mut control) };
    assert_eq!(filled, HYSTERON_OK);
    control
}

pub fn shift_options() -> HysteronShiftOptions {
    HysteronShiftOptions {
        noise: 0.1,
        spread: 0.2,
        walk: 0.0,
        reach: 1.0,
        dead_zone: 0.0,
        movement: 0.05,
        gate: 12.0,
        burst: 8,
    }
}

pub fn state_size(handles: &Handles) -> usize {
    hysteron_state_size(handles.model)
}

pub fn adaptive_size(handles: &Handles) -> usize {
    // SAFETY: a live structure.
    unsafe { hysteron_adaptive_size(handles.model, &options()) }
}

pub fn adaptive_load_size(handles: &Handles) -> usize {
    hysteron_adaptive_load_size(handles.model)
}

const LIMITS: HysteronLimits = HysteronLimits {
    drive_min: f64::NEG_INFINITY,
    drive_max: f64::INFINITY,
    horizon: 0.0,
    temperature_min: f64::NEG_INFINITY,
    temperature_max: f64::INFINITY,
};

impl Argument {
    pub fn bytes(self, handles: &Handles) -> usize {
        match self {
            Self::Doubles(values) => size_of_val(values),
            Self::Integers(count) => count * size_of::<i32>(),
            Self::Characters(count) => count,
            Self::Word | Self::ModelHandle => size_of::<u64>(),
            Self::Options => size_of::<HysteronAdaptation>(),
            Self::Limits => size_of::<HysteronLimits>(),
            Self::Control => size_of::<HysteronControl>(),
            Self::Path | Self::Json => self.text(handles).map_or(0, |text| text.len()),
            Self::ShiftOptions => size_of::<HysteronShiftOptions>(),
            Self::Memory(bytes) => bytes(handles),
        }
    }

    pub fn alignment(self) -> usize {
        match self {
            Self::Integers(_) => align_of::<i32>(),
            Self::Characters(_) | Self::Path | Self::Json => 1,
            _ => align_of::<u64>(),
        }
    }

    /// A text with its zero byte.
    pub fn text(self, handles: &Handles) -> Option<String> {
        match self {
            Self::Path => Some(handles.path() + "\0"),
            Self::Json => Some(format!("{MODEL_TEXT}\0")),
            _ => None,
        }
    }

    /// Puts it in its place.
    pub fn prepare(self, handles: &Handles, place: *mut c_void) {
        if let Some(text) = self.text(handles) {
            // SAFETY: the place has room for it.
            unsafe { place.cast::<u8>().copy_from(text.as_ptr(), text.len()) };
        }
        match self {
            // SAFETY: the place has room for it.
            Self::Doubles(values) => unsafe {
                place.cast::<f64>().copy_from(values.as_ptr(), values.len());
            },
            // SAFETY: the place has room for it.
            Self::ModelHandle => unsafe { place.cast::<u64>().write(handles.model) },
            // SAFETY: the place has room for it.
            Self::Options => unsafe { place.cast::<HysteronAdaptation>().write(options()) },
            // SAFETY: the place has room for it.
            Self::Limits => unsafe { place.cast::<HysteronLimits>().write(LIMITS) },
            // SAFETY: the place has room for it.
            Self::Control => unsafe { place.cast::<HysteronControl>().write(control()) },
            // SAFETY: the place has room for it.
            Self::ShiftOptions => unsafe {
                place.cast::<HysteronShiftOptions>().write(shift_options());
            },
            _ => {}
        }
    }
}

//! Status codes and their texts.

use std::ffi::{CStr, c_char};

/// No error.
pub const HYSTERON_OK: i32 = 0;
/// Fewer than 2 or too many levels.
pub const HYSTERON_LEVELS: i32 = 1;
/// The plane's range is not finite, empty or too narrow.
pub const HYSTERON_RANGE: i32 = 2;
/// The number of weights is not `K(K + 1)/2`.
pub const HYSTERON_WEIGHT_COUNT: i32 = 3;
/// A weight, or the weights' sum, is not finite.
pub const HYSTERON_WEIGHT_NOT_FINITE: i32 = 4;
/// The inverse and adaptation need weights that are not negative.
pub const HYSTERON_NEGATIVE_WEIGHTS: i32 = 5;
/// Memory or an array of the caller is too small.
pub const HYSTERON_MEMORY_TOO_SMALL: i32 = 6;
/// An input, target or measurement is NaN or infinite.
pub const HYSTERON_INPUT_NOT_FINITE: i32 = 7;
/// Turning points to restore do not nest.
pub const HYSTERON_TURNING_POINTS: i32 = 8;
/// A state was used with a model other than the one that made it.
pub const HYSTERON_STATE_MISMATCH: i32 = 9;
/// There is no such operator.
pub const HYSTERON_OPERATOR: i32 = 10;
/// An option of an estimator is out of its range.
pub const HYSTERON_ADAPTATION: i32 = 11;
/// The time since the sample before is needed: a finite number of seconds from 0 on.
pub const HYSTERON_TIME_STEP: i32 = 12;
/// A load is needed that is a finite number.
pub const HYSTERON_LOAD: i32 = 13;
/// A constant of a stage, or a limit of the inverse, is out of its range.
pub const HYSTERON_STAGE: i32 = 14;
/// A file cannot be read or written.
pub const HYSTERON_FILE: i32 = 20;
/// A model file is not valid.
pub const HYSTERON_MODEL_FILE: i32 = 21;
/// A recording is not valid.
pub const HYSTERON_RECORDING: i32 = 22;
/// The model or the options do not allow this call: a load is missing, out of range or too much.
pub const HYSTERON_FIT: i32 = 23;
/// A filter's arguments do not fit the data.
pub const HYSTERON_FILTER: i32 = 24;
/// A value lies outside the physics of the simulated rig.
pub const HYSTERON_RIG: i32 = 25;
/// A step of the preparation cannot be done.
pub const HYSTERON_PREPARATION: i32 = 26;
/// No experiment follows from the options.
pub const HYSTERON_DESIGN: i32 = 27;
/// The model depends on time: the time since the sample before is missing or negative.
pub const HYSTERON_THERMAL: i32 = 28;
/// A scenario is not valid.
pub const HYSTERON_SCENARIO: i32 = 29;
/// The options of a controller are not valid.
pub const HYSTERON_CONTROL: i32 = 30;
/// A model cannot be exported to this target.
pub const HYSTERON_EXPORT: i32 = 31;
/// A pointer is null that must not be.
pub const HYSTERON_NULL: i32 = 100;
/// There is no such handle or object: it was never made, was freed, or is of another kind.
pub const HYSTERON_HANDLE: i32 = 101;
/// A text is not UTF-8.
pub const HYSTERON_TEXT: i32 = 102;
/// A constant or a size is not one of those allowed.
pub const HYSTERON_VALUE: i32 = 103;
/// Memory is not aligned as its content needs.
pub const HYSTERON_ALIGNMENT: i32 = 104;
/// Two arrays of the call overlap.
pub const HYSTERON_OVERLAP: i32 = 105;
/// A defect of this library, caught at its boundary.
pub const HYSTERON_INTERNAL: i32 = 106;

/// The text of a status code. It is never null and stays valid. `hysteron_last_error` gives the
/// details of the last error.
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_error_message(code: i32) -> *const c_char {
    text_of(code).as_ptr()
}

/// The version of this library, for example "0.2.0".
#[unsafe(no_mangle)]
pub extern "C" fn hysteron_version() -> *const c_char {
    const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");
    VERSION.as_ptr().cast()
}

fn text_of(code: i32) -> &'static CStr {
    match code {
        HYSTERON_OK => c"all is well",
        HYSTERON_LEVELS => c"too few or too many levels",
        HYSTERON_RANGE => c"the plane's range is not finite, empty or too narrow",
        HYSTERON_WEIGHT_COUNT => c"not as many weights as K(K+1)/2",
        HYSTERON_WEIGHT_NOT_FINITE => c"a weight or the weights' sum is not finite",
        HYSTERON_NEGATIVE_WEIGHTS => c"weights below zero: there is no inverse",
        HYSTERON_MEMORY_TOO_SMALL => c"memory or array too small",
        HYSTERON_INPUT_NOT_FINITE => c"an input, target or measurement is not finite",
        HYSTERON_TURNING_POINTS => c"turning points do not nest",
        HYSTERON_STATE_MISMATCH => c"the state belongs to another model",
        HYSTERON_OPERATOR => c"there is no such operator",
        HYSTERON_ADAPTATION => c"an option of the estimator is out of its range",
        HYSTERON_TIME_STEP => c"the time since the sample before is missing or negative",
        HYSTERON_LOAD => c"a load is missing or not finite",
        HYSTERON_STAGE => c"a constant of a stage or a limit is out of its range",
        HYSTERON_FILE => c"a file cannot be read or written",
        HYSTERON_MODEL_FILE => c"the model file is wrong",
        HYSTERON_RECORDING => c"the recording cannot be used as it is",
        HYSTERON_FIT => c"model or options do not allow this",
        HYSTERON_FILTER => c"the filter's arguments do not fit the data",
        HYSTERON_RIG => c"outside the physics of the virtual rig",
        HYSTERON_PREPARATION => c"a step of the preparation cannot be done",
        HYSTERON_DESIGN => c"no experiment follows from the options",
        HYSTERON_THERMAL => c"the model depends on time, which is missing or goes back",
        HYSTERON_SCENARIO => c"the scenario is wrong",
        HYSTERON_CONTROL => c"the controller cannot be made as told",
        HYSTERON_EXPORT => c"the model cannot be carried there",
        HYSTERON_NULL => c"null pointer",
        HYSTERON_HANDLE => {
            c"no such handle or object: never made, freed already, or of another kind"
        }
        HYSTERON_TEXT => c"a text is not UTF-8",
        HYSTERON_VALUE => c"not one of the values allowed",
        HYSTERON_ALIGNMENT => c"memory is not aligned",
        HYSTERON_OVERLAP => c"arrays overlap",
        HYSTERON_INTERNAL => c"a defect of the library, please report it",
        _ => c"unknown code",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_has_a_text_of_its_own() {
        let codes = (0..=14).chain(20..=31).chain(100..=106);
        let texts: std::collections::HashSet<_> = codes.clone().map(text_of).collect();
        assert_eq!(texts.len(), codes.count());
        assert!(!texts.contains(text_of(-1)));
    }

    #[test]
    fn codes_are_those_of_the_library() {
        use hysteron_core::Error;
        assert_eq!(Error::Levels(0).code(), HYSTERON_LEVELS);
        assert_eq!(Error::StateMismatch.code(), HYSTERON_STATE_MISMATCH);
        assert_eq!(Error::Adaptation { option: "" }.code(), HYSTERON_ADAPTATION);
        assert_eq!(Error::TimeStep.code(), HYSTERON_TIME_STEP);
        assert_eq!(Error::Load.code(), HYSTERON_LOAD);
        assert_eq!(Error::Stage { stage: "" }.code(), HYSTERON_STAGE);
        let file = hysteron::Model::read(std::path::Path::new("/no/such/file"));
        assert_eq!(file.map_err(|e| e.code()), Err(HYSTERON_FILE));
        assert_eq!(
            hysteron::Error::Control(String::new()).code(),
            HYSTERON_CONTROL
        );
    }
}

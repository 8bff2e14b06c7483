//! FMI 3.0 for co-simulation, function by function, as the standard defines them.
#![allow(missing_docs, non_snake_case)]

use super::calls::{call, free, get, instantiate, logging, refused, set};
use super::logger::{Callback, Fmi3Logger, Logger};
use super::{Problem, Result, Status, states};
use crate::pointer::Arguments;
use std::ffi::{c_char, c_void};
use std::path::PathBuf;

/// `fmi3Instance`: a handle.
pub type Instance = *mut c_void;
/// `fmi3FMUState`: a handle.
pub type State = *mut c_void;
/// `fmi3Boolean` as a byte, because a caller may pass values other than 0 and 1.
pub type Boolean = u8;

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetDebugLogging(
    c: Instance,
    on: Boolean,
    count: usize,
    categories: *const *const c_char,
) -> Status {
    // SAFETY: the contract of the crate.
    unsafe { logging(c, "fmi3SetDebugLogging", on != 0, (categories, count)) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateCoSimulation(
    name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: Boolean,
    _logging: Boolean,
    event_mode: Boolean,
    _early_return: Boolean,
    _intermediate: *const u32,
    _intermediate_count: usize,
    environment: *mut c_void,
    log: Option<Fmi3Logger>,
    _update: *const c_void,
) -> Instance {
    let folder = || {
        if event_mode != 0 {
            return Err(Problem::new("this FMU has no event mode"));
        }
        // SAFETY: the contract of the crate.
        Ok(PathBuf::from(unsafe {
            Arguments::default().text(resources, "resourcePath")?
        }))
    };
    let logger = |name: &str| logger(name, environment, log);
    // SAFETY: the contract of the crate.
    unsafe { instantiate((name, token), logger, folder) }
}

fn logger(name: &str, environment: *mut c_void, log: Option<Fmi3Logger>) -> Logger {
    Logger::new(
        name,
        environment,
        log.map_or(Callback::None, Callback::Fmi3),
    )
}

fn only_co_simulation(environment: *mut c_void, log: Option<Fmi3Logger>) -> Instance {
    let text = "instantiate: this FMU is for co-simulation only";
    logger("", environment, log).tell(super::ERROR, text);
    std::ptr::null_mut()
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateModelExchange(
    _: *const c_char,
    _: *const c_char,
    _: *const c_char,
    _: Boolean,
    _: Boolean,
    environment: *mut c_void,
    log: Option<Fmi3Logger>,
) -> Instance {
    only_co_simulation(environment, log)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateScheduledExecution(
    _: *const c_char,
    _: *const c_char,
    _: *const c_char,
    _: Boolean,
    _: Boolean,
    environment: *mut c_void,
    log: Option<Fmi3Logger>,
    _: *const c_void,
    _: *const c_void,
    _: *const c_void,
) -> Instance {
    only_co_simulation(environment, log)
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3FreeInstance(c: Instance) {
    free(c);
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3EnterInitializationMode(
    c: Instance,
    _tolerance_defined: Boolean,
    _tolerance: f64,
    start: f64,
    stop_defined: Boolean,
    stop: f64,
) -> Status {
    call(c, "fmi3EnterInitializationMode", |instance| {
        instance.experiment(start, (stop_defined != 0).then_some(stop))?;
        instance.enter_initialisation()
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3ExitInitializationMode(c: Instance) -> Status {
    call(c, "fmi3ExitInitializationMode", |instance| {
        instance.exit_initialisation()
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3Terminate(c: Instance) -> Status {
    call(c, "fmi3Terminate", |instance| instance.terminate())
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3Reset(c: Instance) -> Status {
    call(c, "fmi3Reset", |instance| instance.reset())
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DoStep(
    c: Instance,
    from: f64,
    size: f64,
    _no_rollback: Boolean,
    event: *mut Boolean,
    terminate: *mut Boolean,
    early: *mut Boolean,
    last: *mut f64,
) -> Status {
    call(c, "fmi3DoStep", |instance| {
        // Each pointer is checked alone, because a tool that needs no flag may pass the same one
        // for all. SAFETY: the contract of the crate.
        let (flags, last) = unsafe {
            let flags = [
                Arguments::default().optional(event, "eventHandlingNeeded")?,
                Arguments::default().optional(terminate, "terminateSimulation")?,
                Arguments::default().optional(early, "earlyReturn")?,
            ];
            let last = Arguments::default().optional(last, "lastSuccessfulTime")?;
            (flags, last)
        };
        let done = instance.step(from, size);
        for flag in flags.iter().flatten() {
            flag.set(0);
        }
        if let Some(last) = last {
            last.set(instance.time());
        }
        done
    })
}

fn as_many(references: usize, values: usize) -> Result<()> {
    match references == values {
        true => Ok(()),
        false => Err(Problem(format!(
            "{values} values for {references} value references"
        ))),
    }
}

macro_rules! values {
    ($get:ident, $set:ident, $c:ty, $outward:expr, $inward:expr) => {
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $get(
            c: Instance,
            references: *const u32,
            count: usize,
            values: *mut $c,
            value_count: usize,
        ) -> Status {
            call(c, stringify!($get), |instance| {
                as_many(count, value_count)?;
                // SAFETY: the contract of the crate.
                unsafe { get(instance, references, count, values, $outward) }
            })
        }

        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $set(
            c: Instance,
            references: *const u32,
            count: usize,
            values: *const $c,
            value_count: usize,
        ) -> Status {
            call(c, stringify!($set), |instance| {
                as_many(count, value_count)?;
                // SAFETY: the contract of the crate.
                unsafe { set(instance, references, count, values, $inward) }
            })
        }
    };
}

values!(
    fmi3GetFloat64,
    fmi3SetFloat64,
    f64,
    |value: f64| value,
    |value| value
);
values!(
    fmi3GetInt32,
    fmi3SetInt32,
    i32,
    |value: i32| value,
    |value| value
);
values!(
    fmi3GetBoolean,
    fmi3SetBoolean,
    Boolean,
    |value: bool| Boolean::from(value),
    |value| value != 0
);

/// Types that no variable here has. Only empty lists can be read or set.
macro_rules! no_values {
    ($($name:ident($($more:ty),*);)*) => {$(
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(c: Instance, _: *const u32, count: usize, $(_: $more),*) -> Status {
            call(c, stringify!($name), |_| match count {
                0 => Ok(()),
                _ => Err(Problem::new("there are no variables of this type")),
            })
        }
    )*};
}

no_values! {
    fmi3GetFloat32(*mut f32, usize);
    fmi3SetFloat32(*const f32, usize);
    fmi3GetInt8(*mut i8, usize);
    fmi3SetInt8(*const i8, usize);
    fmi3GetUInt8(*mut u8, usize);
    fmi3SetUInt8(*const u8, usize);
    fmi3GetInt16(*mut i16, usize);
    fmi3SetInt16(*const i16, usize);
    fmi3GetUInt16(*mut u16, usize);
    fmi3SetUInt16(*const u16, usize);
    fmi3GetUInt32(*mut u32, usize);
    fmi3SetUInt32(*const u32, usize);
    fmi3GetInt64(*mut i64, usize);
    fmi3SetInt64(*const i64, usize);
    fmi3GetUInt64(*mut u64, usize);
    fmi3SetUInt64(*const u64, usize);
    fmi3GetString(*mut *const c_char, usize);
    fmi3SetString(*const *const c_char, usize);
    fmi3GetBinary(*mut usize, *mut *const u8, usize);
    fmi3SetBinary(*const usize, *const *const u8, usize);
    fmi3GetClock(*mut Boolean);
    fmi3SetClock(*const Boolean);
    fmi3GetIntervalDecimal(*mut f64, *mut i32);
    fmi3SetIntervalDecimal(*const f64);
    fmi3GetIntervalFraction(*mut u64, *mut u64, *mut i32);
    fmi3SetIntervalFraction(*const u64, *const u64);
    fmi3GetShiftDecimal(*mut f64);
    fmi3SetShiftDecimal(*const f64);
    fmi3GetShiftFraction(*mut u64, *mut u64);
    fmi3SetShiftFraction(*const u64, *const u64);
}

refused! {
    fmi3EnterEventMode();
    fmi3EnterStepMode();
    fmi3EnterConfigurationMode();
    fmi3ExitConfigurationMode();
    fmi3EvaluateDiscreteStates();
    fmi3UpdateDiscreteStates(*mut Boolean, *mut Boolean, *mut Boolean, *mut Boolean, *mut Boolean, *mut f64);
    fmi3GetNumberOfVariableDependencies(u32, *mut usize);
    fmi3GetVariableDependencies(u32, *mut usize, *mut u32, *mut usize, *mut i32, usize);
    fmi3GetDirectionalDerivative(*const u32, usize, *const u32, usize, *const f64, usize, *mut f64, usize);
    fmi3GetAdjointDerivative(*const u32, usize, *const u32, usize, *const f64, usize, *mut f64, usize);
    fmi3GetOutputDerivatives(*const u32, usize, *const i32, *mut f64, usize);
    fmi3EnterContinuousTimeMode();
    fmi3CompletedIntegratorStep(Boolean, *mut Boolean, *mut Boolean);
    fmi3SetTime(f64);
    fmi3SetContinuousStates(*const f64, usize);
    fmi3GetContinuousStates(*mut f64, usize);
    fmi3GetContinuousStateDerivatives(*mut f64, usize);
    fmi3GetNominalsOfContinuousStates(*mut f64, usize);
    fmi3GetNumberOfContinuousStates(*mut usize);
    fmi3GetEventIndicators(*mut f64, usize);
    fmi3GetNumberOfEventIndicators(*mut usize);
    fmi3ActivateModelPartition(u32, f64);
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFMUState(c: Instance, state: *mut State) -> Status {
    // SAFETY: the contract of the crate.
    unsafe { states::save(c, "fmi3GetFMUState", state) }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3SetFMUState(c: Instance, state: State) -> Status {
    states::restore(c, "fmi3SetFMUState", state)
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeFMUState(c: Instance, state: *mut State) -> Status {
    // SAFETY: the contract of the crate.
    unsafe { states::forget(c, "fmi3FreeFMUState", state) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializedFMUStateSize(
    c: Instance,
    state: State,
    size: *mut usize,
) -> Status {
    // SAFETY: the contract of the crate.
    unsafe { states::size(c, "fmi3SerializedFMUStateSize", state, size) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializeFMUState(
    c: Instance,
    state: State,
    bytes: *mut u8,
    size: usize,
) -> Status {
    // SAFETY: the contract of the crate.
    unsafe { states::serialise(c, "fmi3SerializeFMUState", state, (bytes, size)) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DeserializeFMUState(
    c: Instance,
    bytes: *const u8,
    size: usize,
    state: *mut State,
) -> Status {
    // SAFETY: the contract of the crate.
    unsafe { states::deserialise(c, "fmi3DeserializeFMUState", (bytes, size), state) }
}

//! FMI 2.0 for co-simulation, function by function, as the standard defines them.
#![allow(missing_docs, non_snake_case)]

use super::calls::{call, free, get, instantiate, logging, refused, set};
use super::logger::{Callback, Fmi2Logger, Logger};
use super::{DISCARD, OK, Problem, Result, Status, location, states};
use crate::pointer::{Arguments, check};
use std::ffi::{c_char, c_void};

/// `fmi2Component`: a handle.
pub type Component = *mut c_void;
/// `fmi2FMUstate`: a handle.
pub type State = *mut c_void;

const CO_SIMULATION: i32 = 1;
const LAST_SUCCESSFUL_TIME: i32 = 2;

/// `fmi2CallbackFunctions`
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Callbacks {
    pub logger: Option<Fmi2Logger>,
    pub allocate_memory: *const c_void,
    pub free_memory: *const c_void,
    pub step_finished: *const c_void,
    pub environment: *mut c_void,
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    c: Component,
    on: i32,
    count: usize,
    categories: *const *const c_char,
) -> Status {
    // SAFETY: the contract of the crate.
    unsafe { logging(c, "fmi2SetDebugLogging", on != 0, (categories, count)) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    name: *const c_char,
    kind: i32,
    guid: *const c_char,
    resources: *const c_char,
    callbacks: *const Callbacks,
    _visible: i32,
    _logging: i32,
) -> Component {
    let logger = |name: &str| {
        // SAFETY: the contract of the crate.
        let callbacks = check(callbacks, "functions").map(|()| unsafe { callbacks.read() });
        match callbacks {
            Ok(callbacks) => {
                let callback = callbacks.logger.map_or(Callback::None, Callback::Fmi2);
                Logger::new(name, callbacks.environment, callback)
            }
            Err(_) => Logger::new(name, std::ptr::null_mut(), Callback::None),
        }
    };
    let folder = || {
        check(callbacks, "functions")?;
        if kind != CO_SIMULATION {
            return Err(Problem::new("this FMU is for co-simulation only"));
        }
        // SAFETY: the contract of the crate.
        location::of_uri(unsafe { Arguments::default().text(resources, "fmuResourceLocation")? })
    };
    // SAFETY: the contract of the crate.
    unsafe { instantiate((name, guid), logger, folder) }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2FreeInstance(c: Component) {
    free(c);
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetupExperiment(
    c: Component,
    _tolerance_defined: i32,
    _tolerance: f64,
    start: f64,
    stop_defined: i32,
    stop: f64,
) -> Status {
    call(c, "fmi2SetupExperiment", |instance| {
        instance.experiment(start, (stop_defined != 0).then_some(stop))
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2EnterInitializationMode(c: Component) -> Status {
    call(c, "fmi2EnterInitializationMode", |instance| {
        instance.enter_initialisation()
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2ExitInitializationMode(c: Component) -> Status {
    call(c, "fmi2ExitInitializationMode", |instance| {
        instance.exit_initialisation()
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2Terminate(c: Component) -> Status {
    call(c, "fmi2Terminate", |instance| instance.terminate())
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2Reset(c: Component) -> Status {
    call(c, "fmi2Reset", |instance| instance.reset())
}

macro_rules! values {
    ($get:ident, $set:ident, $c:ty, $outward:expr, $inward:expr) => {
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $get(
            c: Component,
            references: *const u32,
            count: usize,
            values: *mut $c,
        ) -> Status {
            // SAFETY: the contract of the crate.
            call(c, stringify!($get), |instance| unsafe {
                get(instance, references, count, values, $outward)
            })
        }

        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $set(
            c: Component,
            references: *const u32,
            count: usize,
            values: *const $c,
        ) -> Status {
            // SAFETY: the contract of the crate.
            call(c, stringify!($set), |instance| unsafe {
                set(instance, references, count, values, $inward)
            })
        }
    };
}

values!(fmi2GetReal, fmi2SetReal, f64, |value: f64| value, |value| {
    value
});
values!(
    fmi2GetInteger,
    fmi2SetInteger,
    i32,
    |value: i32| value,
    |value| value
);
values!(
    fmi2GetBoolean,
    fmi2SetBoolean,
    i32,
    |value: bool| i32::from(value),
    |value| value != 0
);

fn no_strings(count: usize) -> Result<()> {
    match count {
        0 => Ok(()),
        _ => Err(Problem::new("there are no text variables")),
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetString(
    c: Component,
    _: *const u32,
    count: usize,
    _: *mut *const c_char,
) -> Status {
    call(c, "fmi2GetString", |_| no_strings(count))
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetString(
    c: Component,
    _: *const u32,
    count: usize,
    _: *const *const c_char,
) -> Status {
    call(c, "fmi2SetString", |_| no_strings(count))
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(c: Component, state: *mut State) -> Status {
    // SAFETY: the contract of the crate.
    unsafe { states::save(c, "fmi2GetFMUstate", state) }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2SetFMUstate(c: Component, state: State) -> Status {
    states::restore(c, "fmi2SetFMUstate", state)
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(c: Component, state: *mut State) -> Status {
    // SAFETY: the contract of the crate.
    unsafe { states::forget(c, "fmi2FreeFMUstate", state) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(
    c: Component,
    state: State,
    size: *mut usize,
) -> Status {
    // SAFETY: the contract of the crate.
    unsafe { states::size(c, "fmi2SerializedFMUstateSize", state, size) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    c: Component,
    state: State,
    bytes: *mut u8,
    size: usize,
) -> Status {
    // SAFETY: the contract of the crate.
    unsafe { states::serialise(c, "fmi2SerializeFMUstate", state, (bytes, size)) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    c: Component,
    bytes: *const u8,
    size: usize,
    state: *mut State,
) -> Status {
    // SAFETY: the contract of the crate.
    unsafe { states::deserialise(c, "fmi2DeSerializeFMUstate", (bytes, size), state) }
}

refused! {
    fmi2GetDirectionalDerivative(*const u32, usize, *const u32, usize, *const f64, *mut f64);
    fmi2SetRealInputDerivatives(*const u32, usize, *const i32, *const f64);
    fmi2GetRealOutputDerivatives(*const u32, usize, *const i32, *mut f64);
    fmi2CancelStep();
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2DoStep(c: Component, from: f64, size: f64, _no_rollback: i32) -> Status {
    call(c, "fmi2DoStep", |instance| instance.step(from, size))
}

/// Steps are never pending, so only the time can be asked for.
fn no_status(c: Component, name: &str) -> Status {
    match call(c, name, |_| Ok(())) {
        OK => DISCARD,
        other => other,
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetStatus(c: Component, _: i32, _: *mut Status) -> Status {
    no_status(c, "fmi2GetStatus")
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(c: Component, kind: i32, value: *mut f64) -> Status {
    if kind != LAST_SUCCESSFUL_TIME {
        return no_status(c, "fmi2GetRealStatus");
    }
    call(c, "fmi2GetRealStatus", |instance| {
        // SAFETY: the contract of the crate.
        let value = unsafe { Arguments::default().out(value, "value")? };
        value.set(instance.time());
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetIntegerStatus(c: Component, _: i32, _: *mut i32) -> Status {
    no_status(c, "fmi2GetIntegerStatus")
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetBooleanStatus(c: Component, _: i32, _: *mut i32) -> Status {
    no_status(c, "fmi2GetBooleanStatus")
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetStringStatus(c: Component, _: i32, _: *mut *const c_char) -> Status {
    no_status(c, "fmi2GetStringStatus")
}

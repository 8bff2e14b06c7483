//! What JavaScript calls: functions of numbers, and two buffers of bytes.
//!
//! A call takes what stands in the buffer of [`input`], and leaves its answer where [`output`] and
//! [`output_length`] say. Both hold until the next call. There is one thread.
//!
//! The functions are safe; only their names are not, as they could be those of others.
#![allow(unsafe_code)]

use crate::host::{self, Host, Outcome};
use std::cell::RefCell;

struct Instance {
    host: Host,
    input: Vec<u8>,
    output: Vec<u8>,
}

thread_local! {
    static INSTANCE: RefCell<Instance> = RefCell::new(Instance {
        host: Host::new(),
        input: Vec::new(),
        output: Vec::new(),
    });
}

/// What the worker gives.
#[cfg(target_arch = "wasm32")]
mod worker {
    #[link(wasm_import_module = "hysteron")]
    unsafe extern "C" {
        // JavaScript copies the bytes before it returns.
        pub(super) safe fn tell(bytes: *const u8, length: usize);
        pub(super) safe fn panicked(bytes: *const u8, length: usize);
    }
}

/// There is no worker where this crate is tested.
#[cfg(not(target_arch = "wasm32"))]
mod worker {
    pub(super) fn tell(_: *const u8, _: usize) {}
    pub(super) fn panicked(_: *const u8, _: usize) {}
}

/// Has to be called first: a panic then says what it was, before it ends the instance.
#[unsafe(no_mangle)]
pub extern "C" fn begin() {
    std::panic::set_hook(Box::new(|about| {
        let text = about.to_string();
        worker::panicked(text.as_ptr(), text.len());
    }));
}

/// A buffer of so many bytes, for the next call. Zero where there is no memory for it.
#[unsafe(no_mangle)]
pub extern "C" fn input(length: usize) -> *mut u8 {
    with(|instance| {
        let mut buffer = Vec::new();
        if buffer.try_reserve_exact(length).is_err() {
            return std::ptr::null_mut();
        }
        buffer.resize(length, 0);
        instance.input = buffer;
        instance.input.as_mut_ptr()
    })
}

/// Where the answer is.
#[unsafe(no_mangle)]
pub extern "C" fn output() -> *const u8 {
    with(|instance| instance.output.as_ptr())
}

/// How many bytes it has.
#[unsafe(no_mangle)]
pub extern "C" fn output_length() -> usize {
    with(|instance| instance.output.len())
}

/// Whether a file of so many bytes may come; if not, 0 and a fault.
#[unsafe(no_mangle)]
pub extern "C" fn admits(bytes: f64) -> u32 {
    // A size in JavaScript is a number below 2⁵³.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    answer(|host, _| host.admits(bytes as u64))
}

/// Opens the file in the buffer, whose last `name` bytes are its name.
#[unsafe(no_mangle)]
pub extern "C" fn open(name: usize) -> u32 {
    answer(|host, bytes| host.open(bytes, name))
}

/// Answers the request in the buffer: 0 and a fault, 1 and a response, or 2 and a response after
/// which the session is another one.
#[unsafe(no_mangle)]
pub extern "C" fn request() -> u32 {
    answer(|host, request| host.request(&request))
}

/// The number of a job that is to be run by another instance, which gets the answer. Zero where
/// there is none.
#[unsafe(no_mangle)]
pub extern "C" fn job() -> f64 {
    with(|instance| {
        let (id, bytes) = instance.host.job().unwrap_or_default();
        instance.output = bytes;
        // Numbers are counted up from 1.
        #[allow(clippy::cast_precision_loss)]
        let id = id as f64;
        id
    })
}

/// Runs the job in the buffer. The answer is for [`finish`] of the instance that it comes from.
/// Meanwhile `tell` of the worker gets what [`progress`] there takes.
#[unsafe(no_mangle)]
pub extern "C" fn run() {
    // The session of this instance stays empty.
    let job = with(|instance| std::mem::take(&mut instance.input));
    let found = host::run(&job, &|told| worker::tell(told.as_ptr(), told.len()));
    with(|instance| instance.output = found);
}

/// Takes what another instance has found.
#[unsafe(no_mangle)]
pub extern "C" fn finish() {
    with(|instance| instance.host.finish(&instance.input));
}

/// Takes that the worker of a job was ended: JSON of `job`, and `problem` or null.
#[unsafe(no_mangle)]
pub extern "C" fn ended() {
    with(|instance| instance.host.ended(&instance.input));
}

/// Takes the progress of a job.
#[unsafe(no_mangle)]
pub extern "C" fn progress() {
    with(|instance| instance.host.progress(&instance.input));
}

/// Answers what the pages are told.
#[unsafe(no_mangle)]
pub extern "C" fn told() {
    with(|instance| instance.output = instance.host.told());
}

fn answer(call: impl FnOnce(&mut Host, Vec<u8>) -> (Outcome, Vec<u8>)) -> u32 {
    with(|instance| {
        let input = std::mem::take(&mut instance.input);
        let (outcome, output) = call(&mut instance.host, input);
        instance.output = output;
        outcome as u32
    })
}

fn with<T>(work: impl FnOnce(&mut Instance) -> T) -> T {
    INSTANCE.with_borrow_mut(work)
}

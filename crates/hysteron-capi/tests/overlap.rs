//! No two pointers of a call may share memory: every function that has two, every pair, every
//! offset.
#![allow(clippy::unwrap_used)]

mod signatures;

use hysteron_capi::*;
use signatures::{CALLS, Call, Handles};
use std::ffi::c_void;
use std::ops::Range;

/// All that one call points to, argument by argument, in one piece of memory.
struct Arena<'a> {
    call: &'a Call,
    handles: &'a Handles,
    memory: Vec<u64>,
    places: Vec<Range<usize>>,
}

/// Bytes before and after each argument: at least as many as any has.
const GAP: usize = 2048;

impl<'a> Arena<'a> {
    fn new(call: &'a Call, handles: &'a Handles) -> Self {
        let mut places = Vec::new();
        let mut end = GAP;
        for (_, argument) in call.arguments {
            let size = argument.bytes(handles);
            assert!(0 < size && size <= GAP, "{}", call.name);
            places.push(end..end + size);
            end = (end + size).next_multiple_of(8) + GAP;
        }
        let memory = vec![0_u64; end / 8];
        let mut arena = Self {
            call,
            handles,
            memory,
            places,
        };
        arena.prepare();
        arena
    }

    fn prepare(&mut self) {
        for (place, (_, argument)) in self.pointers().into_iter().zip(self.call.arguments) {
            argument.prepare(self.handles, place);
        }
    }

    fn at(&mut self, start: usize) -> *mut c_void {
        let base: *mut u8 = self.memory.as_mut_ptr().cast();
        base.wrapping_add(start).cast()
    }

    fn pointers(&mut self) -> Vec<*mut c_void> {
        let starts: Vec<usize> = self.places.iter().map(|place| place.start).collect();
        starts.into_iter().map(|start| self.at(start)).collect()
    }

    /// The call's code, and whether it left all memory as it was. It is so again afterwards.
    fn run(&mut self, pointers: &[*mut c_void]) -> (i32, bool) {
        let before = self.memory.clone();
        let code = (self.call.run)(self.handles, pointers);
        let same = before == self.memory;
        self.memory.copy_from_slice(&before);
        (code, same)
    }

    /// The call with one argument moved to where others are.
    fn run_moved(&mut self, moved: usize, start: usize) -> (i32, bool) {
        let before = self.memory.clone();
        let mut pointers = self.pointers();
        pointers[moved] = self.at(start);
        if let Some(text) = self.call.arguments[moved].1.text(self.handles) {
            // SAFETY: within the memory, as the gaps are wide enough. A text has to be one there as
            // well.
            unsafe {
                let place = pointers[moved].cast::<u8>();
                place.copy_from(text.as_ptr(), text.len());
            }
        }
        let done = self.run(&pointers);
        self.memory.copy_from_slice(&before);
        done
    }

    /// What may be said of an argument moved to a place that another has.
    fn refuses(&self, moved: usize, start: usize, code: i32) -> bool {
        let argument = self.call.arguments[moved].1;
        match code {
            HYSTERON_OVERLAP => true,
            HYSTERON_ALIGNMENT => !start.is_multiple_of(argument.alignment()),
            _ => false,
        }
    }
}

#[test]
fn arguments_that_share_memory_are_refused_and_nothing_is_written() {
    let handles = Handles::new();
    let mut tried = 0;
    for call in CALLS {
        let mut arena = Arena::new(call, &handles);
        let pointers = arena.pointers();
        assert_eq!(arena.run(&pointers).0, HYSTERON_OK, "{}: apart", call.name);
        let count = pointers.len();
        let pairs = (0..count).flat_map(|moved| (0..count).map(move |other| (moved, other)));
        for (moved, other) in pairs.filter(|(moved, other)| moved != other) {
            let (own, there) = (arena.places[moved].clone(), arena.places[other].clone());
            for start in there.start + 1 - own.len()..there.end {
                let (code, same) = arena.run_moved(moved, start);
                let name = call.arguments[moved].0;
                let what = format!("{}: `{name}` moved to {start}", call.name);
                assert!(arena.refuses(moved, start, code), "{what}: {code}");
                assert!(same, "{what}: memory was written");
                tried += 1;
            }
        }
    }
    println!("{tried} calls");
}

/// The pointers of each function of the header, by the names there.
fn declared() -> Vec<(String, Vec<String>)> {
    let header = include_str!("../include/hysteron.h");
    let code: String = header
        .split("/*")
        .map(|part| part.split_once("*/").map_or(part, |(_, code)| code))
        .collect();
    let declarations = code.split(';').filter_map(|text| text.split_once('('));
    let functions = declarations.map(|(before, parameters)| {
        let name = before.rsplit([' ', '*', '\n']).next().unwrap();
        let pointers = parameters.split(',').filter(|text| text.contains('*'));
        let last_word = |text: &str| {
            let text = text.trim_end_matches(')');
            text.rsplit([' ', '*']).next().unwrap().to_owned()
        };
        (name.to_owned(), pointers.map(last_word).collect())
    });
    functions.collect()
}

/// An object's memory is an argument of each call that takes its handle.
#[test]
fn an_object_does_not_share_its_memory() {
    let handles = Handles::new();
    let bytes = signatures::state_size(&handles);
    let (mut memory, mut state) = (vec![0_u64; bytes / 8], 0);
    let at = memory.as_mut_ptr();
    // SAFETY: live memory of the size given.
    unsafe {
        let made = hysteron_state_place(handles.model, at.cast(), bytes, &mut state);
        assert_eq!(made, HYSTERON_OK);
        let mut output = 0.0;
        let step = |output: *mut f64| hysteron_step(state, 0.5, output, std::ptr::null_mut());
        assert_eq!(step(&mut output), HYSTERON_OK);
        for place in [at, at.add(bytes / 16), at.add(bytes / 8 - 1)] {
            assert_eq!(step(place.cast()), HYSTERON_OVERLAP);
        }
        assert_eq!(hysteron_state_free(state), HYSTERON_OK);
        assert_eq!(step(&mut output), HYSTERON_HANDLE);
    }
}

#[test]
fn no_function_with_two_pointers_is_missing() {
    let mut declared = declared();
    assert!(declared.len() > 40, "{} functions found", declared.len());
    declared.retain(|(_, pointers)| pointers.len() > 1);
    declared.sort();
    let names = |call: &Call| {
        call.arguments
            .iter()
            .map(|(name, _)| (*name).into())
            .collect()
    };
    let mut tested: Vec<(String, Vec<String>)> = CALLS
        .iter()
        .map(|call| (call.name.into(), names(call)))
        .collect();
    tested.sort();
    assert_eq!(tested, declared);
}

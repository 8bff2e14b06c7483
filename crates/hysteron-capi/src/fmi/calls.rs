//! Runs calls from C on an instance and returns a status.

use super::instance::Instance;
use super::logger::{CATEGORY, Logger};
use super::values::Value;
use super::{ERROR, FATAL, OK, Problem, Result, Status, resource};
use crate::handles::Table;
use crate::pointer::Arguments;
use std::ffi::{CStr, c_char, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::ptr::{null_mut, without_provenance_mut};
use std::sync::{Mutex, PoisonError};

struct Entry {
    logger: Logger,
    instance: Mutex<Instance>,
}

static INSTANCES: Table<Entry> = Table::new(8);

/// A handle in place of the standards' pointer. It is never dereferenced.
pub(crate) fn pointer_of(handle: u64) -> *mut c_void {
    without_provenance_mut(handle as usize)
}

pub(crate) fn handle_of(pointer: *mut c_void) -> u64 {
    pointer.addr() as u64
}

/// Runs a call on its instance. Messages are sent after the instance is released, because a
/// callback may call this library.
pub(crate) fn call(
    instance: *mut c_void,
    name: &str,
    work: impl FnOnce(&mut Instance) -> Result<()>,
) -> Status {
    let status = catch_unwind(AssertUnwindSafe(|| {
        let Ok(entry) = INSTANCES.get(handle_of(instance), "instance") else {
            return ERROR; // and nobody to tell it to
        };
        let held = || {
            work(
                &mut entry
                    .instance
                    .lock()
                    .unwrap_or_else(PoisonError::into_inner),
            )
        };
        match catch_unwind(AssertUnwindSafe(held)) {
            Ok(Ok(())) => OK,
            Ok(Err(problem)) => {
                entry.logger.tell(ERROR, &format!("{name}: {problem}"));
                ERROR
            }
            Err(_) => {
                entry.logger.tell(
                    FATAL,
                    &format!("{name}: a defect of hysteron, please report it"),
                );
                FATAL
            }
        }
    }));
    status.unwrap_or(FATAL)
}

/// A new instance. After an error null, and a message.
///
/// # Safety
/// Texts are null or valid.
pub(crate) unsafe fn instantiate(
    (name, token): (*const c_char, *const c_char),
    logger: impl FnOnce(&str) -> Logger,
    resources: impl FnOnce() -> Result<PathBuf>,
) -> *mut c_void {
    let made = catch_unwind(AssertUnwindSafe(|| {
        // SAFETY: the caller's promise.
        let name = unsafe { Arguments::default().text(name, "instanceName") };
        let logger = logger(name.as_ref().map_or("", |name| name));
        let block = || {
            if name?.is_empty() {
                return Err(Problem::new("the instance has no name"));
            }
            // SAFETY: the caller's promise.
            let token = unsafe { Arguments::default().text(token, "instantiationToken")? };
            let block = resource::read(&resources()?)?;
            if block.token != token {
                let own = &block.token;
                let problem = format!(
                    "the tool's GUID (instantiation token) is `{token}`, that of the model `{own}`"
                );
                return Err(Problem(problem));
            }
            Instance::new(block)
        };
        let instance = block().map(Mutex::new);
        let entry = instance.map_err(|problem| {
            logger.tell(ERROR, &format!("instantiate: {problem}"));
        });
        let entry = entry.map(|instance| Entry { logger, instance });
        entry.ok().and_then(|entry| INSTANCES.insert(entry).ok())
    }));
    made.ok().flatten().map_or(null_mut(), pointer_of)
}

pub(crate) fn free(instance: *mut c_void) {
    // Null and a freed handle are ignored: the function has no status to return.
    let _ = catch_unwind(|| INSTANCES.remove(handle_of(instance), "instance"));
}

/// Turns messages on or off.
///
/// # Safety
/// As for [`set`].
pub(crate) unsafe fn logging(
    instance: *mut c_void,
    name: &str,
    on: bool,
    (categories, count): (*const *const c_char, usize),
) -> Status {
    let mut chosen = count == 0;
    let status = call(instance, name, |_| {
        // SAFETY: the caller's promise.
        let categories = unsafe { Arguments::default().array(categories, count, "categories")? };
        for &category in categories {
            // SAFETY: the caller's promise.
            let category = unsafe { Arguments::default().text(category, "categories")? };
            match category.as_bytes() == CStr::to_bytes(CATEGORY) {
                true => chosen = true,
                false => return Err(Problem(format!("there is no log category `{category}`"))),
            }
        }
        Ok(())
    });
    if let (OK, true, Ok(entry)) = (
        status,
        chosen,
        INSTANCES.get(handle_of(instance), "instance"),
    ) {
        entry.logger.turn(on);
    }
    status
}

/// Reads variables into `values`, of type `C` there.
///
/// # Safety
/// Pointers are null or have `count` elements.
pub(crate) unsafe fn get<T: Value, C>(
    instance: &Instance,
    references: *const u32,
    count: usize,
    values: *mut C,
    outward: impl Fn(T) -> C,
) -> Result<()> {
    let mut arguments = Arguments::default();
    // SAFETY: the caller's promise.
    let (references, values) = unsafe {
        (
            arguments.array(references, count, "valueReferences")?,
            arguments.array_out(values, count, "values")?,
        )
    };
    for (n, &reference) in references.iter().enumerate() {
        values.set(n, outward(T::get(instance, reference)?));
    }
    Ok(())
}

/// Sets variables from `values`, of type `C` there.
///
/// # Safety
/// Pointers are null or have `count` elements.
pub(crate) unsafe fn set<T: Value, C: Copy>(
    instance: &mut Instance,
    references: *const u32,
    count: usize,
    values: *const C,
    inward: impl Fn(C) -> T,
) -> Result<()> {
    let mut arguments = Arguments::default();
    // SAFETY: the caller's promise.
    let (references, values) = unsafe {
        (
            arguments.array(references, count, "valueReferences")?,
            arguments.array(values, count, "values")?,
        )
    };
    let values = values.iter().map(|value| inward(*value));
    instance.set(references.iter().copied().zip(values))
}

/// Functions that this FMU does not have, according to its description. By the arguments after the
/// instance.
macro_rules! refused {
    ($($name:ident($($more:ty),*);)*) => {$(
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(c: *mut std::ffi::c_void, $(_: $more),*) -> $crate::fmi::Status {
            let problem = "this FMU does not offer it, as its description says";
            $crate::fmi::calls::call(c, stringify!($name), |_| Err($crate::fmi::Problem::new(problem)))
        }
    )*};
}
pub(crate) use refused;

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic)]
    use super::*;
    use crate::fmi::block::{Block, Kind};
    use crate::fmi::logger::Callback;
    use hysteron_core::{Model, Operator, Plane, table_len};

    unsafe extern "C" fn note(
        status: *mut c_void,
        said: Status,
        _: *const c_char,
        _: *const c_char,
    ) {
        // SAFETY: the test's own number.
        unsafe { status.cast::<Status>().write(said) }
    }

    #[test]
    fn a_panic_becomes_a_status() {
        let plane = Plane::new(0.0, 1.0, 2).unwrap();
        let table = vec![0.0; table_len(2)];
        let block = Block {
            kind: Kind::Forward,
            token: String::new(),
            checksum: 0,
            model: Model::new(plane, Operator::Mkp, &[1.0; 3], table).unwrap(),
            offset: 0.0,
            sign: 1.0,
            stages: None,
            by_load: None,
            dead: (0, 0.0),
            control: crate::fmi::settings::Control::NONE,
            start: None,
            first: (0.0, 0.0),
        };
        let mut said = OK;
        let logger = Logger::new("spring", (&raw mut said).cast(), Callback::Fmi3(note));
        let instance = Mutex::new(Instance::new(block).unwrap());
        let handle = INSTANCES.insert(Entry { logger, instance }).ok().unwrap();
        let status = call(pointer_of(handle), "f", |_| panic!("meant to be"));
        assert_eq!((status, said), (FATAL, FATAL));
        assert_eq!(call(pointer_of(handle), "f", |_| Ok(())), OK);
        free(pointer_of(handle));
        assert_eq!(call(pointer_of(handle), "f", |_| Ok(())), ERROR);
    }
}

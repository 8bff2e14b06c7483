//! The functions of both standards in one form, over an FMU that was unpacked.
// Some of the functions take handles alone: the macro below does not know which.
#![allow(unused_unsafe)]

use hysteron::control::Scheme;
use hysteron_capi::fmi::{fmi2, fmi3};
use hysteron_export::{Fmi, Fmu, FmuOptions, fmu, fmu_controlled};
use std::ffi::{CStr, CString, c_char, c_void};
use std::path::{Path, PathBuf};
use std::ptr::{null, null_mut};

pub const TIME: u32 = 0;
pub const SIGNAL: u32 = 1;
pub const RESULT: u32 = 2;
pub const FLAG: u32 = 3;
pub const HEADING: u32 = 4;
pub const TOLERANCE: u32 = 5;
pub const START_ON: u32 = 6;
pub const LOAD: u32 = 7;
pub const TEMPERATURE: u32 = 8;
pub const MEASURED: u32 = 9;
pub const AHEAD: u32 = 10;
pub const MANUAL: u32 = 11;
pub const MANUAL_DRIVE: u32 = 12;
pub const GAIN: u32 = 13;

/// One place after the other, but every so many under Miri, which takes a thousand times as long.
pub fn stride(under_miri: usize) -> usize {
    if cfg!(miri) { under_miri } else { 1 }
}

/// An FMU in a folder.
pub struct Unpacked {
    folder: tempfile::TempDir,
    pub token: String,
    pub fmi: Fmi,
}

impl Unpacked {
    pub fn new(model: &hysteron::Model, inverse: bool, fmi: Fmi) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a b.fmu");
        let options = FmuOptions {
            inverse,
            fmi,
            name: None,
        };
        let made = fmu(model, &options, &path).unwrap();
        Self::of(folder, made, fmi)
    }

    /// A controller.
    pub fn controller(model: &hysteron::Model, scheme: &Scheme, fmi: Fmi) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a b.fmu");
        let options = FmuOptions {
            fmi,
            ..FmuOptions::default()
        };
        let made = fmu_controlled(model, scheme, &options, &path).unwrap();
        Self::of(folder, made, fmi)
    }

    fn of(folder: tempfile::TempDir, made: Fmu, fmi: Fmi) -> Self {
        let path = folder.path().join("a b.fmu");
        let mut archive = zip::ZipArchive::new(std::fs::File::open(&path).unwrap()).unwrap();
        archive.extract(folder.path().join("ä b%")).unwrap();
        Self {
            folder,
            token: made.token,
            fmi,
        }
    }

    pub fn resources(&self) -> PathBuf {
        self.folder.path().join("ä b%/resources")
    }

    /// As tools give it: a URI in FMI 2.0, a path in FMI 3.0.
    fn location(&self) -> CString {
        let path = self.resources().to_str().unwrap().to_owned();
        let text = match self.fmi {
            Fmi::V2 => format!(
                "file://{}",
                path.replace('%', "%25")
                    .replace('ä', "%C3%A4")
                    .replace(' ', "%20")
            ),
            Fmi::V3 => path + "/",
        };
        CString::new(text).unwrap()
    }

    pub fn try_instance(&self, log: Option<&mut Vec<String>>) -> Option<Instance> {
        self.with_token(&self.token, log)
    }

    pub fn with_token(&self, token: &str, log: Option<&mut Vec<String>>) -> Option<Instance> {
        let (name, token) = (c"spring".as_ptr(), CString::new(token).unwrap());
        let location = self.location();
        let handle = match self.fmi {
            Fmi::V2 => {
                let callbacks = fmi2::Callbacks {
                    logger: None, // variadic: only C can write one
                    allocate_memory: null(),
                    free_memory: null(),
                    step_finished: null(),
                    environment: null_mut(),
                };
                unsafe {
                    fmi2::fmi2Instantiate(
                        name,
                        1,
                        token.as_ptr(),
                        location.as_ptr(),
                        &callbacks,
                        0,
                        1,
                    )
                }
            }
            Fmi::V3 => {
                let environment = log.map_or(null_mut(), |log| (&raw mut *log).cast());
                unsafe {
                    fmi3::fmi3InstantiateCoSimulation(
                        name,
                        token.as_ptr(),
                        location.as_ptr(),
                        0,
                        1,
                        0,
                        0,
                        null(),
                        0,
                        environment,
                        Some(keep),
                        null(),
                    )
                }
            }
        };
        (!handle.is_null()).then_some(Instance {
            handle,
            fmi: self.fmi,
        })
    }

    pub fn instance(&self) -> Instance {
        self.try_instance(None).unwrap()
    }

    /// An instance past initialisation.
    pub fn started(&self) -> Instance {
        let instance = self.instance();
        assert_eq!(instance.initialise(0.0), 0);
        instance
    }
}

unsafe extern "C" fn keep(
    log: *mut c_void,
    status: i32,
    category: *const c_char,
    text: *const c_char,
) {
    if log.is_null() {
        return;
    }
    unsafe {
        assert_eq!((status, CStr::from_ptr(category)), (3, c"logStatusError"));
        let text = CStr::from_ptr(text).to_str().unwrap().to_owned();
        (*log.cast::<Vec<String>>()).push(text);
    }
}

#[derive(Clone, Copy)]
pub struct Instance {
    pub handle: *mut c_void,
    pub fmi: Fmi,
}

// SAFETY: a handle may be used from any thread.
unsafe impl Send for Instance {}

macro_rules! both {
    ($self:ident, $two:expr, $three:expr) => {
        match $self.fmi {
            Fmi::V2 => unsafe { $two },
            Fmi::V3 => unsafe { $three },
        }
    };
}

impl Instance {
    pub fn enter(self, start: f64) -> i32 {
        both!(
            self,
            match fmi2::fmi2SetupExperiment(self.handle, 0, 0.0, start, 0, 0.0) {
                0 => fmi2::fmi2EnterInitializationMode(self.handle),
                fault => fault,
            },
            fmi3::fmi3EnterInitializationMode(self.handle, 0, 0.0, start, 0, 0.0)
        )
    }

    pub fn exit(self) -> i32 {
        both!(
            self,
            fmi2::fmi2ExitInitializationMode(self.handle),
            fmi3::fmi3ExitInitializationMode(self.handle)
        )
    }

    pub fn initialise(self, start: f64) -> i32 {
        match self.enter(start) {
            0 => self.exit(),
            fault => fault,
        }
    }

    pub fn set(self, reference: u32, value: f64) -> i32 {
        both!(
            self,
            fmi2::fmi2SetReal(self.handle, &reference, 1, &value),
            fmi3::fmi3SetFloat64(self.handle, &reference, 1, &value, 1)
        )
    }

    pub fn set_integer(self, reference: u32, value: i32) -> i32 {
        both!(
            self,
            fmi2::fmi2SetInteger(self.handle, &reference, 1, &value),
            fmi3::fmi3SetInt32(self.handle, &reference, 1, &value, 1)
        )
    }

    pub fn set_boolean(self, reference: u32, value: bool) -> i32 {
        both!(
            self,
            fmi2::fmi2SetBoolean(self.handle, &reference, 1, &i32::from(value)),
            fmi3::fmi3SetBoolean(self.handle, &reference, 1, &u8::from(value), 1)
        )
    }

    pub fn get(self, reference: u32) -> Result<f64, i32> {
        let mut value = 0.0;
        let status = both!(
            self,
            fmi2::fmi2GetReal(self.handle, &reference, 1, &mut value),
            fmi3::fmi3GetFloat64(self.handle, &reference, 1, &mut value, 1)
        );
        if status == 0 { Ok(value) } else { Err(status) }
    }

    pub fn get_integer(self, reference: u32) -> Result<i32, i32> {
        let mut value = 0;
        let status = both!(
            self,
            fmi2::fmi2GetInteger(self.handle, &reference, 1, &mut value),
            fmi3::fmi3GetInt32(self.handle, &reference, 1, &mut value, 1)
        );
        if status == 0 { Ok(value) } else { Err(status) }
    }

    pub fn outputs(self) -> (u64, i32) {
        (
            self.get(RESULT).unwrap().to_bits(),
            self.get_integer(FLAG).unwrap(),
        )
    }

    pub fn step(self, from: f64, size: f64) -> i32 {
        let (mut flags, mut last) = ([9_u8; 3], f64::NAN);
        let [event, terminate, early] = &mut flags;
        let status = both!(
            self,
            fmi2::fmi2DoStep(self.handle, from, size, 1),
            fmi3::fmi3DoStep(
                self.handle,
                from,
                size,
                1,
                event,
                terminate,
                early,
                &mut last
            )
        );
        if status == 0 && self.fmi == Fmi::V3 {
            assert_eq!((flags, last), ([0; 3], from + size));
        }
        status
    }

    /// The next step of size 1 with an input.
    pub fn next(self, input: f64) -> i32 {
        assert_eq!(self.set(SIGNAL, input), 0);
        self.step(self.get(TIME).unwrap(), 1.0)
    }

    pub fn terminate(self) -> i32 {
        both!(
            self,
            fmi2::fmi2Terminate(self.handle),
            fmi3::fmi3Terminate(self.handle)
        )
    }

    pub fn reset(self) -> i32 {
        both!(
            self,
            fmi2::fmi2Reset(self.handle),
            fmi3::fmi3Reset(self.handle)
        )
    }

    pub fn free(self) {
        match self.fmi {
            Fmi::V2 => fmi2::fmi2FreeInstance(self.handle),
            Fmi::V3 => fmi3::fmi3FreeInstance(self.handle),
        }
    }

    /// Saves into `state`, over an older one where it is not null.
    pub fn save(self, state: &mut *mut c_void) -> i32 {
        both!(
            self,
            fmi2::fmi2GetFMUstate(self.handle, state),
            fmi3::fmi3GetFMUState(self.handle, state)
        )
    }

    pub fn restore(self, state: *mut c_void) -> i32 {
        both!(
            self,
            fmi2::fmi2SetFMUstate(self.handle, state),
            fmi3::fmi3SetFMUState(self.handle, state)
        )
    }

    pub fn forget(self, state: &mut *mut c_void) -> i32 {
        both!(
            self,
            fmi2::fmi2FreeFMUstate(self.handle, state),
            fmi3::fmi3FreeFMUState(self.handle, state)
        )
    }

    pub fn serialise(self, state: *mut c_void) -> Vec<u8> {
        let mut size = 0;
        let status = both!(
            self,
            fmi2::fmi2SerializedFMUstateSize(self.handle, state, &mut size),
            fmi3::fmi3SerializedFMUStateSize(self.handle, state, &mut size)
        );
        assert_eq!(status, 0);
        let mut bytes = vec![0; size];
        let mut into = |size| {
            both!(
                self,
                fmi2::fmi2SerializeFMUstate(self.handle, state, bytes.as_mut_ptr(), size),
                fmi3::fmi3SerializeFMUState(self.handle, state, bytes.as_mut_ptr(), size)
            )
        };
        assert_eq!((into(size - 1), into(size)), (3, 0));
        bytes
    }

    pub fn deserialise(self, bytes: &[u8], state: &mut *mut c_void) -> i32 {
        both!(
            self,
            fmi2::fmi2DeSerializeFMUstate(self.handle, bytes.as_ptr(), bytes.len(), state),
            fmi3::fmi3DeserializeFMUState(self.handle, bytes.as_ptr(), bytes.len(), state)
        )
    }
}

pub fn vectors() -> impl Iterator<Item = serde_json::Value> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../vectors");
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    paths.retain(|path| path.extension().is_some_and(|end| end == "json"));
    paths.sort();
    assert!(paths.len() >= 30);
    paths
        .into_iter()
        .map(|path| serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap())
}

pub fn vector(name: &str) -> serde_json::Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../vectors/{name}.json"));
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

pub fn model(vector: &serde_json::Value) -> hysteron::Model {
    hysteron::Model::from_json(&vector["model"].to_string()).unwrap()
}

pub fn numbers(run: &serde_json::Value, column: &str) -> Vec<f64> {
    let column = run[column].as_array().unwrap();
    column
        .iter()
        .map(|number| number.as_f64().unwrap())
        .collect()
}

//! What is wrong with a request.

use hysteron::{Error, Setting, SettingValue};
use serde::{Deserialize, Serialize};

/// Why a request was refused.
///
/// | `code` | meaning |
/// | --- | --- |
/// | below 100 | that of the library, [`hysteron::Error::code`] |
/// | 100 | a file, a fit, a job or a drive that is not open |
/// | 101 | more memory than is left |
/// | 102 | not possible in this session now; `problem` says what is missing |
/// | 103 | the work was cancelled |
/// | 104 | a defect of the studio |
/// | 105 | a session file that cannot be read |
/// | 106 | a session file that is not written |
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, thiserror::Error)]
#[error("{problem}")]
pub struct Fault {
    /// The kind; it never changes.
    pub code: i32,
    /// What is wrong, and where.
    pub problem: String,
    /// What to do, in the words of the page.
    pub remedy: Option<String>,
}

impl Fault {
    fn new(code: i32, problem: String) -> Self {
        Self {
            code,
            problem,
            remedy: None,
        }
    }

    pub(crate) fn gone(what: &str, id: u64) -> Self {
        Self::new(
            100,
            format!("there is no {what} number {id} in this session"),
        )
    }

    /// Whether it names something that is not open.
    pub(crate) fn is_gone(&self) -> bool {
        self.code == 100
    }

    pub(crate) fn too_large(name: &str, left: u64) -> Self {
        let mib = left / (1 << 20);
        let problem = format!("{name} takes more memory than the {mib} MiB that are left");
        let remedy = "close other files, or give `hysteron studio` a larger --max-memory";
        Self {
            remedy: Some(remedy.into()),
            ..Self::new(101, problem)
        }
    }

    pub(crate) fn missing(problem: &str, remedy: &str) -> Self {
        Self {
            remedy: Some(remedy.into()),
            ..Self::new(102, problem.into())
        }
    }

    pub(crate) fn cancelled() -> Self {
        Self::new(103, "the fit was cancelled".into())
    }

    /// A defect of the studio, with what is known of it.
    #[must_use]
    pub fn defect(what: &str) -> Self {
        Self::new(104, format!("a defect of the studio: {what}"))
    }

    /// Why the session is not written to its file.
    #[cfg(feature = "server")]
    pub(crate) fn not_kept(problem: &str) -> Self {
        let remedy = "take the session home, and begin again with another file";
        Self {
            remedy: Some(remedy.into()),
            ..Self::new(106, format!("the session is not saved: {problem}"))
        }
    }

    pub(crate) fn session(problem: String) -> Self {
        Self::new(105, format!("the session file cannot be read: {problem}"))
    }
}

/// An option as the page names it.
pub(crate) fn spelt(setting: &Setting) -> String {
    let name = match setting.name {
        "repair" => "Repair rows",
        "prepare" => "Prepare",
        name => name,
    };
    match setting.value {
        SettingValue::Any | SettingValue::On => format!("“{name}”"),
        value => format!("“{name}” {value}"),
    }
}

impl From<hysteron_files::Error> for Fault {
    fn from(error: hysteron_files::Error) -> Self {
        Error::from(error).into()
    }
}

impl From<Error> for Fault {
    fn from(error: Error) -> Self {
        let (plain, remedy) = error.parts();
        Self {
            remedy: remedy.map(|remedy| remedy.spelt(spelt)),
            ..Self::new(
                error.code(),
                hysteron_files::printable(&plain.to_string()).into_owned(),
            )
        }
    }
}

//! The C interface of hysteron: handles to objects. Each state and each learner has its numbers in
//! memory of the library (`…_new`) or of the caller (`…_place`); all other functions are the same.
//! The feature `fmi` adds the functions of an FMU's binary.
//!
//! Every function that can fail returns a status: [`HYSTERON_OK`], the number of the library's
//! error (`hysteron::Error::code`), or a number from 100 on for an error in the call itself.
//! Results are written only with [`HYSTERON_OK`]. Counts are the exception: after an error they
//! give the size needed, and arrays of a run, which may then have zeros. No panic leaves a
//! function.
//!
//! # Safety
//! All functions have the same contract. A pointer is null, or it points to as many elements as the
//! count beside it says, one where there is no count. The memory is valid during the call. Texts
//! end with a zero byte. Functions refuse null pointers, wrong alignment, and two pointers of a
//! call that share memory. They cannot tell whether other memory is valid. Handles are safe: a
//! number that is not the handle of a live object is refused.
// Each function has the contract above. C functions need many arguments.
#![allow(clippy::missing_safety_doc, clippy::too_many_arguments)]
// Without the handles, some shared code is unused.
#![cfg_attr(not(feature = "handles"), allow(dead_code))]

#[cfg(feature = "handles")]
mod adaptive;
#[cfg(feature = "handles")]
mod batch;
mod codes;
#[cfg(feature = "handles")]
mod control;
#[cfg(feature = "handles")]
mod controller;
mod delay;
mod fault;
/// cbindgen:ignore
#[cfg(feature = "fmi")]
pub mod fmi;
mod handles;
mod last_error;
#[cfg(feature = "handles")]
mod late;
#[cfg(feature = "handles")]
mod learners;
#[cfg(feature = "handles")]
mod limits;
#[cfg(feature = "handles")]
mod memory;
#[cfg(feature = "handles")]
mod model;
#[cfg(feature = "handles")]
mod objects;
#[cfg(feature = "handles")]
mod path;
mod pointer;
#[cfg(feature = "handles")]
mod shift_options;
#[cfg(feature = "handles")]
mod stage_state;
#[cfg(feature = "handles")]
mod state;
#[cfg(feature = "handles")]
mod steps;
#[cfg(feature = "handles")]
mod types;

#[cfg(feature = "handles")]
pub use adaptive::*;
#[cfg(feature = "handles")]
pub use batch::*;
pub use codes::*;
#[cfg(feature = "handles")]
pub use control::*;
#[cfg(feature = "handles")]
pub use controller::*;
pub use last_error::hysteron_last_error;
#[cfg(feature = "handles")]
pub use limits::*;
#[cfg(feature = "handles")]
pub use model::*;
#[cfg(feature = "handles")]
pub use shift_options::*;
#[cfg(feature = "handles")]
pub use stage_state::*;
#[cfg(feature = "handles")]
pub use state::*;
#[cfg(feature = "handles")]
pub use steps::*;
#[cfg(feature = "handles")]
pub use types::*;

//! The C interface of hysteron. It has two forms: handles to objects of the library, and objects of
//! the core in memory of the caller. The feature `fmi` adds the functions of an FMU's binary.
//!
//! Every function that can fail returns a status: [`HYSTERON_OK`], the number of the library's
//! error (`hysteron::Error::code`), or a number from 100 on for an error in the call itself.
//! Results are written only with [`HYSTERON_OK`]. Counts are the exception: after an error they
//! give the size needed. No panic leaves a function.
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
mod adaptive_load;
#[cfg(feature = "handles")]
mod batch;
#[cfg(feature = "handles")]
mod chain;
mod codes;
#[cfg(feature = "handles")]
mod estimator;
mod fault;
/// cbindgen:ignore
#[cfg(feature = "fmi")]
pub mod fmi;
mod handles;
mod last_error;
#[cfg(feature = "handles")]
mod limits;
#[cfg(feature = "handles")]
mod memory;
#[cfg(feature = "handles")]
mod model;
#[cfg(feature = "handles")]
mod parts;
mod pointer;
#[cfg(feature = "handles")]
mod room;
#[cfg(feature = "handles")]
mod shift;
#[cfg(feature = "handles")]
mod shift_options;
#[cfg(feature = "handles")]
mod stage_state;
#[cfg(feature = "handles")]
mod stages;
#[cfg(feature = "handles")]
mod state;
#[cfg(feature = "handles")]
mod surroundings;
#[cfg(feature = "handles")]
mod types;

#[cfg(feature = "handles")]
pub use adaptive::*;
#[cfg(feature = "handles")]
pub use adaptive_load::*;
#[cfg(feature = "handles")]
pub use batch::*;
#[cfg(feature = "handles")]
pub use chain::*;
pub use codes::*;
#[cfg(feature = "handles")]
pub use estimator::*;
pub use last_error::hysteron_last_error;
#[cfg(feature = "handles")]
pub use limits::*;
#[cfg(feature = "handles")]
pub use memory::*;
#[cfg(feature = "handles")]
pub use model::*;
#[cfg(feature = "handles")]
pub use parts::*;
#[cfg(feature = "handles")]
pub use shift::*;
#[cfg(feature = "handles")]
pub use shift_options::*;
#[cfg(feature = "handles")]
pub use stage_state::*;
#[cfg(feature = "handles")]
pub use stages::*;
#[cfg(feature = "handles")]
pub use state::*;
#[cfg(feature = "handles")]
pub use surroundings::*;
#[cfg(feature = "handles")]
pub use types::*;

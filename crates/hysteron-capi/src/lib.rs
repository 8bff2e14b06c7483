//! The C interface of hysteron, in two forms: handles over the façade, and the core over memory that the caller owns.
//! With the feature `fmi`, the functions of an FMU's binary as well.
//!
//! Every function that can fail returns a status: [`HYSTERON_OK`], the number of the library's own error
//! (`hysteron::Error::code`), or one from 100 on for a fault in the call itself. Outputs are written only with
//! [`HYSTERON_OK`], but for counts that say how much room is needed. No panic leaves a function.
//!
//! # Safety
//! One contract for all functions: a pointer is null or points to as many elements as the count beside it says (one where
//! there is no count), valid for the call; texts end with a zero byte. Null, wrong alignment, and two pointers of a call that
//! share memory are refused; whether other memory is valid nobody can tell. Handles need no care: whatever number is passed, it is
//! one that lives or it is refused.
// The contract above is that of each function; C has no better way to pass many things than many arguments.
#![allow(clippy::missing_safety_doc, clippy::too_many_arguments)]
// Without the handles some of what both parts share has no use.
#![cfg_attr(not(feature = "handles"), allow(dead_code))]

#[cfg(feature = "handles")]
mod adaptive;
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
mod memory;
#[cfg(feature = "handles")]
mod model;
mod pointer;
#[cfg(feature = "handles")]
mod room;
#[cfg(feature = "handles")]
mod state;
#[cfg(feature = "handles")]
mod types;

#[cfg(feature = "handles")]
pub use adaptive::*;
pub use codes::*;
#[cfg(feature = "handles")]
pub use estimator::*;
pub use last_error::hysteron_last_error;
#[cfg(feature = "handles")]
pub use memory::*;
#[cfg(feature = "handles")]
pub use model::*;
#[cfg(feature = "handles")]
pub use state::*;
#[cfg(feature = "handles")]
pub use types::*;

//! The C interface of hysteron, in two forms: handles over the façade, and the core over memory that the caller owns.
//!
//! Every function that can fail returns a status: [`HYSTERON_OK`], the number of the library's own error
//! (`hysteron::Error::code`), or one from 100 on for a fault in the call itself. Outputs are written only with
//! [`HYSTERON_OK`], but for counts that say how much room is needed. No panic leaves a function.
//!
//! # Safety
//! One contract for all functions: a pointer is null or points to as many elements as the count beside it says (one where
//! there is no count), valid for the call; texts end with a zero byte. Null, wrong alignment, and arrays that overlap
//! are refused; whether other memory is valid nobody can tell. Handles need no care: whatever number is passed, it is
//! one that lives or it is refused.
// The contract above is that of each function; C has no better way to pass many things than many arguments.
#![allow(clippy::missing_safety_doc, clippy::too_many_arguments)]

mod adaptive;
mod codes;
mod estimator;
mod fault;
mod handles;
mod memory;
mod model;
mod pointer;
mod room;
mod state;
mod types;

pub use adaptive::*;
pub use codes::*;
pub use estimator::*;
pub use fault::hysteron_last_error;
pub use memory::*;
pub use model::*;
pub use state::*;
pub use types::*;

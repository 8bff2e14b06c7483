//! Model files, and what the first bytes of a file show.

mod head;
mod model;

pub(crate) use head::begins_as_model;
#[cfg(feature = "data")]
pub(crate) use head::{begins_as_json, begins_with, contains};

//! The session of the studio for a worker of a browser: the other transport beside the server.
//!
//! `host` is the session and what a page is told of it, in bytes and texts. `abi` gives it to
//! JavaScript: functions of numbers, and two buffers. `tools/static-studio` builds it.
//!
//! A browser has no threads here. So a fit is a job that is carried, as bytes, to another worker
//! with an instance of its own, and what it found is carried back. The session answers meanwhile,
//! and a fit that is cancelled ends with its worker.

pub mod abi;
mod host;

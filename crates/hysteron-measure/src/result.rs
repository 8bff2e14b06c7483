//! The result of every program: what goes wrong is only printed.

pub(crate) type Result<T, E = Box<dyn std::error::Error>> = std::result::Result<T, E>;

//! Clean recordings, faults that are put into them, and what comes of those with the command that
//! is advised. The test of the property and the program that prints `docs/measured/faults.md`
//! share it.

pub mod advised;
pub mod clean;
pub mod fault;

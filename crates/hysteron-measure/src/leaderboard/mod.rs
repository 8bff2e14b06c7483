//! The parts of the leaderboard: what is predicted, by which methods, and entries of others.

pub mod cycles;
pub mod entry;
pub mod methods;
pub mod prandtl;
pub mod splits;

pub type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

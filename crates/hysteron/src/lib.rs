//! hysteron
pub mod evaluate;
pub mod metrics;
pub mod model;
pub mod recording;

//! A fleet of actuators: how their errors and loops are distributed, and which are unlike the
//! others.

mod distances;
mod distributions;
mod loops;
mod page;
mod report;
mod view;

pub use report::FleetReport;

#[cfg(test)]
mod tests;

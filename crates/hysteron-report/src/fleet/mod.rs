//! The report of a fleet of actuators.

mod distances;
mod distributions;
mod loops;
mod page;
mod view;

pub(crate) use view::View;

#[cfg(test)]
mod tests;

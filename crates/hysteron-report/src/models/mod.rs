//! The report of models beside each other on one recording.

mod page;
mod residuals;
mod view;

pub use view::NamedForward;
pub(crate) use view::View;

#[cfg(test)]
mod tests;

//! One file per kind of figure.

mod close_up;
mod cross_validation;
mod discrepancy;
mod evolution;
mod excitation_map;
mod load_loops;
mod load_measured;
mod load_shift;
mod loops;
mod over_time;
mod residuals;
mod standard_errors;
mod weights_map;
mod weights_plane;

pub use excitation_map::excitation_map;

pub(crate) use close_up::find as dead_band_shown;
pub(crate) use cross_validation::{SHOWN, choices_hidden};
pub(crate) use excitation_map::counts as classes_counted;
pub(crate) use load_measured::resting as resting_loads;
pub(crate) use standard_errors::known as known_errors;

use crate::draw::sheet::Drawing;
use crate::evaluation::figure::Figure;
use crate::evaluation::view::View;

/// The figure; `None` where this report has no such figure.
pub(crate) fn svg(figure: Figure, view: &View<'_>) -> Option<Drawing> {
    match figure {
        Figure::PlaneEvolution => Some(evolution::svg(view)),
        Figure::WeightsPlane => Some(weights_plane::svg(view)),
        Figure::WeightsMap => Some(weights_map::svg(view)),
        Figure::LoadLoops => load_loops::svg(view),
        Figure::LoadShift => load_shift::svg(view),
        Figure::LoadMeasured => load_measured::svg(view),
        Figure::Excitation => excitation_map::of_model(view),
        Figure::StandardErrors => standard_errors::svg(view),
        Figure::CrossValidation => cross_validation::svg(view),
        Figure::OutputTime => Some(over_time::output(view)),
        Figure::Loops => Some(loops::svg(view)),
        Figure::OutputDiscrepancy => Some(discrepancy::output(view)),
        Figure::OutputResiduals | Figure::OutputHistogram => Some(residuals::svg(figure, view)),
        Figure::InputTime => over_time::input(view),
        Figure::InputDiscrepancy => discrepancy::input(view),
        Figure::DeadBand => close_up::svg(view),
    }
}

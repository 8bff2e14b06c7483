//! One file per kind of figure.

mod close_up;
mod discrepancy;
mod evolution;
mod excitation_map;
mod loops;
mod over_time;
mod weights_map;
mod weights_plane;

pub use excitation_map::excitation_map;

pub(crate) use close_up::find as dead_band_shown;

use crate::captions;
use crate::draw::sheet::Sheet;
use crate::figure::Figure;
use crate::view::View;

/// The figure as SVG; `None` where this report has no such figure.
pub(crate) fn svg(figure: Figure, view: &View<'_>) -> Option<String> {
    match figure {
        Figure::PlaneEvolution => Some(evolution::svg(view)),
        Figure::WeightsPlane => Some(weights_plane::svg(view)),
        Figure::WeightsMap => Some(weights_map::svg(view)),
        Figure::OutputTime => Some(over_time::output(view)),
        Figure::Loops => Some(loops::svg(view)),
        Figure::OutputDiscrepancy => Some(discrepancy::output(view)),
        Figure::InputTime => over_time::input(view),
        Figure::InputDiscrepancy => discrepancy::input(view),
        Figure::DeadBand => close_up::svg(view),
    }
}

/// The empty sheet of a figure.
fn sheet(figure: Figure, view: &View<'_>, width: f64) -> Sheet {
    Sheet::new(
        figure.stem(),
        width,
        &captions::title(figure, view),
        view.note(),
    )
}

/// The finished figure with its caption as spoken text.
fn finish(figure: Figure, view: &View<'_>, sheet: Sheet, height: f64) -> String {
    sheet.finish(height, &captions::caption(figure, view))
}

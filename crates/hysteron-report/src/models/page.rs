//! The page of models beside each other.

use super::view::{Figure, View};
use crate::draw::sheet::Drawing;
use crate::frame;
use crate::made;
use crate::number::{count, percent, significant};
use crate::stack::Figures;
use maud::{Markup, html};

/// The page around the figures in `drawn`.
pub(super) fn html(view: &View<'_>, drawn: &[(Figure, Drawing)]) -> String {
    let lead = html! {
        "Models of " (view.output.name) " over " (view.input.name) ", on one recording of "
        (count(view.report.recording.input.len())) " samples."
    };
    let simulated =
        "Simulated: this recording comes from a simulated plant, not from a measurement.";
    let body = html! {
        (table(view))
        @if let Some(source) = &view.report.recording.source {
            p { "Recording: " (made::file(&source.path.display().to_string(), Some(&source.sha256))) }
        }
        @for figure in View::ALL { (view.picture(*figure, drawn, html! {})) }
    };
    let simulated = view.simulated().then_some(simulated);
    frame::html(
        view.report.title,
        lead,
        simulated,
        body,
        view.report.made,
        view.scripts(drawn),
    )
}

fn table(view: &View<'_>) -> Markup {
    let unit = match &view.output.unit {
        Some(unit) => format!(" [{unit}]"),
        None => String::new(),
    };
    html! {
        div.wide { table {
            thead { tr {
                th scope="col" { "Model" }
                th scope="col" { "RMSE" (unit) }
                th scope="col" { "max" (unit) }
                th scope="col" { "RMSE of range" }
            } }
            tbody { @for model in view.report.models {
                @let errors = &model.forward.errors;
                tr {
                    th scope="row" {
                        (model.name)
                        @if model.forward.was_fitted { " (fitted to this recording)" }
                        @else if model.forward.seen_for_band { " (band widened to this recording)" }
                    }
                    td { (significant(errors.rmse, 3)) }
                    td { (significant(errors.max_abs, 3)) }
                    td { (errors.nrmse_percent.map_or("–".to_owned(), percent)) }
                }
            } }
        } }
    }
}

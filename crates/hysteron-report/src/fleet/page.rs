//! The page of a fleet.

use super::view::{Figure, View};
use crate::draw::sheet::Drawing;
use crate::frame;
use crate::number::{count, percent, significant};
use crate::stack::Figures;
use maud::{Markup, html};

/// Actuators in the table, at most.
const LISTED: usize = 50;

/// The page around the figures in `drawn`.
pub(super) fn html(view: &View<'_>, drawn: &[(Figure, Drawing)]) -> String {
    let lead = html! {
        (count(view.ordered.len())) " actuators: " (view.output.name) " over " (view.input.name)
        ". " (count(view.outliers())) " are unlike the others."
    };
    let simulated = "Simulated: recordings of this fleet come from a simulated plant, not from a \
                     measurement.";
    let body = html! {
        @for figure in View::ALL { (view.picture(*figure, drawn, html! {})) }
        (table(view))
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

/// The outliers, or the ten strangest where there are fewer.
fn table(view: &View<'_>) -> Markup {
    let listed = view.outliers().clamp(View::DRAWN, LISTED);
    let unit = |unit: &Option<String>| match unit {
        Some(unit) => format!(" [{unit}]"),
        None => String::new(),
    };
    let [output, input] = [&view.output, &view.input].map(|q| unit(&q.unit));
    let optional = |value: Option<f64>| value.map_or("–".to_owned(), |v| significant(v, 4));
    html! {
        div.wide { table {
            thead { tr {
                th scope="col" { "Actuator" }
                th scope="col" { "Distance" }
                th scope="col" { "Stands out by" }
                th scope="col" { "RMSE of range" }
                th scope="col" { "Stroke" (output) }
                th scope="col" { "Width" (input) }
                th scope="col" { "Position" (input) }
            } }
            tbody { @for (row, strange) in view.ordered.iter().take(listed) {
                @let (name, by) = strange.most();
                @let error = row.model.fit.as_ref().map(|fit| fit.nrmse_percent);
                tr {
                    th scope="row" { (row.id) @if !strange.is_outlier() { " (within the limit)" } }
                    td { (significant(strange.distance, 3)) }
                    td { (name) " " (format!("{by:+.1}")) }
                    td { (error.map_or("–".to_owned(), percent)) }
                    td { (significant(row.shape.stroke, 4)) }
                    td { (optional(row.shape.width)) }
                    td { (optional(row.shape.position)) }
                }
            } }
        } }
    }
}

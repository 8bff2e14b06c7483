//! The page of a comparison.

use super::figure::Figure;
use super::view::View;
use crate::draw::sheet::Drawing;
use crate::frame;
use crate::number::{count, significant};
use crate::stack::Figures;
use maud::{Markup, html};

/// The sections of the page and their figures.
const SECTIONS: [(&str, &[Figure]); 4] = [
    ("Tracking", &[Figure::Tracking, Figure::Error]),
    ("Reversals", &[Figure::Reversal]),
    ("What the controllers did", &[Figure::Input, Figure::Drive]),
    (
        "The model",
        &[Figure::Prediction, Figure::WeightsTime, Figure::BeforeAfter],
    ),
];

/// The page around the figures in `drawn`.
pub(super) fn html(view: &View<'_>, drawn: &[(Figure, Drawing)]) -> String {
    let lead = html! {
        "Control of the " (view.output.name)
        @if view.has_drive() { " by " (view.drive.name) "," }
        " through the hysteresis of its " (view.input.name) ": " (runs(view)) "."
    };
    let simulated = "Simulated: these runs come from a simulated plant, not from a device.";
    let body = html! {
        (table(view))
        (facts(view))
        @for (name, figures) in SECTIONS { (section(name, figures, view, drawn)) }
        @if view.reversal.is_none() {
            p { "The reference does not reverse before the first event: there is no lag to show." }
        }
        @if view.adapting().next().is_none() { p { "No controller adapted its weights." } }
    };
    let simulated = view.report.simulated.then_some(simulated);
    frame::html(
        view.report.title,
        lead,
        simulated,
        body,
        view.report.made,
        view.scripts(drawn),
    )
}

fn runs(view: &View<'_>) -> String {
    match view.report.runs.len() {
        1 => "one controller".into(),
        several => format!("{several} controllers"),
    }
}

/// A number of a table; a dash where there is none.
fn cell(value: Option<f64>, digits: usize) -> String {
    value.map_or("–".into(), |value| significant(value, digits))
}

fn table(view: &View<'_>) -> Markup {
    let table = view.report.table;
    html! {
        @if !table.rows.is_empty() {
            div.wide { table {
                thead { tr {
                    th scope="col" { "Controller" @if view.report.simulated { " (simulated)" } }
                    @for header in &table.headers { th scope="col" { (header) } }
                } }
                tbody { @for (name, values) in &table.rows { tr {
                    th scope="row" { (name) }
                    @for value in values { td { (cell(*value, 3)) } }
                } } }
            } }
        }
        @for note in &table.notes { p.lead { (note) } }
        @if !table.ratios.is_empty() {
            div.wide { table {
                thead { tr {
                    th scope="col" { "Ratio" }
                    @for header in &table.ratio_headers { th scope="col" { (header) } }
                } }
                tbody { @for (name, values) in &table.ratios { tr {
                    th scope="row" { (name) }
                    @for value in values { td { (cell(*value, 2)) } }
                } } }
            } }
        }
    }
}

/// What was run, and what happened when.
fn facts(view: &View<'_>) -> Markup {
    let report = view.report;
    let time = report.runs.first().map_or(&[][..], |run| &run.trace.time);
    let plane = report.plane;
    html! {
        div.wide { table.facts {
            tr {
                th scope="row" { "Runs shown" }
                td {
                    (count(time.len())) " samples each"
                    @if let [first, .., last] = time {
                        ", " (view.time.value(*first)) " to " (view.time.value(*last))
                    }
                }
            }
            tr {
                th scope="row" { "Plane" }
                td {
                    (significant(plane.min(), 3)) " to " (view.input.value(plane.max())) ", "
                    (count(plane.levels())) " levels"
                }
            }
            @if !report.events.is_empty() { tr {
                th scope="row" { "Events" }
                td { @for (time, words) in report.events {
                    div { "at " (view.time.value(*time)) ": " (words) }
                } }
            } }
        } }
    }
}

fn section(name: &str, figures: &[Figure], view: &View<'_>, drawn: &[(Figure, Drawing)]) -> Markup {
    let drawn_here = |figure: &&Figure| drawn.iter().any(|(drawn, _)| drawn == *figure);
    html! {
        @if figures.iter().any(|figure| drawn_here(&figure)) {
            section {
                h2 { (name) }
                @for figure in figures { (view.picture(*figure, drawn, html! {})) }
            }
        }
    }
}

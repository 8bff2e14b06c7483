//! The page of controllers over the same reference.

use super::figures::{before_after, close_up, errors, input, output, weights_time};
use super::view::View;
use crate::number::{count, significant};
use crate::subject::{Section, Simulated, Subject};
use maud::{Markup, html};

impl Subject for View<'_> {
    fn sections() -> Vec<Section<Self>> {
        let did = vec![input::input(), input::drive()];
        let model = vec![
            errors::prediction(),
            weights_time::figure(),
            before_after::figure(),
        ];
        vec![
            Section::column("Tracking", vec![output::figure(), errors::tracking()]),
            Section::column("Reversals", vec![close_up::figure()]),
            Section::column("What the controllers did", did),
            Section::column("The model", model),
        ]
    }

    fn simulated(&self) -> Option<Simulated> {
        self.tracking.simulated.then_some(Simulated {
            page: "Simulated: these runs come from a simulated plant, not from a device.",
            caption: "Simulated plant. ",
        })
    }

    fn lead(&self) -> Markup {
        html! {
            "Control of the " (self.output.name)
            @if self.has_drive() { " by " (self.drive.name) "," }
            " through the hysteresis of its " (self.input.name) ": " (runs(self)) "."
        }
    }

    fn above(&self) -> Markup {
        html! { (table(self)) (facts(self)) }
    }

    fn below(&self) -> Markup {
        html! {
            @if self.reversal.is_none() {
                p {
                    "The reference does not reverse before the first event: there is no lag to show."
                }
            }
            @if self.adapting().next().is_none() { p { "No controller adapted its weights." } }
        }
    }
}

fn runs(view: &View<'_>) -> String {
    match view.tracking.runs.len() {
        1 => "one controller".into(),
        several => format!("{several} controllers"),
    }
}

/// A number of a table; a dash where there is none.
fn cell(value: Option<f64>, digits: usize) -> String {
    value.map_or("–".into(), |value| significant(value, digits))
}

fn table(view: &View<'_>) -> Markup {
    let table = view.tracking.table;
    html! {
        @if !table.rows.is_empty() {
            div.wide { table {
                thead { tr {
                    th scope="col" { "Controller" @if view.tracking.simulated { " (simulated)" } }
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
    let tracking = view.tracking;
    let time = tracking.runs.first().map_or(&[][..], |run| &run.trace.time);
    let plane = tracking.plane;
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
            @if !tracking.events.is_empty() { tr {
                th scope="row" { "Events" }
                td { @for (time, words) in tracking.events {
                    div { "at " (view.time.value(*time)) ": " (words) }
                } }
            } }
        } }
    }
}

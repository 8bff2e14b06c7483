//! The page of an evaluation.

use crate::draw::sheet::Drawing;
use crate::evaluation::figure::Figure;
use crate::evaluation::figures::classes_counted;
use crate::evaluation::view::View;
use crate::frame;
use crate::made;
use crate::number::percent;
use crate::number::{count, significant};
use crate::stack::Figures;
use hysteron::{Confidence, Errors};
use maud::{Markup, html};

/// The sections of the page and their figures; figures in one group stand side by side where there
/// is room.
const SECTIONS: [(&str, &[&[Figure]]); 5] = [
    (
        "The model",
        &[
            &[Figure::WeightsPlane, Figure::WeightsMap],
            &[Figure::LoadShift, Figure::LoadLoops],
        ],
    ),
    (
        "Confidence: what the data said",
        &[
            &[Figure::Excitation, Figure::StandardErrors],
            &[Figure::CrossValidation],
        ],
    ),
    (
        "Forward: output from input",
        &[
            &[Figure::OutputTime],
            &[Figure::Loops],
            &[Figure::LoadMeasured],
            &[Figure::OutputDiscrepancy],
            &[Figure::OutputResiduals],
            &[Figure::OutputHistogram],
        ],
    ),
    (
        "Inverse: input from output",
        &[
            &[Figure::InputTime],
            &[Figure::InputDiscrepancy],
            &[Figure::DeadBand],
        ],
    ),
    ("Memory: the plane", &[&[Figure::PlaneEvolution]]),
];

/// The page around the figures in `drawn`.
pub(crate) fn html(view: &View<'_>, drawn: &[(Figure, Drawing)]) -> String {
    let lead = html! {
        "A hysteresis model of " (view.output.name) " over " (view.input.name)
        ", tested on a recording of both."
    };
    let simulated =
        "Simulated: this recording comes from a simulated plant, not from a measurement.";
    let body = html! {
        (facts(view))
        (errors(view))
        @for (name, groups) in SECTIONS { (section(name, groups, view, drawn)) }
        p.beside {
            "Figures stand beside those of the book chapter “Hysteresis behaviour and modeling of \
             SMA actuators”, which introduces the MKP model; its figure numbers are given with \
             each caption."
        }
    };
    frame::html(
        view.heading,
        lead,
        view.simulated().then_some(simulated),
        body,
        view.made,
        view.scripts(drawn),
    )
}

fn facts(view: &View<'_>) -> Markup {
    let source = view.source;
    let weights = source.weights().len();
    let (least, most) = source.steps();
    html! {
        div.wide { table.facts {
            tr {
                th scope="row" { "Recording" }
                td { (count(view.recording.input.len())) " samples, " (view.recorded()) }
            }
            @if let Some(source) = &view.recording.source {
                tr {
                    th scope="row" { "From" }
                    td { (made::file(&source.path.display().to_string(), Some(&source.sha256))) }
                }
            }
            @for (path, digest) in source.fitted_to() {
                tr { th scope="row" { "Fitted to" } td { (made::file(path, digest)) } }
            }
            tr {
                th scope="row" { "Plane" }
                td {
                    (significant(source.min(), 3)) " to " (view.input.value(source.max())) ", "
                    (count(source.levels())) " levels "
                    @if least < most { (significant(least, 3)) " to " }
                    (view.input.value(most)) " apart"
                }
            }
            tr {
                th scope="row" { "Weights not zero" }
                td { (count(source.weights_not_zero())) " of " (count(weights)) }
            }
            @if let Some(confidence) = view.confidence() { (certainty(confidence, view)) }
        } }
    }
}

/// What the data fitted said of the weights, a row each.
fn certainty(confidence: &Confidence, view: &View<'_>) -> Markup {
    html! {
        tr { th scope="row" { "Operators" } td { (classes_counted(&confidence.excitation)) } }
        tr {
            th scope="row" { "Rank" }
            td {
                (count(confidence.rank)) " of " (count(confidence.unknowns)) ", condition "
                (significant(confidence.condition, 3))
            }
        }
        tr {
            th scope="row" { "Noise" }
            td {
                (view.output.value(confidence.sensor)) " of the readings"
                @if let Some(misfit) = view.source.fit().and_then(hysteron::FitSummary::misfit) {
                    ", misfit of the model " (view.output.value(misfit))
                }
            }
        }
        @if let Some(band) = view.band() {
            tr {
                th scope="row" { "95\u{a0}% band" }
                td { (percent(band.coverage_percent)) " of this recording inside" }
            }
        }
    }
}

/// Forward and inverse errors, a row each.
fn errors(view: &View<'_>) -> Markup {
    let row = |name: &str, errors: &Errors, unit: &Option<String>| {
        html! {
            tr {
                th scope="row" { (name) }
                td { (significant(errors.rmse, 3)) }
                td { (significant(errors.max_abs, 3)) }
                td { @if let Some(unit) = unit { (unit) } }
                td { (errors.nrmse_percent.map_or("–".to_owned(), percent)) }
                td { (count(errors.samples)) }
            }
        }
    };
    let (input, output) = (&view.input, &view.output);
    let policies = view
        .inverse()
        .map(|inverse| [("hold", &inverse.hold), ("anticipate", &inverse.anticipate)]);
    html! {
        div.wide { table {
            thead { tr {
                th scope="col" { "Discrepancy" @if view.simulated() { " (simulated)" } }
                th scope="col" { "RMSE" } th scope="col" { "max" } th scope="col" { "unit" }
                th scope="col" { "RMSE of range" } th scope="col" { "samples" }
            } }
            tbody {
                (row(&format!("forward: {}", output.name), &view.evaluation.forward, &output.unit))
                @for (policy, run) in policies.into_iter().flatten() {
                    @let parts = [("moving", &run.moving), ("dead band", &run.dead_band)];
                    @for (part, errors) in parts {
                        @if let Some(errors) = errors {
                            @let name = format!("inverse, {policy}: {}, {part}", input.name);
                            (row(&name, errors, &input.unit))
                        }
                    }
                }
            }
        } }
    }
}

fn section(
    name: &str,
    groups: &[&[Figure]],
    view: &View<'_>,
    drawn: &[(Figure, Drawing)],
) -> Markup {
    let inverse = groups
        .iter()
        .copied()
        .flatten()
        .any(|figure| figure.needs_inverse());
    let no_dead_band = view
        .inverse()
        .is_some_and(|inverse| !inverse.moving.contains(&false));
    let none = || {
        groups
            .iter()
            .copied()
            .flatten()
            .all(|f| drawn.iter().all(|(d, _)| d != f))
    };
    if !inverse && none() {
        return html! {};
    }
    html! {
        section {
            h2 { (name) }
            @if inverse {
                @if let Err(reason) = &view.evaluation.inverse {
                    p { "No inverse test: " (reason) }
                }
            }
            @for group in groups {
                @if let &&[figure] = group {
                    (picture(figure, view, drawn))
                } @else {
                    div.pair { @for &figure in *group { (picture(figure, view, drawn)) } }
                }
            }
            @if inverse && no_dead_band {
                p {
                    "The output never rests while the input travels: there is no dead band to show."
                }
            }
        }
    }
}

fn picture(figure: Figure, view: &View<'_>, drawn: &[(Figure, Drawing)]) -> Markup {
    let beside = html! {
        @if let Some(number) = figure.chapter_number() {
            " " span.beside { "Beside Fig. " (number) " of the chapter." }
        }
    };
    view.picture(figure, drawn, beside)
}

//! The page of an evaluation.

use crate::evaluation::figures::excitation_map::counts;
use crate::evaluation::figures::{
    close_up, cross_validation, discrepancy, evolution, excitation_map, input_time, load_loops,
    load_measured, load_shift, loops, output_time, residuals, standard_errors, weights_map,
    weights_plane,
};
use crate::evaluation::view::View;
use crate::made;
use crate::number::{count, percent, significant};
use crate::subject::{Section, Simulated, Subject, verdict};
use hysteron::{Confidence, Errors};
use maud::{Markup, html};

impl Subject for View<'_> {
    fn sections() -> Vec<Section<Self>> {
        let first = vec![
            vec![loops::figure(), residuals::over_input()],
            vec![output_time::figure()],
            vec![input_time::figure()],
        ];
        let forward = vec![
            vec![discrepancy::output()],
            vec![residuals::histogram(), load_measured::figure()],
        ];
        let inverse = vec![discrepancy::input(), close_up::figure()];
        let confidence = vec![
            vec![excitation_map::figure(), standard_errors::figure()],
            vec![cross_validation::figure()],
        ];
        let model = vec![
            vec![weights_plane::figure(), weights_map::figure()],
            vec![load_shift::figure(), load_loops::figure()],
            vec![evolution::figure()],
        ];
        vec![
            Section {
                notes: |view| [html! {}, errors(view)],
                ..Section::new("Measured and modelled", first)
            },
            Section::new("Errors of the output", forward),
            Section {
                notes: about_inverse,
                ..Section::column("Errors of the inverse", inverse)
            },
            Section {
                notes: |view| [facts(view), html! {}],
                ..Section::new("Confidence: what the data said", confidence)
            },
            Section::new("The model: the plane", model),
        ]
    }

    fn begins(&self) -> (usize, &[usize]) {
        (self.recording.len(), &self.begins)
    }

    fn simulated(&self) -> Option<Simulated> {
        self.is_simulated().then_some(Simulated {
            page: Simulated::RECORDING,
            caption: "Simulated recording. ",
        })
    }

    fn lead(&self) -> Markup {
        html! {
            "A hysteresis model of " (self.output.name) " over " (self.input.name)
            ", tested on a recording of both."
        }
    }

    fn above(&self) -> Markup {
        verdict(self.verdict)
    }

    fn below(&self) -> Markup {
        html! {
            p.beside {
                "Figures stand beside those of the book chapter “Hysteresis behaviour and modeling \
                 of SMA actuators”, which introduces the MKP model; its figure numbers are given \
                 with each caption."
            }
        }
    }
}

/// Why figures of the inverse are missing.
fn about_inverse(view: &View<'_>) -> [Markup; 2] {
    let (mut above, mut below) = (html! {}, html! {});
    match &view.evaluation.inverse {
        Err(reason) => above = html! { p { "No inverse test: " (reason) } },
        Ok(inverse) if !inverse.moving.contains(&false) => {
            below = html! {
                p {
                    "The output never rests while the input travels: there is no dead band to show."
                }
            }
        }
        Ok(_) => {}
    }
    [above, below]
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
        tr { th scope="row" { "Operators" } td { (counts(&confidence.excitation)) } }
        tr {
            th scope="row" { "Determined" }
            td {
                (count(confidence.rank)) " combinations of " (count(confidence.unknowns))
                " unknowns, the best " (significant(confidence.condition, 3))
                " times as well as the worst"
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
                th scope="row" { (band.name()) }
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
                th scope="col" { "Discrepancy" @if view.is_simulated() { " (simulated)" } }
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

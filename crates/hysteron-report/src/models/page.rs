//! The page of models beside each other.

use super::residuals;
use super::view::View;
use crate::made;
use crate::number::{count, percent, significant};
use crate::subject::{Section, Simulated, Subject, verdict};
use maud::{Markup, html};

impl Subject for View<'_> {
    fn sections() -> Vec<Section<Self>> {
        let figures = vec![
            residuals::over_time(),
            residuals::over_input(),
            residuals::histogram(),
        ];
        vec![Section::column("", figures)]
    }

    fn simulated(&self) -> Option<Simulated> {
        self.is_simulated().then_some(Simulated {
            page: Simulated::RECORDING,
            caption: "",
        })
    }

    fn lead(&self) -> Markup {
        html! {
            "Models of " (self.output.name) " over " (self.input.name) ", on one recording of "
            (count(self.recording.input.len())) " samples. The best is " (self.best().name) "."
        }
    }

    fn above(&self) -> Markup {
        html! {
            (verdict(self.best().verdict))
            (table(self))
            @if let Some(source) = &self.recording.source {
                p {
                    "Recording: "
                    (made::file(&source.path.display().to_string(), Some(&source.sha256)))
                }
            }
        }
    }
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
            tbody { @for model in view.models {
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

//! The page of a fleet.

use super::view::View;
use super::{distances, distributions, loops};
use crate::number::{count, percent, significant};
use crate::subject::{Section, Simulated, Subject};
use maud::{Markup, html};

/// Actuators in the table, at most.
const LISTED: usize = 50;

impl Subject for View<'_> {
    fn sections() -> Vec<Section<Self>> {
        let figures = vec![
            distributions::figure(),
            distances::figure(),
            loops::figure(),
        ];
        vec![Section::column("", figures)]
    }

    fn simulated(&self) -> Option<Simulated> {
        self.is_simulated().then_some(Simulated {
            page: "Simulated: recordings of this fleet come from a simulated plant, not from a \
                   measurement.",
            caption: "",
        })
    }

    fn lead(&self) -> Markup {
        html! {
            (count(self.ordered.len())) " actuators: " (self.output.name) " over "
            (self.input.name) ". " (self.unlike())
        }
    }

    fn above(&self) -> Markup {
        html! {}
    }

    fn below(&self) -> Markup {
        table(self)
    }
}

/// Outliers named in the first line, at most.
const NAMED: usize = 5;

impl View<'_> {
    /// How many are unlike the others, and which.
    fn unlike(&self) -> String {
        let outliers = self.outliers();
        let names = self.ordered.iter().take(outliers.min(NAMED));
        let names: Vec<&str> = names.map(|(row, _)| row.id.as_str()).collect();
        let names = names.join(", ");
        match outliers {
            0 => "None is unlike the others.".into(),
            1 => format!("One is unlike the others: {names}."),
            2..=NAMED => format!("{outliers} are unlike the others: {names}."),
            _ => format!(
                "{} are unlike the others, first of all {names}.",
                count(outliers)
            ),
        }
    }
}

/// The outliers, or the ten strangest where there are fewer.
fn table(view: &View<'_>) -> Markup {
    let listed = view.outliers().clamp(View::DRAWN, LISTED);
    let unit = |unit: &Option<String>| match unit {
        Some(unit) => format!(" [{unit}]"),
        None => String::new(),
    };
    let [output, input] = [&view.output, &view.input].map(|q| unit(&q.unit));
    let slope = unit(&view.slope_unit());
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
                th scope="col" { "Slope" (slope) }
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
                    td { (optional(row.shape.slope)) }
                }
            } }
        } }
    }
}

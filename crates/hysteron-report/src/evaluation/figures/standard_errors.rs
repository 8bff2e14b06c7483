//! How uncertain the weights are: standard errors over the plane, relative to the largest weight.

use super::weights_map::{WIDTH, plot};
use crate::draw::axis::{Axis, Span};
use crate::draw::shape::Short;
use crate::draw::sheet::{Key, Sheet};
use crate::draw::style::Stroke;
use crate::evaluation::view::View;
use crate::figure::Figure;
use crate::number::count;
use crate::plane::Half;
use crate::quantity::Labelled;
use hysteron::{Confidence, Excitation};
use std::fmt::Write;

/// Cells that the data say nothing of.
const UNKNOWN: Stroke = Stroke::solid("#6b7480", 1.0);

/// The standard error of each weight; zero where the data say nothing of it, and the number there
/// is that of the prior alone.
fn known(confidence: &Confidence) -> impl Iterator<Item = f64> + '_ {
    let all = confidence.standard_error.iter().zip(&confidence.excitation);
    all.map(|(error, class)| match class {
        Excitation::Never => 0.0,
        _ => *error,
    })
}

pub(crate) fn figure<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "standard-errors",
        chapter: None,
        width: WIDTH,
        is_linked: false,
        words,
        draw,
    }
}

fn words(view: &View<'_>) -> Option<[String; 2]> {
    let confidence = view.confidence()?;
    let largest = known(confidence).fold(0.0, f64::max);
    Some([
        "Standard errors of the weights".into(),
        format!(
            "Standard errors of the weights, from {} replicates of a bootstrap over branches; the \
             largest is {}. Weights that are held at zero in every replicate have none.",
            count(confidence.replicates),
            view.output.value(largest)
        ),
    ])
}

fn draw(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    let confidence = view.confidence()?;
    let of = view.source.weights().iter();
    let largest = of.fold(0.0, |largest: f64, mu| largest.max(mu.abs()));
    let percent = |error: f64| {
        if largest > 0.0 {
            100.0 * error / largest
        } else {
            0.0
        }
    };
    let errors: Vec<f64> = known(confidence).map(percent).collect();
    // The error of a block of operators is not the sum of theirs: the largest stands for it.
    let half = Half::of_values(view.source.plane(), &errors);
    let high = half
        .cells()
        .fold(0.0, |high: f64, cell| high.max(cell.largest));
    let label = Labelled {
        name: "standard error, of the largest weight".into(),
        unit: Some("%".into()),
    };
    let high = if high > 0.0 { high } else { 1.0 };
    let scale = Axis::new(&label, Span { low: 0.0, high });

    let excitation = confidence.excitation.iter();
    let unknown: Vec<f64> = excitation
        .map(|class| f64::from(u8::from(*class == Excitation::Never)))
        .collect();
    let mut keys = Vec::new();
    if unknown.contains(&1.0) {
        keys.push(Key::Text(
            "cells with / : never excited, no error known".into(),
        ));
    }
    keys.extend(half.remark().map(Key::Text));
    if keys.is_empty() {
        keys.push(Key::Text(String::new()));
    }
    sheet.legend(&keys);
    let panel = plot(sheet, view, &half, |cell| cell.largest, &scale, high);
    let mut slashes = String::new();
    for cell in Half::of_values(view.source.plane(), &unknown).cells() {
        if cell.sum == 0.0 || cell.mean() < 1.0 {
            continue;
        }
        let [x, y, width] = half.place(&panel, &cell);
        let _ = write!(
            slashes,
            "M{} {}l{} -{}",
            Short(x + 0.25 * width),
            Short(y + 0.75 * width),
            Short(0.5 * width),
            Short(0.5 * width)
        );
    }
    sheet.canvas.path(&slashes, None, Some(&UNKNOWN));
    Some(panel.end())
}

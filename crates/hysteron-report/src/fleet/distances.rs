//! The distance of each actuator from the others, the strangest first.

use super::view::View;
use crate::draw::axis::{Axis, Span};
use crate::draw::sheet::Sheet;
use crate::draw::style::{FOLLOWER, GUIDE};
use crate::figure::Figure;
use crate::panels::{WIDTH, single};
use crate::quantity::Labelled;

const HEIGHT: f64 = 240.0;
/// Distances beyond so many limits are drawn at the edge: one broken actuator would flatten all.
const MOST: f64 = 8.0;

pub(super) fn figure<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "fleet-distances",
        chapter: None,
        width: WIDTH,
        is_linked: false,
        words,
        draw,
    }
}

fn words(view: &View<'_>) -> Option<[String; 2]> {
    let limit = view.ordered[0].1.limit;
    Some([
        "How far each actuator is from the others".into(),
        format!(
            "Robust distance of stroke, width, slope, position and error, the strangest first. Of \
             normally distributed actuators one in a thousand lies above the dashed limit of \
             {limit:.2}; here {} of {} do.",
            view.outliers(),
            view.ordered.len()
        ),
    ])
}

fn draw(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    let limit = view.ordered[0].1.limit;
    let distances: Vec<f64> = view
        .ordered
        .iter()
        .map(|(_, strange)| match strange.distance.is_nan() {
            true => MOST * limit,
            false => strange.distance.min(MOST * limit),
        })
        .collect();
    let plain = |name: &str| Labelled {
        name: name.into(),
        unit: None,
    };
    let places: Vec<f64> = (1..=distances.len()).map(|n| n as f64).collect();
    let x = Axis::new(
        &plain("actuators, the strangest first"),
        Span::covering(&places).padded(0.02),
    );
    let highest = Span::covering(&distances).with(limit).with(0.0);
    let y = Axis::new(&plain("distance"), highest.padded(0.05).from(0.0));
    let panel = single(sheet, x, y, HEIGHT);
    panel.level(&mut sheet.canvas, limit, &GUIDE);
    panel.curve(&mut sheet.canvas, &places, &distances, &FOLLOWER);
    Some(panel.end())
}

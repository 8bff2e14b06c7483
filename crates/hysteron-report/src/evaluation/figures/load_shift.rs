//! By how much a load shifts the axis of the input.

use crate::draw::axis::{Axis, Span};
use crate::draw::marker::Marker;
use crate::draw::sheet::{Key, Sheet};
use crate::draw::style::{MODELLED, Stroke};
use crate::evaluation::view::View;
use crate::figure::Figure;
use crate::number::significant;
use crate::panels::single;
use crate::quantity::Labelled;
use hysteron::{LoadCurves, LoadDependence};

const WIDTH: f64 = 520.0;
const PLOT_HEIGHT: f64 = 300.0;
const CURVE: Stroke = Stroke::solid(MODELLED.colour, 2.0);

pub(crate) fn figure<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "load-shift",
        chapter: None,
        width: WIDTH,
        is_linked: false,
        words,
        draw,
    }
}

fn words(view: &View<'_>) -> Option<[String; 2]> {
    let load = view.source.load()?;
    let (name, curves) = (&load.quantity.name, load.curves.as_ref()?);
    Some([
        format!("shift by {name}"),
        format!(
            "By how much the {name} shifts the loop along the {}.{}",
            view.input.name,
            slope(view, load, curves)
        ),
    ])
}

/// The slope of the shift, both ways: the field states that of the phase diagram, load per
/// temperature.
fn slope(view: &View<'_>, load: &LoadDependence, curves: &LoadCurves) -> String {
    let slope = curves.slope();
    if slope == 0.0 {
        return " On average it does not.".into();
    }
    let unit = |quantity: Labelled| quantity.unit.unwrap_or(quantity.name);
    let input = unit(view.input.difference(&view.input.name));
    let load = unit(Labelled::first([&load.quantity, &load.quantity], "load"));
    let each = match curves.loads.len() {
        2 => String::new(),
        _ => {
            let pairs = curves.loads.windows(2).zip(curves.shifts.windows(2));
            let slopes = pairs.map(|(load, shift)| (shift[1] - shift[0]) / (load[1] - load[0]));
            let (least, most) = slopes.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), slope| {
                (a.min(slope), b.max(slope))
            });
            let [least, most] = [least, most].map(|slope| significant(slope, 3));
            format!(" From piece to piece it is {least} to {most} {input}/{load}.")
        }
    };
    format!(
        " Its slope is {} {input}/{load} on average, or {} {load}/{input}.{each}",
        significant(slope, 3),
        significant(1.0 / slope, 3),
    )
}

fn draw(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    let load = view.source.load()?;
    let curves = load.curves.as_ref()?;
    if curves.loads.len() < 2 || curves.shifts.len() != curves.loads.len() {
        return None;
    }
    let quantity = Labelled::first([&load.quantity, &load.quantity], "load");
    let x = Axis::new(&quantity, Span::covering(&curves.loads).padded(0.05));
    let shift = view.input.difference("shift s");
    let y = Axis::new(&shift, Span::covering(&curves.shifts).padded(0.08));

    sheet.legend(&[
        Key::Line(CURVE, "shift of the model".into()),
        Key::Marker(Marker::Disc, "points of its curve".into(), ""),
    ]);
    let panel = single(sheet, x, y, PLOT_HEIGHT);
    panel.curve(&mut sheet.canvas, &curves.loads, &curves.shifts, &CURVE);
    let knots = curves.loads.iter().zip(&curves.shifts);
    let knots = knots.map(|(&load, &shift)| panel.point(load, shift));
    Marker::Disc.draw(&mut sheet.canvas, knots, 4.0);
    Some(panel.end())
}

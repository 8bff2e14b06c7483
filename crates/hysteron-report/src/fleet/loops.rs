//! The loops of the strangest actuators, each over that of the most usual one.

use super::view::View;
use crate::draw::axis::{Axis, Span};
use crate::draw::panel::{BELOW, Labels, Panel, left_of};
use crate::draw::shape::Rect;
use crate::draw::sheet::{Key, MARGIN, Sheet};
use crate::draw::style::{FOLLOWER, REFERENCE};
use crate::figure::Figure;
use crate::panels::{HEADING, Heading, WIDTH, head};
use hysteron::Model;

const HEIGHT: f64 = 150.0;
const COLUMNS: usize = 2;
const GAP: f64 = 18.0;

/// Number of loops drawn.
fn count(view: &View<'_>) -> usize {
    View::DRAWN.min(view.ordered.len() - 1)
}

pub(super) fn figure<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "fleet-loops",
        chapter: None,
        width: WIDTH,
        is_linked: true,
        words,
        draw,
    }
}

fn words(view: &View<'_>) -> Option<[String; 2]> {
    Some([
        "The strangest loops beside the most usual one".into(),
        format!(
            "Major loops of the {} actuators with the largest distances, each over that of the \
             most usual one, {} (pale).",
            count(view),
            view.usual().id
        ),
    ])
}

fn draw(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    let strangest = &view.ordered[..count(view)];
    let usual = major_loop(&view.usual().model)?;
    let loops: Vec<[Vec<f64>; 2]> = strangest
        .iter()
        .map(|(row, _)| major_loop(&row.model))
        .collect::<Option<_>>()?;
    if loops.is_empty() {
        return None;
    }
    sheet.legend(&[
        Key::Line(FOLLOWER, "the actuator".into()),
        Key::Line(
            REFERENCE,
            format!("the most usual one, {}", view.usual().id),
        ),
    ]);
    let both = |n: usize| loops.iter().chain([&usual]).flat_map(move |l| &l[n]);
    let x = Axis::new(&view.input, Span::covering(both(0)).padded(0.03));
    let y = Axis::new(&view.output, Span::covering(both(1)).padded(0.04));
    let left = left_of(&y, HEIGHT);
    let width = (WIDTH - 2.0 * MARGIN - GAP) / COLUMNS as f64 - left;
    let mut bottom = sheet.top;
    for (n, (path, (row, strange))) in loops.iter().zip(strangest).enumerate() {
        let (line, column) = ((n / COLUMNS) as f64, (n % COLUMNS) as f64);
        let area = Rect {
            x: MARGIN + left + column * (left + width + GAP),
            y: sheet.top + HEADING + line * (HEIGHT + BELOW + HEADING),
            width,
            height: HEIGHT,
        };
        let (name, by) = strange.most();
        let heading = Heading {
            name: row.id.clone(),
            remark: format!(
                "distance {:.1}; {name} by {by:+.1} deviations",
                strange.distance
            ),
        };
        head(sheet, &heading, area);
        let labels = Labels { x: true, y: true };
        let panel = Panel::draw(&mut sheet.canvas, area, x.clone(), y.clone(), labels);
        panel.loops(&mut sheet.canvas, &usual[0], &usual[1], &REFERENCE);
        panel.loops(&mut sheet.canvas, &path[0], &path[1], &FOLLOWER);
        bottom = panel.end();
    }
    Some(bottom)
}

/// Inputs and outputs once up and down the plane.
fn major_loop(model: &Model) -> Option<[Vec<f64>; 2]> {
    let plane = model.plane();
    let corners = 0..=plane.levels();
    let path: Vec<usize> = corners.clone().chain(corners.rev()).collect();
    let on_plane: Vec<f64> = path.iter().map(|n| plane.level(*n)).collect();
    let output = model.operators().simulate(&on_plane).ok()?;
    let input = match model.spacing() {
        [] => on_plane,
        spacing => path.iter().map(|n| spacing[*n]).collect(),
    };
    Some([input, output])
}

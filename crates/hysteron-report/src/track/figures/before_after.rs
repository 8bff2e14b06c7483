//! The plane before and after: the weights of the first and the last snapshot, and what came and
//! went.

use crate::draw::axis::{Axis, Span};
use crate::draw::colour_bar::{BAR, BESIDE, colour_bar, room};
use crate::draw::panel::{BELOW, Labels, Panel, left_of};
use crate::draw::shape::{Anchor, Rect};
use crate::draw::sheet::{Key, MARGIN, Sheet};
use crate::draw::style::LABEL;
use crate::figure::Figure;
use crate::panels::{HEADING, Heading, head};
use crate::plane::{Half, axes};
use crate::track::view::View;

/// Wider than a figure over time: three planes and two scales side by side.
const WIDTH: f64 = 920.0;
const GAP: f64 = 12.0;

pub(crate) fn figure<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "track-plane",
        chapter: None,
        width: WIDTH,
        is_linked: false,
        words,
        draw,
    }
}

fn words(_: &View<'_>) -> Option<[String; 2]> {
    Some([
        "The plane before and after".into(),
        "The weights of the first and the last snapshot on one scale, and their difference on its \
         own."
            .into(),
    ])
}

fn draw(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    let plane = view.tracking.plane;
    let runs: Vec<(&str, [Half; 3])> = view
        .adapting()
        .filter_map(|run| {
            let [first, .., last] = run.trace.snapshots.as_slice() else {
                return None;
            };
            let pairs = last.weights.iter().zip(&first.weights);
            let difference: Vec<f64> = pairs.map(|(after, before)| after - before).collect();
            let halves = [&first.weights, &last.weights, &difference];
            Some((
                run.name,
                halves.map(|values| Half::of_values(plane, values)),
            ))
        })
        .collect();
    let (_, [any, ..]) = runs.first()?;
    let span = |shown: &[usize]| {
        let halves = runs
            .iter()
            .flat_map(|(_, halves)| shown.iter().map(|n| &halves[*n]));
        Span::from_zero(halves.flat_map(|half| half.cells().map(|cell| cell.sum)))
    };
    let spans = [span(&[0, 1]), span(&[2])];
    let scales = [
        Axis::new(&view.output.renamed("weight μ"), spans[0]),
        Axis::new(&view.output.renamed("change of μ"), spans[1]),
    ];
    let largest = spans.map(Span::largest);

    let mut keys = Vec::new();
    let negative = spans.iter().any(|span| span.low < 0.0);
    keys.extend(negative.then(|| Key::Text("cells with − : below zero".into())));
    keys.extend(any.remark().map(Key::Text));
    if !keys.is_empty() {
        sheet.legend(&keys);
    }
    let [alpha, beta] = axes(plane, &view.input);
    let left = MARGIN + left_of(&beta, 200.0);
    let rooms = scales.each_ref().map(|scale| room(scale, 200.0));
    let side = (WIDTH - MARGIN - left - rooms[0] - rooms[1] - 2.0 * GAP) / 3.0;
    let mut top = sheet.top;
    for (row, (name, halves)) in runs.iter().enumerate() {
        top += HEADING;
        let mut x = left;
        sheet
            .canvas
            .text([left, top - 6.0], Anchor::Start, LABEL, name);
        top += HEADING;
        let titles = ["before", "after", "after − before"];
        for (n, (half, title)) in halves.iter().zip(titles).enumerate() {
            let scale = n / 2;
            let area = Rect {
                x,
                y: top,
                width: side,
                height: side,
            };
            let heading = Heading {
                name: title.into(),
                remark: String::new(),
            };
            head(sheet, &heading, area);
            let labels = Labels {
                x: row + 1 == runs.len(),
                y: n == 0,
            };
            let (alpha, beta) = (alpha.clone(), beta.clone());
            let panel = Panel::draw(&mut sheet.canvas, area, alpha, beta, labels);
            half.fill(&mut sheet.canvas, &panel, |cell| cell.sum, largest[scale]);
            half.signs(&mut sheet.canvas, &panel, 0.02 * largest[scale]);
            x = area.right() + GAP;
            if n > 0 {
                let bar = Rect {
                    x: area.right() + BESIDE,
                    width: BAR,
                    ..area
                };
                colour_bar(&mut sheet.canvas, bar, &scales[scale], largest[scale]);
                x += rooms[scale];
            }
        }
        top += side + 6.0;
    }
    Some(top - 6.0 + BELOW + 4.0)
}

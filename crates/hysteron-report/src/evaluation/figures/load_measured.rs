//! Loops of the recording at each of its loads, measured and modelled.

use crate::draw::axis::{Axis, Span};
use crate::draw::canvas::Rect;
use crate::draw::panel::{BELOW, Labels, Panel, left_of};
use crate::draw::sheet::{Key, MARGIN};
use crate::draw::style::{LINES, Stroke};
use crate::evaluation::figure::Figure;
use crate::evaluation::view::View;
use crate::quantity::Labelled;
use crate::stack::Figures;
use std::ops::Range;

const WIDTH: f64 = 620.0;
const PLOT_HEIGHT: f64 = 420.0;

/// Loads closer than this share of the model's range are one load.
const SAME: f64 = 0.01;
/// A load rests if it stays for so many samples.
const RESTS: usize = 10;
/// With more loads than this, the loops could not be told apart.
const MOST: usize = 6;

const MODELLED: Stroke = Stroke {
    colour: "#1d2b3a",
    width: 1.3,
    dash: "6 3",
};

/// The colours of measured loops, one for each load.
const COLOURS: [usize; MOST] = [2, 1, 4, 3, 6, 5];

/// A load of the recording, and where it rests there.
pub(crate) struct Resting {
    pub(crate) load: f64,
    stretches: Vec<Range<usize>>,
}

/// The loads at which the recording rests, ascending; none where they are too many.
pub(crate) fn resting(view: &View<'_>) -> Option<Vec<Resting>> {
    let (low, high) = view.source.load()?.range();
    let loads = view.recording.load.as_ref()?;
    let near = |a: f64, b: f64| (a - b).abs() <= SAME * (high - low);
    let mut found: Vec<Resting> = Vec::new();
    let mut start = 0;
    for n in 1..=loads.len() {
        if loads.get(n).is_some_and(|load| near(*load, loads[start])) {
            continue;
        }
        let (load, stretch) = (loads[start], start..n);
        start = n;
        if stretch.len() < RESTS {
            continue;
        }
        match found.iter_mut().find(|resting| near(resting.load, load)) {
            Some(resting) => resting.stretches.push(stretch),
            None => found.push(Resting {
                load,
                stretches: vec![stretch],
            }),
        }
    }
    found.sort_by(|a, b| a.load.total_cmp(&b.load));
    (1..=MOST).contains(&found.len()).then_some(found)
}

pub(super) fn svg(view: &View<'_>) -> Option<String> {
    let (found, load) = (resting(view)?, view.source.load()?);
    let quantity = Labelled::first([&load.quantity, &load.quantity], "load");
    let stroke = |n: usize| Stroke::solid(LINES[COLOURS[n % MOST]].colour, 3.2);
    let mut keys: Vec<Key> = (found.iter().enumerate())
        .map(|(n, at)| {
            Key::Line(
                stroke(n),
                format!("{} {}", view.recorded(), quantity.value(at.load)),
            )
        })
        .collect();
    keys.push(Key::Line(MODELLED, "modelled".into()));

    let mut sheet = view.sheet(Figure::LoadMeasured, WIDTH);
    sheet.legend(&keys);
    let (input, output, modelled) = (
        &view.recording.input,
        &view.recording.output,
        &view.evaluation.output_model,
    );
    let x = Axis::new(&view.input, Span::of(input).padded(0.03));
    let y = Axis::new(
        &view.output,
        Span::of(output.iter().chain(modelled)).padded(0.04),
    );
    let left = MARGIN + left_of(&y, PLOT_HEIGHT);
    let area = Rect {
        x: left,
        y: sheet.top,
        width: WIDTH - MARGIN - left,
        height: PLOT_HEIGHT,
    };
    let panel = Panel::draw(&mut sheet.canvas, area, x, y, Labels { x: true, y: true });
    // The modelled loops over all measured ones.
    for (n, at) in found.iter().enumerate() {
        for stretch in at.stretches.iter().cloned() {
            let (input, output) = (&input[stretch.clone()], &output[stretch]);
            panel.loops(&mut sheet.canvas, input, output, &stroke(n));
        }
    }
    for stretch in found.iter().flat_map(|at| at.stretches.iter().cloned()) {
        let (input, modelled) = (&input[stretch.clone()], &modelled[stretch]);
        panel.loops(&mut sheet.canvas, input, modelled, &MODELLED);
    }
    let height = area.bottom() + BELOW + 4.0;
    Some(view.finish(Figure::LoadMeasured, sheet, height))
}

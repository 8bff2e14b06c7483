//! Loops of the recording at each of its loads, measured and modelled.

use crate::draw::axis::{Axis, Span};
use crate::draw::sheet::{Key, Sheet};
use crate::draw::style::{LINES, Stroke};
use crate::evaluation::view::View;
use crate::figure::Figure;
use crate::panels::single;
use crate::quantity::Labelled;
use std::ops::Range;

const WIDTH: f64 = 620.0;
const PLOT_HEIGHT: f64 = 420.0;

/// A load that is known within this share of the model's range is that load: measured loads waver.
const SAME: f64 = 0.1;
/// At least this share of the samples is at a load that is known.
const KNOWN: f64 = 0.75;
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
const COLOURS: [usize; MOST] = [2, 1, 5, 4, 3, 0];

/// A load of the recording, and where it rests there.
struct Resting {
    load: f64,
    stretches: Vec<Range<usize>>,
}

/// The loads of the fit at which the recording rests, ascending. None where the load moves, or has
/// too many values.
fn resting(view: &View<'_>) -> Option<Vec<Resting>> {
    let dependence = view.source.load()?;
    let (low, high) = dependence.range();
    let loads = view.recording.load.as_ref()?;
    // Curves with many points say nothing of the loads that were fitted.
    let curves = dependence.curves.as_ref();
    let known = match curves.filter(|curves| curves.loads.len() <= MOST) {
        Some(curves) => curves.loads.clone(),
        None => apart(loads, SAME * (high - low)),
    };
    if !(1..=MOST).contains(&known.len()) {
        return None;
    }
    let away = |at: usize, load: f64| (known[at] - load).abs();
    let nearest = |load: &f64| {
        let by = |a: &usize, b: &usize| away(*a, *load).total_cmp(&away(*b, *load));
        (0..known.len()).min_by(by).unwrap_or(0)
    };
    let at: Vec<usize> = loads.iter().map(nearest).collect();
    let near = at.iter().zip(loads);
    let near = near.filter(|(at, load)| away(**at, **load) <= SAME * (high - low));
    if (near.count() as f64) < KNOWN * loads.len() as f64 {
        return None;
    }
    let mut found: Vec<Resting> = (known.iter())
        .map(|&load| Resting {
            load,
            stretches: Vec::new(),
        })
        .collect();
    let mut start = 0;
    for n in 1..=at.len() {
        if at.get(n) == Some(&at[start]) {
            continue;
        }
        if n - start >= RESTS {
            found[at[start]].stretches.push(start..n);
        }
        start = n;
    }
    found.retain(|resting| !resting.stretches.is_empty());
    (!found.is_empty()).then_some(found)
}

/// The middles of groups of loads that lie further apart than `gap`.
fn apart(loads: &[f64], gap: f64) -> Vec<f64> {
    let mut sorted = loads.to_vec();
    sorted.sort_by(f64::total_cmp);
    let groups = sorted.chunk_by(|a, b| b - a <= gap);
    groups.map(|group| group[group.len() / 2]).collect()
}

pub(crate) fn figure<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "load-measured",
        chapter: None,
        width: WIDTH,
        is_linked: true,
        words,
        draw,
    }
}

fn words(view: &View<'_>) -> Option<[String; 2]> {
    let (load, found) = (&view.source.load()?.quantity.name, resting(view)?);
    let (input, output) = (&view.input.name, &view.output.name);
    let loads = match found.len() {
        1 => "one".to_owned(),
        count => format!("{count} values"),
    };
    Some([
        format!("{output} over {input}, by {load}"),
        format!(
            "The recording where the {load} rests, at {loads} of it: {} loops, and over them what \
             the model says of the same samples.",
            view.recorded(),
        ),
    ])
}

fn draw(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
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

    sheet.legend(&keys);
    let (input, output, modelled) = (
        &view.recording.input,
        &view.recording.output,
        &view.evaluation.output_model,
    );
    let x = Axis::new(&view.input, Span::covering(input).padded(0.03));
    let y = Axis::new(
        &view.output,
        Span::covering(output.iter().chain(modelled)).padded(0.04),
    );
    let panel = single(sheet, x, y, PLOT_HEIGHT);
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
    Some(panel.end())
}

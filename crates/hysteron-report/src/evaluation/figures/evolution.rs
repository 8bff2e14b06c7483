//! Fig. 6: operator states on the plane at a few instants.

use crate::draw::canvas::Canvas;
use crate::draw::marker::Marker;
use crate::draw::panel::{BELOW, Labels, Panel, left_of};
use crate::draw::shape::{Anchor, Rect};
use crate::draw::sheet::{Key, MARGIN, Sheet};
use crate::draw::style::{GUIDE, LABEL, TICK};
use crate::draw::text;
use crate::evaluation::instants::candidates;
use crate::evaluation::view::View;
use crate::figure::Figure;
use crate::panels::WIDTH;
use crate::plane::{Half, axes};

const COLUMNS: usize = 3;
const MOST: usize = 6;
/// How many instants are examined before some are chosen.
const LOOKED_AT: usize = 24;
const GAP: f64 = 20.0;
const HEADING: f64 = 24.0;

/// A moment of the recording and the plane then.
struct Instant {
    sample: usize,
    half: Half,
}

pub(crate) fn figure<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "fig06-plane-evolution",
        chapter: Some("6"),
        width: WIDTH,
        is_linked: false,
        words,
        draw,
    }
}

fn words(view: &View<'_>) -> Option<[String; 2]> {
    let input = &view.input.name;
    Some([
        "Evolution of the plane".into(),
        format!(
            "Operator states on the plane at telling moments of the {input}. The dashed line is \
             the present {input}: rising, it switches operators on below it; falling, it switches \
             them off to its right."
        ),
    ])
}

fn draw(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    sheet.legend(&[
        Key::Marker(Marker::Ring, "γ = 0: S".into(), "min"),
        Key::Marker(Marker::Square, "0 < γ < 1: boundary".into(), ""),
        Key::Marker(Marker::Disc, "γ = 1: S".into(), "max"),
        Key::Line(GUIDE, "present input".into()),
    ]);
    let [alpha, beta] = axes(view.source.plane(), &view.input);
    let left = MARGIN + left_of(&beta, 200.0);
    let side = (WIDTH - MARGIN - left - GAP * (COLUMNS as f64 - 1.0)) / COLUMNS as f64;
    let instants = instants(view);
    let mut bottom = sheet.top;
    for (k, instant) in instants.iter().enumerate() {
        let (column, row) = (k % COLUMNS, k / COLUMNS);
        let area = Rect {
            x: left + column as f64 * (side + GAP),
            y: sheet.top + HEADING + row as f64 * (side + HEADING + 14.0),
            width: side,
            height: side,
        };
        bottom = area.bottom();
        let below_is_free = k + COLUMNS >= instants.len();
        let labels = Labels {
            x: below_is_free,
            y: column == 0,
        };
        let panel = Panel::draw(&mut sheet.canvas, area, alpha.clone(), beta.clone(), labels);
        heading(&mut sheet.canvas, view, instant.sample, k, area);
        states(&mut sheet.canvas, &panel, instant);
        present(&mut sheet.canvas, view, &panel, instant.sample);
    }
    Some(bottom + BELOW + 4.0)
}

/// The first instants at which the operators disagree; a plane that is all on or all off has no
/// boundary to show.
fn instants(view: &View<'_>) -> Vec<Instant> {
    let input = &view.recording.input;
    let threshold = 0.05 * (view.source.max() - view.source.min());
    let looked_at = candidates(input, threshold).into_iter().take(LOOKED_AT);
    let all: Vec<Instant> = looked_at
        .map(|sample| Instant {
            sample,
            half: Half::of_values(view.source.plane(), &view.source.states(&input[..=sample])),
        })
        .collect();
    let (telling, uniform): (Vec<_>, Vec<_>) = all
        .into_iter()
        .partition(|instant| !instant.half.is_uniform());
    let mut chosen: Vec<Instant> = telling.into_iter().chain(uniform).take(MOST).collect();
    chosen.sort_by_key(|instant| instant.sample);
    chosen
}

fn heading(canvas: &mut Canvas, view: &View<'_>, sample: usize, k: usize, area: Rect) {
    let letter = char::from(b'a' + k as u8);
    let value = view.input.value(view.recording.input[sample]);
    let when = view.time_label.value(view.time[sample]);
    let when = if view.recording.time.is_some() {
        format!("at {when}")
    } else {
        format!("at sample {when}")
    };
    let heading = format!("({letter}) {value} {when}");
    canvas.text(
        [area.x, area.y - 8.0],
        Anchor::Start,
        TICK,
        &text::fit(&heading, LABEL, area.width),
    );
}

fn states(canvas: &mut Canvas, panel: &Panel, instant: &Instant) {
    let radius = 0.36 * panel.area.width / (instant.half.side as f64 + 1.0);
    let radius = radius.clamp(0.8, 5.0);
    for (marker, range) in [
        (Marker::Ring, 0..1),
        (Marker::Square, 1..2),
        (Marker::Disc, 2..3),
    ] {
        let class = |mean: f64| {
            if mean <= 1e-9 {
                0
            } else if mean < 1.0 - 1e-9 {
                1
            } else {
                2
            }
        };
        let of_class = instant
            .half
            .cells()
            .filter(|cell| range.contains(&class(cell.mean())));
        marker.draw(
            canvas,
            of_class.map(|cell| panel.point(cell.alpha, cell.beta)),
            radius,
        );
    }
}

/// Rising input sweeps the plane upwards as a line of constant β, falling input leftwards as one of
/// constant α.
fn present(canvas: &mut Canvas, view: &View<'_>, panel: &Panel, sample: usize) {
    let input = &view.recording.input;
    let now = input[sample];
    let [x, y] = panel.point(now, now);
    let inside = |at: f64, from: f64, to: f64| at >= from && at <= to;
    let rising = input[..sample]
        .iter()
        .rev()
        .find(|&&before| before != now)
        .is_none_or(|&before| before < now);
    if rising && inside(y, panel.area.y, panel.area.bottom()) {
        canvas.line([panel.area.x, y], [x, y], &GUIDE);
    } else if !rising && inside(x, panel.area.x, panel.area.right()) {
        canvas.line([x, panel.area.y], [x, y], &GUIDE);
    }
}

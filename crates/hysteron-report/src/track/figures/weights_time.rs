//! How the weights change over time: the rows of the plane as a map, their sum and the offset as
//! curves.

use super::cut::events;
use crate::draw::axis::{Axis, Span};
use crate::draw::colour::of_share;
use crate::draw::colour_bar::{BAR, BESIDE, colour_bar, room};
use crate::draw::panel::{BELOW, Labels, Panel, left_of, threshold};
use crate::draw::shape::{Rect, Short, rect_data};
use crate::draw::sheet::{Key, MARGIN, Sheet};
use crate::draw::style::{FOLLOWER, MODELLED, ZERO};
use crate::figure::Figure;
use crate::panels::{HEADING, Heading, WIDTH, event_lines, head};
use crate::plane::MINUS;
use crate::track::tracking::NamedTrace;
use crate::track::view::View;
use hysteron::Plane;
use hysteron::control::Trace;
use hysteron::operators;
use std::collections::BTreeMap;
use std::fmt::Write;

const MAP: f64 = 130.0;
const CURVES: f64 = 90.0;
const GAP: f64 = 14.0;
/// Cells of the map, at most: across, and up.
const COLUMNS: usize = 160;
const ROWS: usize = 48;
/// Shades on each side of zero.
const SHADES: f64 = 24.0;
/// Minus signs stand this many pixels apart where the change is below zero, in rows at least this
/// far apart.
const SPACING: f64 = 16.0;
const LEADING: f64 = 6.0;

/// What a run's weights have changed by since its first snapshot.
struct Change {
    time: Vec<f64>,
    /// For each snapshot, the total of each row of the plane, or of some neighbouring rows.
    rows: Vec<Vec<f64>>,
    sum: Vec<f64>,
    offset: Vec<f64>,
}

impl Change {
    fn new(trace: &Trace, plane: &Plane) -> Self {
        let block = plane.levels().div_ceil(ROWS);
        let totals = |weights: &[f64]| {
            let mut rows = vec![0.0; plane.levels().div_ceil(block)];
            let row_of = operators(plane.levels()).map(|(_, j)| (j - 1) / block);
            row_of
                .zip(weights)
                .for_each(|(row, weight)| rows[row] += weight);
            rows
        };
        let first = trace.snapshots.first();
        let start = first.map_or_else(Vec::new, |first| totals(&first.weights));
        let since = |weights: &[f64]| -> Vec<f64> {
            totals(weights)
                .iter()
                .zip(&start)
                .map(|(now, then)| now - then)
                .collect()
        };
        let rows: Vec<Vec<f64>> = trace.snapshots.iter().map(|s| since(&s.weights)).collect();
        let offset = first.map_or(0.0, |first| first.offset);
        Self {
            time: trace.snapshots.iter().map(|s| s.time).collect(),
            sum: rows.iter().map(|rows| rows.iter().sum()).collect(),
            offset: trace.snapshots.iter().map(|s| s.offset - offset).collect(),
            rows,
        }
    }
}

pub(crate) fn figure<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "track-weights",
        chapter: None,
        width: WIDTH,
        is_linked: false,
        words,
        draw,
    }
}

fn words(view: &View<'_>) -> Option<[String; 2]> {
    let first = view.adapting().next()?.trace.snapshots.first()?;
    Some([
        "Adapted weights over time".into(),
        format!(
            "Change since the first snapshot of the total weight of the rows of the plane, which \
             are the operators that a rising {} switches on at β; below, of the sum of all \
             weights and of the offset. At the start the weights sum to {} and the offset is {}.{}",
            view.input.name,
            view.output.value(first.weights.iter().sum()),
            view.output.value(first.offset),
            events(view)
        ),
    ])
}

fn draw(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    let plane = view.tracking.plane;
    let runs: Vec<(&NamedTrace<'_>, Change)> = view
        .adapting()
        .map(|run| (run, Change::new(run.trace, plane)))
        .collect();
    if runs.is_empty() {
        return None;
    }
    let cells = runs
        .iter()
        .flat_map(|(_, change)| change.rows.iter().flatten());
    let span = Span::from_zero(cells.copied());
    let curves = runs
        .iter()
        .flat_map(|(_, change)| change.sum.iter().chain(&change.offset));
    let y = Axis::new(
        &view.output.renamed("change"),
        Span::covering(curves).with(0.0).padded(0.06),
    );
    let scale = Axis::new(&view.output.renamed("change of a row"), span);
    let room = room(&scale, MAP);
    let half = 0.5 * plane.step();
    let beta = Axis::new(
        &threshold("β", &view.input),
        Span {
            low: plane.min() - half,
            high: plane.max() + half,
        },
    );

    let mut keys = vec![
        Key::Line(FOLLOWER, "sum of the weights".into()),
        Key::Line(MODELLED, "offset".into()),
    ];
    keys.extend((span.low < 0.0).then(|| Key::Text("map with − : weights that shrank".into())));
    sheet.legend(&keys);
    let left = MARGIN + left_of(&beta, MAP).max(left_of(&y, CURVES));
    let mut area = Rect {
        x: left,
        y: sheet.top,
        width: WIDTH - MARGIN - left - room,
        height: MAP,
    };
    let mut bottom = area.y;
    for (n, (run, change)) in runs.iter().enumerate() {
        area.y += HEADING;
        let heading = Heading {
            name: run.name.to_owned(),
            remark: format!("{} snapshots", crate::number::count(change.time.len())),
        };
        head(sheet, &heading, area);
        let labels = Labels { x: false, y: true };
        let panel = Panel::draw(
            &mut sheet.canvas,
            area,
            view.time_axis.clone(),
            beta.clone(),
            labels,
        );
        map(sheet, &panel, run.trace, change, span);
        event_lines(sheet, view.tracking.events, &panel);
        let bar = Rect {
            x: area.right() + BESIDE,
            width: BAR,
            ..area
        };
        colour_bar(&mut sheet.canvas, bar, &scale, span.largest());

        let below = Rect {
            y: area.bottom() + GAP,
            height: CURVES,
            ..area
        };
        let labels = Labels {
            x: n + 1 == runs.len(),
            y: true,
        };
        let panel = Panel::draw(
            &mut sheet.canvas,
            below,
            view.time_axis.clone(),
            y.clone(),
            labels,
        );
        panel.level(&mut sheet.canvas, 0.0, &ZERO);
        panel.curve(&mut sheet.canvas, &change.time, &change.sum, &FOLLOWER);
        panel.curve(&mut sheet.canvas, &change.time, &change.offset, &MODELLED);
        event_lines(sheet, view.tracking.events, &panel);
        bottom = below.bottom();
        area.y = bottom + 8.0;
    }
    Some(bottom + BELOW + 4.0)
}

/// The rows over time: each snapshot stands until the next, the last until the run ends.
fn map(sheet: &mut Sheet, panel: &Panel, trace: &Trace, change: &Change, span: Span) {
    let end = trace.time.iter().rev().find(|time| time.is_finite());
    let [Some(&start), Some(&end)] = [change.time.first(), end] else {
        return;
    };
    let (from, to) = (
        panel.px(start).max(panel.area.x),
        panel.px(end).min(panel.area.right()),
    );
    if !from.is_finite() || !to.is_finite() || to <= from {
        return;
    }
    let width = (to - from) / COLUMNS as f64;
    // The last snapshot before each column's middle.
    let at = |column: usize| {
        let time = start + (end - start) * (column as f64 + 0.5) / COLUMNS as f64;
        change
            .time
            .partition_point(|t| *t <= time)
            .saturating_sub(1)
    };
    let Some(rows) = change.rows.first().map(Vec::len) else {
        return;
    };
    let height = panel.area.height / rows as f64;
    let value = |row: usize, column| change.rows.get(at(column)).map_or(0.0, |rows| rows[row]);
    // Cells of one shade in one path, neighbours in one rectangle: the map stays small.
    let mut shades: BTreeMap<i32, String> = BTreeMap::new();
    for row in 0..rows {
        let shade = |column| (SHADES * value(row, column) / span.largest()).round() as i32;
        let columns: Vec<(usize, i32)> = (0..COLUMNS).map(|n| (n, shade(n))).collect();
        for run in columns.chunk_by(|a, b| a.1 == b.1) {
            let cell = Rect {
                x: from + run[0].0 as f64 * width,
                y: panel.area.bottom() - (row + 1) as f64 * height,
                width: run.len() as f64 * width + 0.3,
                height: height + 0.3,
            };
            shades
                .entry(run[0].1)
                .or_default()
                .push_str(&rect_data(cell));
        }
    }
    let canvas = &mut sheet.canvas;
    canvas.clipped(panel.area, |canvas| {
        for (shade, cells) in &shades {
            canvas.path(cells, Some(&of_share(f64::from(*shade) / SHADES)), None);
        }
    });
    let mut minus = String::new();
    let across = (0..).map(|n| (n as f64 + 0.5) * SPACING);
    let lines = (0..rows).step_by((LEADING / height).ceil() as usize);
    for x in across.take_while(|x| *x < to - from) {
        let column = ((x / width) as usize).min(COLUMNS - 1);
        for row in lines.clone() {
            // A change that rounds to no shade gets no minus sign.
            if SHADES * value(row, column) / span.largest() < -0.5 {
                let y = panel.area.bottom() - (row as f64 + 0.5) * height;
                let _ = write!(minus, "M{} {}h4", Short(from + x - 2.0), Short(y));
            }
        }
    }
    canvas.path(&minus, None, Some(&MINUS));
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use hysteron::control::Snapshot;

    fn trace(snapshots: Vec<Snapshot>) -> Trace {
        Trace {
            snapshots,
            ..Trace::default()
        }
    }

    fn snapshot(time: f64, offset: f64, weights: &[f64]) -> Snapshot {
        Snapshot {
            time,
            offset,
            weights: weights.to_vec(),
        }
    }

    #[test]
    fn change_is_counted_from_the_first_snapshot_row_by_row() {
        let plane = Plane::new(0.0, 2.0, 3).unwrap();
        let before = snapshot(0.0, 5.0, &[1.0, 1.0, 1.0, 1.0, 1.0, 1.0]);
        let after = snapshot(4.0, 4.5, &[1.5, 1.0, 0.0, 2.0, 2.0, 4.0]);
        let change = Change::new(&trace(vec![before, after]), &plane);
        assert_eq!(change.rows, [[0.0; 3], [0.5, -1.0, 5.0]]);
        assert_eq!(
            (change.sum, change.offset),
            (vec![0.0, 4.5], vec![0.0, -0.5])
        );
    }

    #[test]
    fn rows_of_a_fine_plane_are_taken_together() {
        let plane = Plane::new(0.0, 1.0, 100).unwrap();
        let [before, after] = [0.0, 1.0].map(|w| snapshot(w, 0.0, &vec![w; plane.operators()]));
        let change = Change::new(&trace(vec![before, after]), &plane);
        // Blocks of three rows: 1 + 2 + 3 operators in the first, the 100 of row 100 alone in the
        // last.
        assert_eq!(change.rows[1].len(), 34);
        assert_eq!((change.rows[1][0], change.rows[1][33]), (6.0, 100.0));
    }
}

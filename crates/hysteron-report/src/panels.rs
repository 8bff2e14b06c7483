//! Where panels stand: one alone, or one above the other over the same axes, for each controller or
//! each model.

use crate::draw::axis::Axis;
use crate::draw::panel::{BELOW, Labels, Panel, left_of, y_label};
use crate::draw::plot::Words;
use crate::draw::shape::{Anchor, Rect};
use crate::draw::sheet::{MARGIN, Sheet};
use crate::draw::style::{FAINT, GUIDE, INK, LABEL, TICK};
use crate::draw::text;

/// Width of a figure over time.
pub(crate) const WIDTH: f64 = 760.0;
/// Space above a panel for its heading.
pub(crate) const HEADING: f64 = 25.0;
/// Height of a row of words above the panels.
const WORDS: f64 = 16.0;
/// Rows of words above the panels, at most.
const ROWS: usize = 3;

/// What stands above a panel.
pub(crate) struct Heading {
    pub(crate) name: String,
    /// At the right, in less weight.
    pub(crate) remark: String,
}

/// Height of each of `count` panels: the more, the lower.
pub(crate) fn height(count: usize) -> f64 {
    match count {
        1 => 260.0,
        2..=4 => 130.0,
        5..=8 => 104.0,
        _ => 88.0,
    }
}

/// A panel `height` pixels high over the width of the sheet.
pub(crate) fn single(sheet: &mut Sheet, x: Axis, y: Axis, height: f64) -> Panel {
    let left = MARGIN + left_of(&y, height);
    let area = Rect {
        x: left,
        y: sheet.top,
        width: sheet.width - MARGIN - left,
        height,
    };
    Panel::draw(&mut sheet.canvas, area, x, y, Labels { x: true, y: true })
}

/// Draws a panel for each of `headings`, with `below` pixels left free under each and `beside` to
/// its left at least, the words of `events` above all, and one label for the `y` axis that they
/// share. Returns the panels and the height of the figure.
pub(crate) fn stack(
    sheet: &mut Sheet,
    events: &[(f64, String)],
    headings: &[Heading],
    [x, y]: [&Axis; 2],
    height: f64,
    [below, beside]: [f64; 2],
) -> (Vec<Panel>, f64) {
    let left = MARGIN + left_of(y, height).max(beside);
    let mut area = Rect {
        x: left,
        y: sheet.top,
        width: sheet.width - MARGIN - left,
        height,
    };
    area.y = words_of(sheet, events, x, area);
    let first = area.y + HEADING;
    let mut panels = Vec::new();
    for (n, heading) in headings.iter().enumerate() {
        area.y += HEADING;
        head(sheet, heading, area);
        let last = n + 1 == headings.len();
        let labels = Labels {
            x: last && below == 0.0,
            y: true,
        };
        let (x, y) = (x.clone(), y.clone().unlabelled());
        let panel = Panel::draw(&mut sheet.canvas, area, x, y, labels);
        area.y = area.bottom() + below;
        panels.push(panel);
    }
    let all = Rect {
        y: first,
        height: area.y - first,
        ..area
    };
    y_label(&mut sheet.canvas, y, MARGIN, all);
    (panels, area.y + BELOW + 4.0)
}

/// Name and remark above `area`.
pub(crate) fn head(sheet: &mut Sheet, heading: &Heading, area: Rect) {
    let baseline = area.y - 6.0;
    let taken = text::width(&heading.remark, TICK) + 12.0;
    let name = text::fit(&heading.name, LABEL, area.width - taken);
    sheet.canvas.words(Words {
        at: [area.x, baseline],
        anchor: Anchor::Start,
        size: LABEL,
        colour: INK,
        text: name,
    });
    sheet.canvas.words(Words {
        at: [area.right(), baseline],
        anchor: Anchor::End,
        size: TICK,
        colour: FAINT,
        text: heading.remark.clone(),
    });
}

/// Where an event stands in pixels, if it does within `area`.
fn place(x: &Axis, area: Rect, time: f64) -> Option<f64> {
    let share = (time - x.span.low) / (x.span.high - x.span.low);
    (0.0..=1.0)
        .contains(&share)
        .then_some(area.x + share * area.width)
}

/// The words of the events, in rows where they would overlap. Words that find no place in them are
/// left to the page. Returns where the panels can begin.
fn words_of(sheet: &mut Sheet, events: &[(f64, String)], x: &Axis, area: Rect) -> f64 {
    let mut taken: [Vec<[f64; 2]>; ROWS] = Default::default();
    let mut used = 0;
    for (time, words) in events {
        let Some(at) = place(x, area, *time) else {
            continue;
        };
        let words = text::fit(words, TICK, 0.5 * area.width);
        let width = text::width(&words, TICK);
        // To the left of its line where there is no room to the right.
        let (anchor, from) = if at + 4.0 + width > area.right() {
            (Anchor::End, at - width)
        } else {
            (Anchor::Start, at)
        };
        let span = [from - 6.0, from + width + 6.0];
        let free = |row: &Vec<[f64; 2]>| row.iter().all(|[a, b]| span[1] < *a || span[0] > *b);
        let Some(row) = taken.iter().position(free) else {
            continue;
        };
        taken[row].push(span);
        used = used.max(row + 1);
        let y = area.y + WORDS * (row as f64 + 0.75);
        sheet.canvas.text([at, y], anchor, TICK, &words);
    }
    area.y + WORDS * used as f64
}

/// Lines at the events, over the data.
pub(crate) fn event_lines(sheet: &mut Sheet, events: &[(f64, String)], panel: &Panel) {
    for (time, words) in events {
        panel.upright(&mut sheet.canvas, *time, &GUIDE, words);
    }
}

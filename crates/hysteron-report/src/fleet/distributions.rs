//! How errors and main numbers of the loops are distributed, a panel for each.

use super::view::View;
use crate::draw::axis::{Axis, Span};
use crate::draw::panel::{BELOW, Labels, Panel, left_of};
use crate::draw::shape::Rect;
use crate::draw::sheet::{MARGIN, Sheet};
use crate::draw::style::{BEYOND, FOLLOWER, GUIDE, REFERENCE};
use crate::figure::Figure;
use crate::panels::WIDTH;
use crate::quantity::Labelled;
use hysteron::FleetRow;

/// Classes of each histogram.
const CLASSES: usize = 30;
const HEIGHT: f64 = 130.0;
const GAP: f64 = 18.0;
/// The classes reach so many robust deviations from the median at most.
const REACH: f64 = 8.0;

/// A number of each actuator: its name, and its value.
type Number = (Labelled, fn(&FleetRow) -> Option<f64>);

pub(super) fn figure<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "fleet-distributions",
        chapter: None,
        width: WIDTH,
        is_linked: false,
        words,
        draw,
    }
}

fn words(_: &View<'_>) -> Option<[String; 2]> {
    Some([
        "Errors and loops of the fleet".into(),
        format!(
            "Number of actuators in each of {CLASSES} classes of equal width. Dashed: the median. \
             Marks at the foot: actuators unlike the others. Classes at both ends hold what lies \
             beyond them."
        ),
    ])
}

fn draw(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
    let percent = Labelled {
        name: "RMSE".into(),
        unit: Some("% of range".into()),
    };
    let slope = Labelled {
        name: "slope".into(),
        unit: view.slope_unit(),
    };
    let numbers: [Number; 5] = [
        (percent, |row| Some(row.model.fit.as_ref()?.nrmse_percent)),
        (view.output.renamed("stroke"), |row| Some(row.shape.stroke)),
        (view.input.renamed("width"), |row| row.shape.width),
        (slope, |row| row.shape.slope),
        (view.input.renamed("position"), |row| row.shape.position),
    ];
    let count = Labelled {
        name: "actuators".into(),
        unit: None,
    };
    let all: Vec<Classes> = numbers
        .iter()
        .map(|(_, number)| Classes::new(view, *number))
        .collect();
    let highest = all.iter().flat_map(|classes| classes.counts);
    let y = Axis::new(&count, Span::from_zero(highest).padded(0.06).from(0.0));
    let left = left_of(&y, HEIGHT);
    let width = 0.5 * (WIDTH - 2.0 * MARGIN - GAP) - left;
    let mut bottom = sheet.top;
    for (n, ((label, _), classes)) in numbers.iter().zip(&all).enumerate() {
        let (row, column) = ((n / 2) as f64, (n % 2) as f64);
        let area = Rect {
            x: MARGIN + left + column * (left + width + GAP),
            y: sheet.top + 6.0 + row * (HEIGHT + BELOW + 8.0),
            width,
            height: HEIGHT,
        };
        let x = Axis::new(label, classes.span.padded(0.03));
        let labels = Labels { x: true, y: true };
        let panel = Panel::draw(&mut sheet.canvas, area, x, y.clone(), labels);
        let step = (classes.span.high - classes.span.low) / CLASSES as f64;
        let filled = classes.counts.iter().enumerate();
        for (class, count) in filled.filter(|(_, count)| **count > 0.0) {
            let from = classes.span.low + step * class as f64;
            let [left, top] = panel.point(from, *count);
            let bar = Rect {
                x: left,
                y: top,
                width: panel.px(from + step) - left,
                height: area.bottom() - top,
            };
            sheet.canvas.rect(bar, REFERENCE.colour);
            // The edge of the bar keeps its place on a grey print.
            let end = [left + bar.width, top];
            sheet.canvas.line([left, top], end, &FOLLOWER);
        }
        let median = panel.px(classes.median);
        let ends = [[median, area.y], [median, area.bottom()]];
        sheet.canvas.line(ends[0], ends[1], &GUIDE);
        for outlier in &classes.outliers {
            let at = panel.px(*outlier);
            let foot = area.bottom();
            sheet.canvas.line([at, foot - 7.0], [at, foot], &BEYOND);
        }
        bottom = panel.end();
    }
    Some(bottom)
}

/// A number of all actuators, in classes.
struct Classes {
    span: Span,
    counts: [f64; CLASSES],
    median: f64,
    /// The values of those that are unlike the others, within the span.
    outliers: Vec<f64>,
}

impl Classes {
    fn new(view: &View<'_>, number: fn(&FleetRow) -> Option<f64>) -> Self {
        let of = |row: &FleetRow| number(row).filter(|value| value.is_finite());
        let mut values: Vec<f64> = view.ordered.iter().filter_map(|(row, _)| of(row)).collect();
        let median = median(&mut values);
        let mut off: Vec<f64> = values.iter().map(|value| (value - median).abs()).collect();
        let reach = REACH * self::median(&mut off);
        let within = values
            .iter()
            .filter(|value| (*value - median).abs() <= reach);
        // Where most are equal, all are shown.
        let span = match reach > 0.0 {
            true => Span::covering(within),
            false => Span::covering(&values),
        };
        let mut counts = [0.0; CLASSES];
        for value in &values {
            let place = (value - span.low) / (span.high - span.low) * CLASSES as f64;
            counts[(place.max(0.0) as usize).min(CLASSES - 1)] += 1.0;
        }
        let strange = view
            .ordered
            .iter()
            .filter(|(_, strange)| strange.is_outlier());
        let strange = strange.filter_map(|(row, _)| of(row));
        Self {
            span,
            counts,
            median,
            outliers: strange.map(|v| v.clamp(span.low, span.high)).collect(),
        }
    }
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    match values {
        [] => 0.0,
        values => 0.5 * (values[(values.len() - 1) / 2] + values[values.len() / 2]),
    }
}

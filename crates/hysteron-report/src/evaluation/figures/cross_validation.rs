//! How levels and smoothness were chosen: the error on left-out branches, a line for each number of
//! levels.

use crate::draw::axis::{Axis, Span};
use crate::draw::canvas::Rect;
use crate::draw::marker::Marker;
use crate::draw::panel::{BELOW, Labels, Panel, left_of};
use crate::draw::sheet::{Drawing, Key, MARGIN};
use crate::draw::style::LINES;
use crate::evaluation::figure::Figure;
use crate::evaluation::view::View;
use crate::number::{magnitude, power_of_ten, significant};
use crate::panels::WIDTH;
use crate::quantity::Labelled;
use crate::stack::Figures;
use hysteron::{Criterion, Validation};

const PLOT_HEIGHT: f64 = 340.0;

/// Errors beyond this many times the best are cut off: they would press the others together.
pub(crate) const SHOWN: f64 = 6.0;

pub(super) fn svg(view: &View<'_>) -> Option<Drawing> {
    let (levels, smooth, errors) = shown(view.validation()?);
    let of_levels = |k: usize| format!("{k} levels");
    let lines: Vec<(String, Vec<Option<f64>>)> = match smooth.len() {
        // With one strength only, the levels take its place below.
        1 => vec![("error".into(), errors.concat())],
        _ => levels.iter().copied().map(of_levels).zip(errors).collect(),
    };
    let (name, labels): (&str, Vec<String>) = match smooth.len() {
        1 => ("levels K", levels.iter().map(usize::to_string).collect()),
        _ => (
            "strength of the smoothness along",
            smooth.iter().copied().map(strength).collect(),
        ),
    };
    let all = || lines.iter().flat_map(|(_, errors)| errors).flatten();
    let error = view.output.renamed(match view.validation()?.criterion {
        Criterion::LeftOut => "RMSE left out",
        Criterion::Evidence => "RMSE",
    });
    let y = Axis::new(&error, Span::of(all()).with(0.0).padded(0.05).from(0.0));
    let name = Labelled {
        name: name.into(),
        unit: None,
    };
    let x = Axis::named(&name, labels);

    let mut sheet = view.sheet(Figure::CrossValidation, WIDTH);
    let stroke = |n: usize| match lines.len() {
        1 => LINES[LINES.len() - 2],
        _ => LINES[n % LINES.len()],
    };
    let mut keys: Vec<Key> = lines
        .iter()
        .enumerate()
        .map(|(n, (name, _))| Key::Line(stroke(n), name.clone()))
        .collect();
    keys.push(Key::Marker(Marker::Disc, "chosen".into(), ""));
    sheet.legend(&keys);
    let left = MARGIN + left_of(&y, PLOT_HEIGHT);
    let area = Rect {
        x: left,
        y: sheet.top,
        width: WIDTH - MARGIN - left,
        height: PLOT_HEIGHT,
    };
    let panel = Panel::draw(&mut sheet.canvas, area, x, y, Labels { x: true, y: true });
    for (n, (_, errors)) in lines.iter().enumerate() {
        let xs: Vec<f64> = (0..errors.len()).map(|n| n as f64).collect();
        // What was not tried breaks the line.
        let ys: Vec<f64> = errors.iter().map(|e| e.unwrap_or(f64::NAN)).collect();
        panel.curve(&mut sheet.canvas, &xs, &ys, &stroke(n));
    }
    let fitted = view.source.fit()?.smooth.along;
    let row = levels.iter().position(|k| *k == view.source.levels());
    let column = smooth.iter().position(|s| *s == fitted);
    if let (Some(row), Some(column)) = (row, column) {
        let (line, place) = if smooth.len() == 1 {
            (0, row)
        } else {
            (row, column)
        };
        if let Some(error) = lines[line].1[place] {
            let at = panel.point(place as f64, error);
            Marker::Disc.draw(&mut sheet.canvas, [at], 5.0);
        }
    }
    let height = area.bottom() + BELOW + 4.0;
    Some(view.finish(Figure::CrossValidation, sheet, height))
}

/// The table of a choice without what would press the rest together: levels and strengths of which
/// nothing is left are not drawn.
fn shown(validation: &Validation) -> (Vec<usize>, Vec<f64>, Vec<Vec<Option<f64>>>) {
    let (mut levels, mut smooth, mut errors) = validation.table();
    let all = errors.iter().flatten().flatten();
    let most = SHOWN * all.copied().fold(f64::INFINITY, f64::min);
    for error in errors.iter_mut().flatten() {
        *error = error.filter(|error| *error <= most);
    }
    let rows: Vec<bool> = errors
        .iter()
        .map(|row| row.iter().any(Option::is_some))
        .collect();
    let column = |n: usize| errors.iter().any(|row| row[n].is_some());
    let columns: Vec<bool> = (0..smooth.len()).map(column).collect();
    retain(&mut levels, &rows);
    retain(&mut smooth, &columns);
    retain(&mut errors, &rows);
    errors.iter_mut().for_each(|row| retain(row, &columns));
    (levels, smooth, errors)
}

fn retain<T>(values: &mut Vec<T>, kept: &[bool]) {
    let mut kept = kept.iter();
    values.retain(|_| kept.next().is_some_and(|kept| *kept));
}

/// The numbers of levels that were tried and are not drawn.
pub(crate) fn choices_hidden(validation: &Validation) -> Vec<String> {
    let drawn = shown(validation).0;
    let (tried, ..) = validation.table();
    let hidden = tried.into_iter().filter(|levels| !drawn.contains(levels));
    hidden.map(|levels| levels.to_string()).collect()
}

/// `10⁻⁸` where it is one.
fn strength(value: f64) -> String {
    if value > 0.0 && (value / 10_f64.powi(value.log10().round() as i32) - 1.0).abs() < 1e-9 {
        return power_of_ten(magnitude(value * 1.000_001));
    }
    significant(value, 2)
}

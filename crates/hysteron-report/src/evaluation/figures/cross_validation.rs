//! How levels and smoothness were chosen: the error on left-out branches, a line for each number of
//! levels.

use crate::draw::axis::{Axis, Span};
use crate::draw::marker::Marker;
use crate::draw::sheet::{Key, Sheet};
use crate::draw::style::LINES;
use crate::evaluation::view::View;
use crate::figure::Figure;
use crate::number::{magnitude, percent, power_of_ten, significant};
use crate::panels::{WIDTH, single};
use crate::quantity::Labelled;
use hysteron::{Criterion, Validation};

const PLOT_HEIGHT: f64 = 340.0;

/// Errors beyond this many times the best are cut off: they would press the others together.
const SHOWN: f64 = 6.0;

pub(crate) fn figure<'a>() -> Figure<View<'a>> {
    Figure {
        stem: "cross-validation",
        chapter: None,
        width: WIDTH,
        is_linked: false,
        words,
        draw,
    }
}

fn words(view: &View<'_>) -> Option<[String; 2]> {
    let validation = view.validation()?;
    let caption = [
        chosen(validation, view),
        hidden(validation),
        rivals(validation),
    ];
    Some(["Choice of levels and smoothness".into(), caption.concat()])
}

fn chosen(validation: &Validation, view: &View<'_>) -> String {
    let parts = match validation.whole_branches {
        true => "",
        false => "parts of ",
    };
    let left_out = format!(
        "{} on {parts}branches left out, {} of the range",
        view.output.value(validation.rmse),
        percent(validation.nrmse_percent),
    );
    match validation.criterion {
        Criterion::LeftOut => format!(
            "Error on {parts}branches left out, in {} folds, at the best strength across. Chosen is \
             the smallest: {left_out}.",
            validation.folds
        ),
        Criterion::Evidence => format!(
            "Error over the samples fitted. The evidence chose, because there are few branches to \
             leave out, so the smallest error is not the best. What was chosen errs {left_out}."
        ),
    }
}

/// The numbers of levels that were tried and are not drawn.
fn hidden(validation: &Validation) -> String {
    let drawn = shown(validation).0;
    let (mut tried, ..) = validation.table();
    tried.retain(|levels| !drawn.contains(levels));
    let hidden: Vec<String> = tried.iter().map(usize::to_string).collect();
    match hidden.is_empty() {
        true => String::new(),
        false => format!(
            " Errors of more than {SHOWN} times the smallest are not shown: {} levels.",
            hidden.join(", ")
        ),
    }
}

fn rivals(validation: &Validation) -> String {
    let rivals = validation.rivals.iter().map(|rival| {
        let error = percent(rival.nrmse_percent);
        format!("{} errs {error}", rival.name)
    });
    let rivals: Vec<String> = rivals.collect();
    match rivals.is_empty() {
        true => String::new(),
        false => format!(" On the same samples left out, {}.", rivals.join(", ")),
    }
}

fn draw(view: &View<'_>, sheet: &mut Sheet) -> Option<f64> {
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
    let y = Axis::new(
        &error,
        Span::covering(all()).with(0.0).padded(0.05).from(0.0),
    );
    let name = Labelled {
        name: name.into(),
        unit: None,
    };
    let x = Axis::named(&name, labels);

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
    let panel = single(sheet, x, y, PLOT_HEIGHT);
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
    Some(panel.end())
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

/// `10⁻⁸` where it is one.
fn strength(value: f64) -> String {
    if value > 0.0 && (value / 10_f64.powi(value.log10().round() as i32) - 1.0).abs() < 1e-9 {
        return power_of_ten(magnitude(value * 1.000_001));
    }
    significant(value, 2)
}

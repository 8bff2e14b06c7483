//! Numbers and tables as text.

use hysteron::{
    Confidence, ConstantSummary, Errors, Excitation, FitSummary, Model, Quantity, Setting, Verdict,
};

/// A number with four significant digits.
pub(crate) fn number(value: f64) -> String {
    Quantity::default().text(value)
}

/// What is to be said of a model: a line for each sentence, those of one kind under one heading.
pub(crate) fn verdict(verdict: &Verdict) -> String {
    let mut last = "";
    let lines = verdict
        .lines(Setting::typed)
        .into_iter()
        .map(|(heading, text)| {
            let shown = if heading == last { "" } else { heading };
            last = heading;
            format!("{shown:<8} {text}")
        });
    lines.collect::<Vec<_>>().join("\n")
}

/// Columns side by side, the first aligned left, the others right.
pub(crate) fn table(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().enumerate().map(|(n, cell)| match n {
            0 => format!("{cell:<width$}", width = widths[n]),
            _ => format!("{cell:>width$}", width = widths[n]),
        });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// Cells of a table row.
pub(crate) fn row<const N: usize>(cells: [&str; N]) -> Vec<String> {
    cells.iter().map(|cell| (*cell).to_owned()).collect()
}

/// A table row of errors: RMSE, largest, percent of the range, samples.
pub(crate) fn errors(name: &str, errors: &Errors, quantity: &Quantity) -> Vec<String> {
    let percent = errors.nrmse_percent;
    vec![
        name.to_owned(),
        quantity.text(errors.rmse),
        quantity.text(errors.max_abs),
        percent.map_or("–".into(), |percent| format!("{percent:.2}")),
        errors.samples.to_string(),
    ]
}

/// What the data say of the weights, and what not.
pub(crate) fn confidence(fit: &FitSummary, model: &Model) -> Vec<String> {
    let Some(confidence) = &fit.confidence else {
        return Vec::new();
    };
    let classes = Excitation::ALL.iter().rev().map(|class| {
        let count = confidence.count(*class);
        format!("{count} {}", class.words())
    });
    vec![
        format!("operators: {}", classes.collect::<Vec<_>>().join(", ")),
        format!(
            "the data determine {} combinations of {} unknowns, the best of them {} times as well as \
             the worst; noise of the readings {}, misfit of the model {}",
            confidence.rank,
            confidence.unknowns,
            number(confidence.condition),
            model.output.text(confidence.sensor),
            model.output.text(fit.misfit().unwrap_or_default())
        ),
        sessions(confidence),
    ]
}

/// For what sessions the band holds.
pub(crate) fn sessions(confidence: &Confidence) -> String {
    let name = confidence.band_name();
    match confidence.sessions {
        0 | 1 => format!("{name}: another may differ by more; --repeat FILE widens it"),
        _ => name,
    }
}

/// So many numbers of a constant are listed.
const FEW: usize = 6;

/// The numbers of a constant of a stage, with its unit. Of many their range is told.
pub(crate) fn constant(constant: &ConstantSummary) -> String {
    let count = constant.numbers.len();
    let numbers = if count <= FEW {
        let each = constant.numbers.iter().copied().map(number);
        each.collect::<Vec<_>>().join(", ")
    } else {
        let (low, high) = hysteron::range(&constant.numbers);
        format!("{count} numbers, {} to {}", number(low), number(high))
    };
    let unit = constant.unit.as_deref().unwrap_or_default();
    format!("{numbers} {unit}").trim_end().to_owned()
}

//! The stages and the start of a model as C.

use super::constants::Constants;
use super::notation::{list, quantity};
use super::real::Number;
use super::stages::Staged;
use super::written::CExport;
use hysteron::Model;
use std::fmt::Write;

/// What the header says of the stages.
pub(super) fn remarks<T: Number>(model: &Model, staged: &Staged<T>) -> Vec<String> {
    let mut lines = vec![format!("stages: {}", staged.names().join(", "))];
    if let Some(dt) = staged.dt {
        lines.push(format!("sample time: {dt:?} s"));
    }
    if let (Some(load), [low, .., high]) = (&model.load, staged.constants.get("loads")) {
        lines.push(format!(
            "load: {}, from {low:?} to {high:?}",
            quantity(&load.quantity)
        ));
    }
    if let Some((load, parts)) = model.load.as_ref().zip(staged.parts.as_ref()) {
        let (low, high) = parts.range;
        lines.push(format!(
            "weights for a load: {}, from {low:?} to {high:?}, {} parts; start it with \
             hys_actuator_start_mixed",
            quantity(&load.quantity),
            parts.offsets.len()
        ));
    }
    if let Some((low, high)) = staged.drive {
        lines.push(format!(
            "range of the drive in the inverse: {low:?} to {high:?}"
        ));
    }
    lines
}

/// Declarations of a model without stages that does not start with every operator off.
pub(super) fn start_declared<T: Number>(export: &CExport, constants: &Constants<T>) -> String {
    let CExport { name, .. } = export;
    match (&constants.start, &constants.stages) {
        (Some((points, _)), None) => format!(
            "/* Where the model starts: for hys_restore, after hys_start. */
extern const hys_real {name}_start[{count}];
extern const hys_real {name}_start_input;
",
            count = points.len()
        ),
        _ => String::new(),
    }
}

/// Their definition.
pub(super) fn start_defined<T: Number>(export: &CExport, constants: &Constants<T>) -> String {
    let CExport { name, .. } = export;
    match (&constants.start, &constants.stages) {
        (Some((points, input)), None) => format!(
            "\nconst hys_real {name}_start[] = {}const hys_real {name}_start_input = {};\n",
            list(points),
            input.literal()
        ),
        _ => String::new(),
    }
}

/// Defines the actuator around the operators.
pub(super) fn actuator<T: Number>(
    export: &CExport,
    constants: &Constants<T>,
    staged: &Staged<T>,
) -> String {
    let CExport { name, .. } = export;
    let start: &[T] = constants.start.as_ref().map_or(&[], |(points, _)| points);
    let arrays: Vec<_> = staged.arrays().chain([("start", start)]).collect();
    let mut text = String::new();
    for (array, numbers) in arrays.iter().filter(|(_, numbers)| !numbers.is_empty()) {
        let _ = write!(
            text,
            "\nstatic const hys_real {array}[] = {}",
            list(numbers)
        );
    }
    if let Some(parts) = &staged.parts {
        let (low, high) = parts.range;
        let _ = write!(
            text,
            "\nstatic const hys_real part_offsets[] = {}\nstatic const hys_parts parts = {{\n    \
             .tables = table,\n    .offsets = part_offsets,\n    .count = {},\n    .min = {},\n    \
             .max = {}\n}};\n",
            list(&parts.offsets),
            parts.offsets.len(),
            low.literal(),
            high.literal()
        );
    }
    // Measured time changes its factors.
    let kept = if staged.measured { "" } else { "const " };
    let _ = write!(
        text,
        "\n{kept}hys_actuator {name} = {{\n    .operators = &operators,\n"
    );
    for (array, numbers) in &arrays {
        let value = if numbers.is_empty() { "NULL" } else { array };
        let _ = writeln!(text, "    .{array} = {{{value}, {}}},", numbers.len());
    }
    let parts = if staged.parts.is_some() {
        "&parts"
    } else {
        "NULL"
    };
    let _ = writeln!(text, "    .parts = {parts},");
    let core = staged.core();
    let each = core.behind.there().enumerate();
    let bits = each.map(|(n, (_, there))| u32::from(there) << n);
    let _ = writeln!(text, "    .there = {},", bits.sum::<u32>());
    for (field, number) in fields(constants, staged) {
        let _ = writeln!(text, "    .{field} = {},", number.literal());
    }
    let slopes: Vec<T> = core.behind.slopes().collect();
    for (field, numbers) in [("factors", &staged.rates[2..]), ("slopes", &slopes)] {
        let numbers: Vec<String> = numbers.iter().map(|number| number.literal()).collect();
        let _ = writeln!(text, "    .{field} = {{{}}},", numbers.join(", "));
    }
    let _ = write!(
        text,
        "    .body = {},\n    .falls = {},\n    .limited = {}\n}};\n",
        usize::from(core.body.is_some()),
        usize::from(constants.falls),
        usize::from(staged.drive.is_some()),
    );
    text
}

fn fields<T: Number>(constants: &Constants<T>, staged: &Staged<T>) -> [(&'static str, T); 12] {
    let single = |name: &str| staged.constants.get(name).first().copied();
    let (low, high) = staged.drive.unwrap_or((T::ZERO, T::ZERO));
    let start = constants.start.as_ref().map(|(_, input)| *input);
    [
        ("start_input", start.unwrap_or(T::ZERO)),
        ("steepest", staged.steepest),
        ("ambient", single("ambient").unwrap_or(T::ZERO)),
        ("gain", single("gain").unwrap_or(T::ZERO)),
        ("heating", staged.rates[0]),
        ("cooling", staged.rates[1]),
        ("latent", single("latent").unwrap_or(T::ZERO)),
        ("steepest_behind", staged.gain),
        ("size_behind", staged.size),
        ("offset", constants.offset),
        ("drive_min", low),
        ("drive_max", high),
    ]
}

//! The files that hold a model.

use super::algorithm::{ADAPTATION, ALGORITHM, STAGES};
use super::constants::Constants;
use super::notation::{array, plain, quantity};
use super::real::Number;
use super::stage_text::{actuator, remarks, start_declared, start_defined};
use super::written::CExport;
use hysteron::{Model, Operator, Sign};
use hysteron_core::{operator_index, table_index, table_len, turn_capacity};
use std::fmt::Write;
use std::path::Path;

/// What stands beside a model, for a learner or for a control loop.
pub(super) struct Beside {
    /// One more header.
    pub(super) include: Option<&'static str>,
    /// Its sizes, as macros.
    pub(super) sizes: String,
    pub(super) declared: String,
    /// The definitions, but for the weights.
    pub(super) defined: String,
}

/// Declares the model, and says what it is.
pub(super) fn header<T: Number>(
    export: &CExport,
    constants: &Constants<T>,
    model: &Model,
    source: &Path,
    (learned, around): (Option<&Beside>, Option<&Beside>),
) -> String {
    let CExport { name, levels, .. } = export;
    let shout = name.to_uppercase();
    let memory = export.memory;
    let operator = match model.operator() {
        Operator::Mkp => "MKP",
        Operator::Kp => "KP",
        Operator::Relay => "relay",
    };
    let file = source.file_name().unwrap_or_default().to_string_lossy();
    let (low, high) = model.output_range();
    let mut lines = vec![
        match *file == **name {
            true => format!("{name}: a hysteresis model"),
            false => format!("{name}: the model of {}", plain(&file)),
        },
        format!(
            "{operator} operators, K = {levels} levels, {} of {} operators with a weight, {}",
            model.weights().iter().filter(|mu| **mu != 0.0).count(),
            model.plane().operators(),
            export.real.name(),
        ),
        match constants.stages {
            None => format!(
                "input: {}, from {:?} to {:?}",
                quantity(&model.input),
                model.plane().bottom(),
                model.plane().max()
            ),
            Some(_) => format!("input: {}", quantity(&model.input)),
        },
        format!(
            "output: {}, from {low:?} (all operators off) to {high:?} (all on){}",
            quantity(&model.output),
            match model.sign() {
                Sign::Positive => "",
                Sign::Negative => "; falls as the input rises",
            },
        ),
        match export.inverse {
            true => format!(
                "inverse: a target that is HYS_REACHED is met up to its tolerance and {:.1e}{}",
                export.rounding,
                model
                    .output
                    .unit
                    .as_deref()
                    .map_or(String::new(), |unit| format!(" {}", plain(unit))),
            ),
            false => format!(
                "inverse: none, for there are weights below zero ({} returns HYS_NEGATIVE_WEIGHTS)",
                match constants.stages {
                    None => "hys_inverse_step",
                    Some(_) => "hys_actuator_inverse_step",
                }
            ),
        },
        format!(
            "memory on a 32-bit target: {} bytes of constants (flash); for each state {} bytes and \
             {} for its turning points (RAM)",
            memory.constants, memory.state, memory.turns
        ),
        format!(
            "worst case: {} turning points passed in a step; {} halvings in an inverse step, then \
             a step",
            export.worst_case.turning_points, export.worst_case.halvings
        ),
    ];
    let staged = constants.stages.as_ref();
    lines.extend(staged.into_iter().flat_map(|staged| remarks(model, staged)));
    let (mut sizes, mut weights) = (String::new(), start_declared(export, constants));
    if let (Some(bytes), Some(learned)) = (memory.adaptation, learned) {
        lines.push(format!(
            "adaptation by increments: {bytes} bytes beside (RAM)"
        ));
        sizes.clone_from(&learned.sizes);
        weights += &learned.declared;
    }
    if !model.delay().is_none() {
        // A clock is rounded; a nanosecond is no part of a time that one gives.
        let seconds = (model.delay().seconds() * 1e9).round() / 1e9;
        let samples = model.delay().at(export.dt);
        lines.push(format!(
            "dead time: {seconds} s or {samples} samples until an input acts"
        ));
    }
    if let Some(around) = around {
        sizes += &around.sizes;
        weights += &around.declared;
    }
    let include = around.and_then(|around| around.include);
    let include = include.map_or(String::new(), |file| format!("#include \"{file}\"\n"));
    if staged.is_some_and(|staged| staged.parts.is_some()) {
        sizes += &format!("#define {shout}_TABLE {}\n", table_len(*levels));
    }
    let operators = check(name, "HYS_LAYOUT", ALGORITHM[0]);
    let (file, kind, checks) = match staged {
        None if learned.is_some() => (ADAPTATION[0].0, "hys_model", operators),
        None => (ALGORITHM[0].0, "hys_model", operators),
        Some(_) => (
            STAGES[0].0,
            "hys_actuator",
            operators + &check(name, "HYS_STAGES_LAYOUT", STAGES[0]),
        ),
    };
    let lines: String = lines.iter().map(|line| format!(" * {line}\n")).collect();
    format!(
        "/* hysteron {version}.
{lines} */
#ifndef {shout}_H
#define {shout}_H

#include \"{file}\"
{include}
{checks}
#define {shout}_LEVELS {levels}
#define {shout}_TURNS {turns}
{sizes}
#ifdef __cplusplus
extern \"C\" {{
#endif
extern {kept}{kind} {name};
{weights}#ifdef __cplusplus
}}
#endif

#endif
",
        version = env!("CARGO_PKG_VERSION"),
        kept = match staged.is_some_and(|staged| staged.measured) {
            true => "",
            false => "const ",
        },
        turns = turn_capacity(*levels),
    )
}

/// Stops the compilation beside an algorithm of another layout.
fn check(name: &str, macro_name: &str, header: (&str, &str)) -> String {
    let (file, text) = header;
    let start = format!("#define {macro_name} ");
    let layout = text.lines().find_map(|line| line.strip_prefix(&start));
    let layout = layout.unwrap_or("0");
    format!(
        "#if {macro_name} != {layout}
#error \"{name}: export the model again: {file} is of another version\"
#endif
"
    )
}

/// Defines it.
pub(super) fn source<T: Number>(
    export: &CExport,
    constants: &Constants<T>,
    (learned, control): (Option<&Beside>, Option<&Beside>),
) -> String {
    let CExport {
        name, real, levels, ..
    } = export;
    let real = real.name();
    let plane = constants.core.plane();
    let mut text = format!(
        "/* hysteron {version}. */
#include \"{name}.h\"

/* The constants below are of {real}. */
typedef char {name}_is_{real}[sizeof(hys_real) == sizeof({real}) && sizeof({real}) == {bytes} \
? 1 : -1];

{apart}static const hys_real table[] HYS_IN_FLASH = ",
        version = env!("CARGO_PKG_VERSION"),
        bytes = T::BYTES,
        apart = match export.memory.mixed {
            0 => String::new(),
            _ => format!(
                "#if defined(__AVR__) && !defined(HYS_TABLES_IN_RAM)\n#error \"{name}: its weights \
                 depend on the load: define HYS_TABLES_IN_RAM\"\n#endif\n\n"
            ),
        },
    );
    // One table, or those of the parts.
    let tables = constants.table().chunks(table_len(*levels));
    let rows =
        tables.flat_map(|table| (0..=*levels).map(move |p| &table[table_index(p, 0)..][..=p]));
    text += &array(rows);
    let (offset, falls) = constants.operators_own();
    let fields = [
        ("top", T::from_index(*levels)),
        ("min", plane.min()),
        ("max", plane.max()),
        ("bottom", plane.bottom()),
        ("step", plane.step()),
        ("per_unit", plane.per_unit()),
        ("nudge", plane.nudge()),
        ("total", constants.core.total()),
        ("rounding", constants.rounding.unwrap_or(T::ZERO)),
        ("offset", offset),
    ];
    let _ = write!(
        text,
        "\n{model} = {{\n    .table = table,\n    .levels = {levels},\n",
        model = match constants.stages {
            None => format!("const hys_model {name}"),
            Some(_) => "static const hys_model operators".to_owned(),
        },
    );
    for (field, number) in fields {
        let _ = writeln!(text, "    .{field} = {},", number.literal());
    }
    let _ = write!(
        text,
        "    .kind = {},\n    .falls = {},\n    .inverse = {}\n}};\n",
        constants.kind(),
        usize::from(falls),
        usize::from(constants.rounding.is_some()),
    );
    if let Some(staged) = &constants.stages {
        text += &actuator(export, constants, staged);
    }
    text += &start_defined(export, constants);
    if let Some(learned) = learned {
        let rows = (1..=*levels).map(|j| &constants.weights[operator_index(1, j)..][..j]);
        let _ = write!(text, "\nconst hys_real {name}_weights[] = {}", array(rows));
        text += &learned.defined;
    }
    if let Some(control) = control {
        text += &control.defined;
    }
    text
}

//! Writes the runs for C, as `rust/build.rs` does for Rust, and a model file for each model.

use crate::data::{Model, Run};
use crate::staged::{StagedModel, StagedRun};
use std::fmt::{Debug, Write};
use std::path::Path;

pub fn write((models, runs): &(Vec<Model>, Vec<Run>), folder: &Path) -> Result<(), String> {
    let file = |name: String, text: String| {
        std::fs::write(folder.join(&name), text).map_err(|why| format!("{name}: {why}"))
    };
    let mut headers = String::new();
    let mut weights = String::from("/* The weights of the models that are measured. */\n");
    let mut plain = String::new();
    for m in models {
        let name = &m.name;
        headers += &format!("#include \"{name}.h\"\n");
        file(format!("{name}.json"), m.json.to_string())?;
        if is_measured(m) {
            weights += &format!(
                "static const hys_real {name}_weights[] = {{{}}};\n",
                list(&m.weights)
            );
            plain += &format!(
                "static const plain_model {name} = {{{}, {:?}, {:?}, {name}_weights}};\n",
                m.levels, m.min, m.max
            );
        }
    }
    let (mut constants, mut table) = (String::new(), String::new());
    for (n, run) in runs.iter().enumerate() {
        let model = &models[run.model];
        let (kinds, values): (Vec<i8>, Vec<f64>) = run.steps.iter().copied().unzip();
        // The plain loop is the baseline of the measured runs only.
        let (open, close) = if is_measured(model) {
            ("", "")
        } else {
            ("#ifndef PLAIN\n", "#endif\n")
        };
        constants += &format!(
            "{open}static const signed char kinds_{n}[] = {{{}}};\nstatic const hys_real values_{n}[] = {{{}}};\n{close}",
            list(&kinds),
            list(&values)
        );
        writeln!(
            table,
            "{open}    {{{:?}, &{}, {}, {:?}, {}, kinds_{n}, values_{n}}},\n{close}",
            run.name,
            model.name,
            model.levels,
            run.tolerance,
            kinds.len()
        )
        .map_err(|why| why.to_string())?;
    }
    let text = format!(
        "#include \"run.h\"\n#ifdef PLAIN\n#include \"weights.h\"\n{plain}#else\n{headers}#endif\n\n{constants}\n\
         const run runs[] = {{\n{table}}};\nconst size_t run_count = sizeof runs / sizeof *runs;\n"
    );
    file("runs.c".into(), text)?;
    file("weights.h".into(), weights)
}

/// The same for models with stages: `staged.c`, a model file each, and in `staged.txt` the name and
/// the options of `hysteron export c` for each.
pub fn write_staged(
    (models, runs): &(Vec<StagedModel>, Vec<StagedRun>),
    folder: &Path,
) -> Result<(), String> {
    let file = |name: String, text: String| {
        std::fs::write(folder.join(&name), text).map_err(|why| format!("{name}: {why}"))
    };
    let (mut headers, mut options) = (String::new(), String::new());
    for m in models {
        let name = &m.model.name;
        headers += &format!("#include \"{name}.h\"\n");
        options += name;
        if let Some(dt) = m.dt {
            options += &format!(" --dt {dt:?}");
        }
        options.push('\n');
        file(format!("{name}.json"), m.model.json.to_string())?;
    }
    let (mut constants, mut table) = (String::new(), String::new());
    for (n, run) in runs.iter().enumerate() {
        let model = &models[run.model].model;
        let kinds: Vec<i8> = run.steps.iter().map(|step| step.0).collect();
        let values: Vec<f64> = run.steps.iter().map(|step| step.1).collect();
        let loads: Vec<f64> = run.steps.iter().map(|step| step.2).collect();
        constants += &format!(
            "static const signed char kinds_{n}[] = {{{}}};\nstatic const hys_real values_{n}[] = {{{}}};\n\
             static const hys_real loads_{n}[] = {{{}}};\n",
            list(&kinds),
            list(&values),
            list(&loads)
        );
        table += &format!(
            "    {{{:?}, &{}, {}, {:?}, {}, kinds_{n}, values_{n}, loads_{n}}},\n",
            run.name,
            model.name,
            model.levels,
            run.tolerance,
            kinds.len()
        );
    }
    let text = format!(
        "#include \"run.h\"\n{headers}\n{constants}\nconst staged_run staged_runs[] = {{\n{table}}};\n\
         const size_t staged_run_count = sizeof staged_runs / sizeof *staged_runs;\n"
    );
    file("staged.c".into(), text)?;
    file("staged.txt".into(), options)
}

pub fn is_measured(model: &Model) -> bool {
    model.name.starts_with("bench")
}

fn list<T: Debug>(values: &[T]) -> String {
    let values: Vec<String> = values.iter().map(|value| format!("{value:?}")).collect();
    values.join(", ")
}

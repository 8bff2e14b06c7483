//! `hysteron start`: what is in a file, a first fit, and the commands to go on with.

use crate::columns::Given;
use crate::terminal::{Result, Unclear, print, say};
use crate::{args, prepare, progress, recording, remedy, text};
use hysteron::{
    Advice, Columns, Fit, Model, Progress, Recording, RecordingSummary, Roles, TableReader, Verdict,
};
use hysteron_files::shell_word;
use serde_json::json;
use std::collections::BTreeSet;
use std::error::Error;

pub(crate) fn run(args: &args::Begin) -> Result<()> {
    let inputs = [args.file.as_path()];
    let file = args.out.as_ref().map(|out| {
        let target = args.force.target(out, &inputs);
        Model::file(target)
    });
    let file = file.transpose()?;
    let mut table = TableReader::open_with(&args.file, args.repair.max_memory())?;
    let given = Given {
        input: args.input.as_deref(),
        output: args.output.as_deref(),
        time: args.time.as_deref(),
        load: args.load.as_deref(),
    };
    let preview = given.preview(&mut table)?;
    drop(table);
    let roles = &preview.roles;
    let (Some(input), Some(output)) = (&roles.input, &roles.output) else {
        return Err(unclear(args, roles));
    };
    if !args.json.json {
        let columns = preview.table.columns.iter();
        let names: Vec<&str> = columns.map(|column| column.name.as_str()).collect();
        let (rows, names) = (preview.table.rows, names.join(", "));
        print(&format!("{}: {rows} rows of {names}", args.file.display()))?;
        print(&roles.reasons.join("\n"))?;
    }
    let columns = Columns {
        time: roles.time.as_deref(),
        load: roles.load.as_deref(),
        ..Columns::new(input, output)
    };
    let recordings = recording::segments(&args.file, columns, &args.repair)?;
    let plane = hysteron::plane_of(&recordings, 20)?;
    let summary = hysteron::inspect_recording(&recordings, plane)?;
    remedy::say_doubts(&summary.doubts, "");
    let recordings = prepare::each_asked_for(recordings, &args.prepare)?;
    let model = fit(&recordings)?;
    let verdict = Verdict::of_fit(&model, &recordings)?.doubting(summary.doubts.len());
    let mut advice = prepare::advice(&model, &recordings, &args.prepare)?;
    let mut prepared = args.prepare.prepare;
    let is_asked = || advice.iter().any(Advice::is_cured_by_preparation);
    if !prepared && summary.doubts.is_empty() && is_asked() {
        prepared = prepare::helps(&recordings, &model, fit)?;
        if !prepared {
            advice.retain(|one| !one.is_cured_by_preparation());
        }
    }
    let commands = commands(args, columns, prepared, step_of(&model, &recordings));
    if let Some(file) = file {
        file.commit_with(model.to_json().as_bytes())?;
    }
    if args.json.json {
        let object = json!({
            "table": preview.table,
            "roles": {
                "input": input,
                "output": output,
                "time": roles.time,
                "load": roles.load,
            },
            "reasons": roles.reasons,
            "recording": summary,
            "fit": model.fit,
            "verdict": verdict,
            "advice": advice.iter().map(remedy::text_of_advice).collect::<Vec<_>>(),
            "commands": commands,
            "model": args.out,
        });
        return print(&object.to_string());
    }
    let written = args.out.as_ref().map(|out| format!("\n{}", out.display()));
    let text = to_text(&summary, &model)?;
    print(&(text + &written.unwrap_or_default()))?;
    print(&format!("\n{}", text::verdict(&verdict)))?;
    for advice in &advice {
        say(format_args!("{}", remedy::text_of_advice(advice)));
    }
    print(&format!("\nGo on with:\n{}", commands.join("\n")))
}

/// Asks for the roles that cannot be told: what may have them, why, and the command to type.
fn unclear(args: &args::Begin, roles: &Roles) -> Box<dyn Error> {
    let candidates = roles.doubts.iter().flat_map(|doubt| &doubt.candidates);
    let found = roles.input.iter().chain(&roles.output);
    let all: BTreeSet<&String> = candidates.map(|(name, _)| name).chain(found).collect();
    if all.len() < 2 {
        let what = "no two columns of this file change: input and output are needed";
        return what.into();
    }
    let asked = roles.doubts.iter().map(|doubt| {
        let each = doubt.candidates.iter();
        let each = each.map(|(name, why)| format!("\n  `{name}`, {why}"));
        format!(
            "which column is the {}?{}",
            doubt.role,
            each.collect::<String>()
        )
    });
    let asked = asked.collect::<Vec<_>>().join("\n");
    // The first candidates, of which none is taken twice.
    let mut taken: Vec<&str> = roles
        .input
        .iter()
        .chain(&roles.output)
        .map(String::as_str)
        .collect();
    let mut named = String::new();
    for (role, found) in [
        ("input", &roles.input),
        ("output", &roles.output),
        ("time", &roles.time),
        ("load", &args.load),
    ] {
        let doubt = roles.doubts.iter().find(|doubt| doubt.role == role);
        let names = doubt.into_iter().flat_map(|doubt| &doubt.candidates);
        let mut names = names.map(|(name, _)| name.as_str());
        let name = found
            .as_deref()
            .or_else(|| names.find(|name| !taken.contains(name)));
        if let Some(name) = name {
            taken.push(name);
            named += &format!(" {}", option(role, name));
        }
    }
    let file = shell_word(&args.file.display().to_string());
    Box::new(Unclear(format!(
        "{}: the columns do not tell their roles. {asked}\nname them, such as\n  hysteron start \
         {file}{named}",
        args.file.display()
    )))
}

/// A fit as `hysteron fit` makes it without options.
fn fit(recordings: &[Recording]) -> Result<Model> {
    let bar = progress::stages();
    let report = |stage: &'static str, done: f64| {
        progress::stage(&bar, stage, done);
        Ok(())
    };
    let model = Fit::new()
        .progress(Progress::new(&report))
        .run(recordings)?;
    bar.finish_and_clear();
    Ok(model)
}

fn to_text(summary: &RecordingSummary, model: &Model) -> Result<String> {
    let mut lines = vec![format!(
        "{}, {} of the input, {} of them larger than 1 % of its range",
        hysteron::counted(summary.samples, "sample"),
        hysteron::counted(summary.input.reversals_of_any_size, "reversal"),
        summary.input.reversals,
    )];
    if let Some(fit) = &model.fit {
        lines.push(format!(
            "a first fit: {} levels, RMSE {} ({:.2} % of the range) on what was fitted",
            model.plane().levels(),
            model.output.text(fit.rmse),
            fit.nrmse_percent,
        ));
    }
    let stages = hysteron::inspect_model(model)?.stages.into_iter();
    let stages = stages.filter(|stage| stage.name != "spacing");
    lines.extend(stages.map(|stage| {
        let constants = stage.constants.iter().map(|constant| {
            let numbers = text::constant(constant);
            match constant.name == stage.name {
                true => numbers,
                false => format!("{} {numbers}", constant.name),
            }
        });
        let constants = constants.collect::<Vec<_>>().join(", ");
        format!("{}: {}", stage.name, constants)
    }));
    if !model.delay().is_none() {
        let samples = model.delay().samples();
        lines.push(format!(
            "dead time: {}",
            hysteron::counted(samples, "sample")
        ));
    }
    Ok(lines.join("\n"))
}

/// The time between samples, for a model that needs it.
fn step_of(model: &Model, recordings: &[Recording]) -> Option<f64> {
    let time = recordings.first()?.time.as_ref()?;
    let steps = time.len().checked_sub(1).filter(|steps| *steps > 0)?;
    let step = (time[steps] - time[0]) / steps as f64;
    (model.is_timed() && step > 0.0).then_some(step)
}

/// An option with a value that may look like another one.
fn option(name: &str, value: &str) -> String {
    match value.starts_with('-') {
        true => format!("--{name}={}", shell_word(value)),
        false => format!("--{name} {}", shell_word(value)),
    }
}

fn commands(
    args: &args::Begin,
    columns: Columns<'_>,
    prepared: bool,
    step: Option<f64>,
) -> Vec<String> {
    let file = shell_word(&args.file.display().to_string());
    let mut named = format!(
        "{} {}",
        option("input", columns.input),
        option("output", columns.output)
    );
    for (name, column) in [("time", columns.time), ("load", columns.load)] {
        if let Some(column) = column {
            named += &format!(" {}", option(name, column));
        }
    }
    if args.repair.is_asked() {
        named += " --repair";
    }
    if prepared {
        named += " --prepare";
    }
    let another = args.file.with_file_name("ANOTHER");
    let another = another.with_extension(args.file.extension().unwrap_or_default());
    let other = shell_word(&another.display().to_string());
    let dt = step.map_or(String::new(), |step| {
        format!(" --dt {}", text::number(step))
    });
    // The exponents of curves over a load need not fit single precision.
    let real = columns.load.map_or("", |_| " --real double");
    let mut commands = vec![
        format!("hysteron fit {file} {named} -o model.json"),
        format!("hysteron evaluate model.json {other} {named} --report report"),
        format!("hysteron export c model.json{dt}{real} -o model-c"),
    ];
    if cfg!(feature = "studio") {
        commands.insert(0, format!("hysteron studio {file}"));
    }
    commands
}

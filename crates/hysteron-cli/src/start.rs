//! `hysteron start`: what is in a file, a first fit, and the commands to go on with.

use crate::terminal::{Result, print, say};
use crate::{args, hold_out, progress, recording, remedy, text};
use hysteron::{
    Columns, Fit, HeldOut, HoldOut, Model, Progress, Recording, RecordingSummary, Roles,
    TableReader, fit_holding_out, shell_word,
};
use serde_json::json;

pub(crate) fn run(args: &args::Begin) -> Result<()> {
    let mut table = TableReader::open_with(&args.file, args.repair.max_memory())?;
    let preview = hysteron::preview_table(&mut table)?;
    drop(table);
    let roles = Roles {
        input: args.input.clone().or(preview.roles.input.clone()),
        output: args.output.clone().or(preview.roles.output.clone()),
        ..preview.roles.clone()
    };
    let (Some(input), Some(output)) = (&roles.input, &roles.output) else {
        let what = "no two columns of this file change: input and output are needed";
        return Err(what.into());
    };
    if !args.json.json {
        let names = preview
            .table
            .columns
            .iter()
            .map(|column| column.name.as_str());
        let names = names.collect::<Vec<_>>().join(", ");
        let rows = preview.table.rows;
        print(&format!("{}: {rows} rows of {names}", args.file.display()))?;
        print(&roles.reasons.join("\n"))?;
    }
    // A column that was named is not guessed to be another one too.
    let guessed = |column: &Option<String>| {
        let column = column.clone();
        column.filter(|name| name != input && name != output)
    };
    let (time, load) = (guessed(&roles.time), guessed(&roles.load));
    let columns = Columns {
        time: time.as_deref(),
        load: load.as_deref(),
        ..Columns::new(input, output)
    };
    let recording = recording::read(&args.file, columns, &args.repair)?;
    let plane = hysteron::plane_of(&recording, 20)?;
    let summary = hysteron::inspect_recording(&recording, plane)?;
    let (model, held_out) = fit(&recording)?;
    let mut advice = hysteron::advice(&model, std::slice::from_ref(&recording))?;
    advice.extend(held_out.iter().flat_map(HeldOut::advice));
    let commands = commands(args, columns, held_out.is_some());
    if args.json.json {
        let object = json!({
            "table": preview.table,
            "roles": {"input": input, "output": output, "time": time, "load": load},
            "reasons": roles.reasons,
            "recording": summary,
            "fit": model.fit,
            "hold_out": held_out,
            "advice": advice.iter().map(remedy::text_of_advice).collect::<Vec<_>>(),
            "commands": commands,
        });
        return print(&object.to_string());
    }
    print(&to_text(&summary, &model, held_out.as_ref()))?;
    for advice in &advice {
        say(format_args!("{}", remedy::text_of_advice(advice)));
    }
    print(&format!("\nGo on with:\n{}", commands.join("\n")))
}

/// A fit that is tested on a fifth of the branches, where there are enough of them.
fn fit(recording: &Recording) -> Result<(Model, Option<HeldOut>)> {
    let bar = progress::stages();
    let told = |stage: &'static str, done: f64| {
        progress::stage(&bar, stage, done);
        Ok(())
    };
    let fit = Fit::new().progress(Progress::new(&told));
    let fifth = HoldOut::Branches(0.2);
    let found = match recording.split(&fifth) {
        Ok(_) => {
            let (model, held_out) = fit_holding_out(&fit, recording, &fifth)?;
            (model, Some(held_out))
        }
        Err(_) => (fit.run(recording)?, None),
    };
    bar.finish_and_clear();
    Ok(found)
}

fn to_text(summary: &RecordingSummary, model: &Model, held_out: Option<&HeldOut>) -> String {
    let mut lines = vec![format!(
        "{} samples, {} reversals of the input, {} of them larger than 1 % of its range",
        summary.samples, summary.input.reversals_of_any_size, summary.input.reversals,
    )];
    if let Some(fit) = &model.fit {
        lines.push(format!(
            "a first fit: {} levels, RMSE {} ({:.2} % of the range) on what was fitted",
            model.plane().levels(),
            text::with_unit(fit.rmse, &model.output),
            fit.nrmse_percent,
        ));
    }
    lines.push(match held_out {
        Some(held_out) => hold_out::to_text(held_out, model),
        None => "there are too few branches to hold some out: test the model on another recording"
            .into(),
    });
    lines.join("\n")
}

fn commands(args: &args::Begin, columns: Columns<'_>, held_out: bool) -> Vec<String> {
    let file = shell_word(&args.file.display().to_string());
    let mut named = format!(
        "--input {} --output {}",
        shell_word(columns.input),
        shell_word(columns.output)
    );
    for (name, column) in [("time", columns.time), ("load", columns.load)] {
        if let Some(column) = column {
            named += &format!(" --{name} {}", shell_word(column));
        }
    }
    let held_out = if held_out {
        " --hold-out branches:20%"
    } else {
        ""
    };
    let mut commands = vec![
        format!("hysteron fit {file} {named}{held_out} -o model.json"),
        format!("hysteron evaluate model.json {file} {named} --report report"),
        "hysteron export c model.json -o model-c".to_owned(),
    ];
    if cfg!(feature = "studio") {
        commands.insert(0, format!("hysteron studio {file}"));
    }
    commands
}

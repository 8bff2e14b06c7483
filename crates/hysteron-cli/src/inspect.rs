//! `hysteron inspect`

use crate::remedy::{say_doubts, text_of_advice};
use crate::terminal::{Result, print, say};
use crate::{args, recording, text};
use hysteron::{
    Columns, ConfidenceSummary, Criterion, Model, Plane, Recording, RecordingSummary, StageSummary,
    TableReader, Uncertain, Validation,
};
use serde_json::json;

pub(crate) fn run(args: &args::Inspect) -> Result<()> {
    if args
        .file
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("json"))
    {
        return model(args);
    }
    match (&args.input, &args.output) {
        (Some(input), Some(output)) => summary(args, input, output),
        _ => columns(args),
    }
}

/// The columns, for whoever does not know their names yet.
fn columns(args: &args::Inspect) -> Result<()> {
    let mut table = TableReader::open_with(&args.file, args.repair.max_memory())?;
    let summary = hysteron::inspect_table(&mut table)?;
    recording::tell_of_table(&args.file, &table);
    if args.json.json {
        return print(&json!(summary).to_string());
    }
    let mut lines = vec![text::row(["column", "smallest", "largest", "not numbers"])];
    for column in &summary.columns {
        let [min, max] = [column.min, column.max].map(|v| v.map_or("–".into(), text::number));
        lines.push(vec![
            column.name.clone(),
            min,
            max,
            column.not_numbers.to_string(),
        ]);
    }
    print(&format!(
        "{}: {} rows\n{}\nName --input and --output for reversals and excitation, or let `hysteron \
         start` find them.",
        args.file.display(),
        summary.rows,
        text::table(&lines)
    ))
}

fn summary(args: &args::Inspect, input: &str, output: &str) -> Result<()> {
    let columns = Columns {
        input,
        output,
        time: args.time.as_deref(),
        load: None,
    };
    let recordings = recording::segments(&args.file, columns, &args.repair)?;
    let plane = match args.range {
        Some((min, max)) => Plane::new(min, max, args.levels)?,
        None => hysteron::plane_of(&recordings, args.levels)?,
    };
    let summary = hysteron::inspect_recording(&recordings, plane)?;
    if args.json.json {
        return print(&json!(summary).to_string());
    }
    say_doubts(&summary.doubts, "");
    for advice in hysteron::advice_before_fit(&recordings) {
        say(format_args!("{}", text_of_advice(&advice)));
    }
    print(&recording_text(&summary, &recordings))
}

fn recording_text(summary: &RecordingSummary, recordings: &[Recording]) -> String {
    let mut rows = vec![text::row([
        "",
        "column",
        "smallest",
        "largest",
        "reversals",
        "of any size",
    ])];
    for (name, series) in [("input", &summary.input), ("output", &summary.output)] {
        rows.push(vec![
            name.to_owned(),
            series.name.clone(),
            text::number(series.min),
            text::number(series.max),
            series.reversals.to_string(),
            series.reversals_of_any_size.to_string(),
        ]);
    }
    let time = summary.time.as_ref().map_or(String::new(), |time| {
        let after = time.longest_step_before_sample;
        let after = match recordings {
            [only] => only.named(after - 1),
            _ => format!("sample {after}"),
        };
        format!(
            "time {} to {} s, median step {} s, longest {} s before {after}, {} gaps, {} \
             repeated\n",
            text::number(time.start),
            text::number(time.end),
            text::number(time.median_step),
            text::number(time.longest_step),
            time.gaps,
            time.repeated
        )
    });
    let determined = match (summary.rank, summary.determined) {
        (Some(rank), Some(determined)) => format!(
            ";\n{rank} combinations of their weights determined, {determined} of them against the \
             noise of the output"
        ),
        _ => String::new(),
    };
    format!(
        "{} samples{}\n{}\n{time}plane of {} levels from {} to {}: {} of {} operators excited\
         {determined}",
        summary.samples,
        match summary.segments {
            1 => String::new(),
            count => format!(" in {count} recordings"),
        },
        text::table(&rows),
        summary.levels,
        text::number(summary.plane.0),
        text::number(summary.plane.1),
        summary.excited,
        summary.operators
    )
}

fn model(args: &args::Inspect) -> Result<()> {
    let model = Model::read(&args.file)?;
    let summary = hysteron::inspect_model(&model)?;
    if args.json.json {
        return print(&json!({"model": summary, "fit": model.fit}).to_string());
    }
    let (off, on) = summary.output;
    let mut lines = vec![
        format!(
            "{} levels from {} to {} ({} apart), {} operators",
            summary.levels,
            model.input.text(summary.plane.0),
            model.input.text(summary.plane.1),
            apart(summary.steps),
            summary.operators
        ),
        format!(
            "weights: {} not zero, {} below zero{}",
            summary.weights_not_zero,
            summary.weights_below_zero,
            if summary.weights_below_zero > 0 {
                " (no inverse)"
            } else {
                ""
            }
        ),
        format!(
            "{}: {} with all off, {} with all on",
            model.output.name,
            model.output.text(off),
            model.output.text(on)
        ),
        format!(
            "widest loop: {} at {}",
            model.output.text(summary.widest_loop),
            model.input.text(summary.widest_loop_at)
        ),
    ];
    if let Some(fit) = &model.fit {
        lines.push(format!(
            "{} {} {}samples{}: RMSE {} ({:.2} % of the range), largest error {}",
            match fit.other.get("adapted").map(|how| &how["method"]) {
                Some(method) => format!("adapted ({}) over", method.as_str().unwrap_or("unknown")),
                None => "fitted to".into(),
            },
            fit.samples,
            if fit.simulated { "simulated " } else { "" },
            fit.file
                .as_ref()
                .map_or(String::new(), |file| format!(" of {file}")),
            model.output.text(fit.rmse),
            fit.nrmse_percent,
            model.output.text(fit.max_abs)
        ));
        lines.extend(text::confidence(fit, &model));
    }
    if let Some(confidence) = &summary.confidence {
        lines.push(least_certain(confidence, &model));
    }
    if let Some(seconds) = summary.delay_s {
        let samples = model.delay().samples();
        lines.push(format!(
            "dead time {} s ({} of the recording)",
            text::number(seconds),
            hysteron::counted(samples, "sample")
        ));
    }
    if let Some(load) = &summary.load {
        let unit = load
            .unit
            .as_ref()
            .map_or(String::new(), |unit| format!(" {unit}"));
        lines.push(format!(
            "weights of order {} in the {}, {} to {}{unit}",
            load.order,
            load.name,
            text::number(load.min),
            text::number(load.max),
        ));
    }
    lines.extend(summary.stages.iter().map(stage));
    if let Some(validation) = model.fit.as_ref().and_then(|fit| fit.validation.as_ref()) {
        lines.push(left_out(validation, &model));
    }
    print(&lines.join("\n"))
}

/// A distance, or from what to what it goes.
fn apart((least, most): (f64, f64)) -> String {
    match [least, most].map(text::number) {
        [one, other] if one == other => one,
        [least, most] => format!("{least} to {most}"),
    }
}

/// A stage with its constants.
fn stage(stage: &StageSummary) -> String {
    let rows = stage
        .constants
        .iter()
        .map(|constant| vec![format!("  {}", constant.name), text::constant(constant)]);
    let rows: Vec<_> = rows.collect();
    format!("{}: {}\n{}", stage.name, stage.about, text::table(&rows))
}

fn least_certain(confidence: &ConfidenceSummary, model: &Model) -> String {
    let uncertain = |w: &Uncertain| {
        let (weight, error) = (text::number(w.weight), text::number(w.standard_error));
        vec![
            format!("  i = {}, j = {}", w.i, w.j),
            format!("{weight} ± {error}"),
        ]
    };
    let rows: Vec<_> = confidence.least_certain.iter().map(uncertain).collect();
    let unit = model.output.unit.as_ref();
    format!(
        "least certain weights{}, ± one standard error of {} replicates; offset ± {}\n{}",
        unit.map_or(String::new(), |unit| format!(" in {unit}")),
        confidence.replicates,
        model.output.text(confidence.offset_error),
        text::table(&rows)
    )
}

/// The cross-validation as a table of levels and smoothness.
fn left_out(validation: &Validation, model: &Model) -> String {
    let (levels, smooth, errors) = validation.table();
    let mut rows = vec![vec!["  smoothness along".to_owned()]];
    rows[0].extend(levels.iter().map(|levels| format!("{levels} levels")));
    for (n, smooth) in smooth.iter().enumerate() {
        let error = |row: &Vec<Option<f64>>| row[n].map_or("–".into(), text::number);
        let name = vec![format!("  {smooth:e}")];
        rows.push(name.into_iter().chain(errors.iter().map(error)).collect());
    }
    let unit = model.output.unit.as_ref();
    let parts = if validation.whole_branches {
        ""
    } else {
        "parts of "
    };
    let on = match validation.criterion {
        Criterion::LeftOut => format!("on {parts}branches left out, {} folds", validation.folds),
        Criterion::Evidence => "of the fits (the evidence chose)".to_owned(),
    };
    let unit = unit.map_or(String::new(), |unit| format!(" in {unit}"));
    format!("RMSE{unit} {on}\n{}", text::table(&rows))
}

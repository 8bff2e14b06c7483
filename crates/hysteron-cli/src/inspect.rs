//! `hysteron inspect`

use crate::{Result, args, print, recording, text};
use hysteron::{Columns, Model, Plane, RecordingSummary, TableReader};
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
    let mut table = TableReader::open(&args.file)?;
    let names = table.header().to_vec();
    let columns: Vec<_> = table.columns().collect();
    let empty = (f64::INFINITY, f64::NEG_INFINITY, 0_u64);
    let mut ranges = vec![empty; columns.len()];
    let mut rows = 0_u64;
    while table.advance()? {
        rows += 1;
        for (range, &column) in ranges.iter_mut().zip(&columns) {
            match table.value(column) {
                Some(value) => *range = (range.0.min(value), range.1.max(value), range.2),
                None => range.2 += 1,
            }
        }
    }
    if args.json.json {
        let columns: Vec<_> = names
            .iter()
            .zip(&ranges)
            .map(|(name, &(min, max, bad))| {
                // A column without any number has no range; JSON has no infinity.
                let range = (min <= max).then_some((min, max));
                json!({"name": name, "min": range.map(|r| r.0), "max": range.map(|r| r.1), "not_numbers": bad})
            })
            .collect();
        return print(&json!({"rows": rows, "columns": columns}).to_string());
    }
    let mut lines = vec![text::row(["column", "smallest", "largest", "not numbers"])];
    for (name, &(min, max, bad)) in names.iter().zip(&ranges) {
        let [min, max] = [min, max].map(|v| {
            if v.is_finite() {
                text::number(v)
            } else {
                "–".into()
            }
        });
        lines.push(vec![name.clone(), min, max, bad.to_string()]);
    }
    print(&format!(
        "{}: {rows} rows\n{}\nName --input and --output for reversals and excitation.",
        args.file.display(),
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
    let recording = recording::read(&args.file, columns, &args.repair)?;
    let plane = match args.range {
        Some((min, max)) => Plane::new(min, max, args.levels)?,
        None => hysteron::plane_of(&recording, args.levels)?,
    };
    let summary = hysteron::inspect_recording(&recording, plane)?;
    if args.json.json {
        return print(&json!(summary).to_string());
    }
    print(&recording_text(&summary))
}

fn recording_text(summary: &RecordingSummary) -> String {
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
        format!(
            "time {} to {} s, median step {} s, longest {} s (before sample {}), {} gaps, {} repeated\n",
            text::number(time.start),
            text::number(time.end),
            text::number(time.median_step),
            text::number(time.longest_step),
            time.longest_step_before_sample,
            time.gaps,
            time.repeated
        )
    });
    format!(
        "{} samples\n{}\n{time}plane of {} levels from {} to {}: {} of {} operators excited",
        summary.samples,
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
            "{} levels from {} to {} (step {}), {} operators",
            summary.levels,
            text::with_unit(summary.plane.0, &model.input),
            text::with_unit(summary.plane.1, &model.input),
            text::number(summary.step),
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
            text::with_unit(off, &model.output),
            text::with_unit(on, &model.output)
        ),
        format!(
            "widest loop: {} at {}",
            text::with_unit(summary.widest_loop, &model.output),
            text::with_unit(summary.widest_loop_at, &model.input)
        ),
    ];
    if let Some(fit) = &model.fit {
        lines.push(format!(
            "fitted to {} {}samples{}: RMSE {} ({:.2} % of the range), largest error {}",
            fit.samples,
            if fit.simulated { "simulated " } else { "" },
            fit.file
                .as_ref()
                .map_or(String::new(), |file| format!(" of {file}")),
            text::with_unit(fit.rmse, &model.output),
            fit.nrmse_percent,
            text::with_unit(fit.max_abs, &model.output)
        ));
    }
    print(&lines.join("\n"))
}

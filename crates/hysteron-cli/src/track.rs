//! `hysteron track`

use crate::made::Typed;
use crate::terminal::{Result, print, say};
use crate::{args, progress, text};
use hysteron::{Progress, Quantity};
use hysteron_files::{AtomicFile, AtomicFolder, Own};
use hysteron_sim::joint::Tuned;
use hysteron_sim::track::{Comparison, Kind, Scenario, track};
use serde_json::json;
use std::path::Path;

pub(crate) fn run(args: &args::Track) -> Result<()> {
    if args.list {
        return print(&Scenario::names().join("\n"));
    }
    let name = args.scenario.as_deref().unwrap_or_default();
    if args.show {
        let text = Scenario::text(name).ok_or_else(|| {
            let names = Scenario::names().join(", ");
            format!("`{name}` is no built-in scenario: {names}")
        })?;
        return print(text.trim_end());
    }
    let mut scenario = Scenario::load(name)?;
    if let Some(seeds) = args.seeds {
        scenario.seeds = seeds;
    }
    let inputs = [Path::new(name)];
    let folder = args.out.as_ref().map(|out| {
        let folder = AtomicFolder::create(args.force.target(out, &inputs), None)?;
        // Before the runs, which can take minutes.
        folder.claim(names(&scenario))?;
        Ok::<_, hysteron::Error>(folder)
    });
    let folder = folder.transpose()?;
    let bar = progress::stages();
    let report = |stage: &'static str, done: f64| {
        progress::stage(&bar, stage, done);
        Ok(())
    };
    let comparison = track(&scenario, Progress::new(&report));
    bar.finish_and_clear();
    let comparison = comparison?;
    if let Some(folder) = folder {
        write(&scenario, &comparison, folder)?;
    }
    if args.json.json {
        return print(&to_json(&scenario, &comparison).to_string());
    }
    print(&to_text(&scenario, &comparison))
}

const SCORES: &str = "scores.csv";
const MODEL: &str = "model.json";
const SUMMARY: &str = "summary.json";

fn trace_name(controller: Kind) -> String {
    format!("{}.csv", controller.name())
}

/// The files of a comparison. Of its report only the page is named.
fn names(scenario: &Scenario) -> Vec<String> {
    let fixed = [SCORES, MODEL, SUMMARY, "report/index.html"].map(String::from);
    let traces = scenario.controllers.iter().copied().map(trace_name);
    fixed.into_iter().chain(traces).collect()
}

fn write(scenario: &Scenario, comparison: &Comparison, mut folder: AtomicFolder) -> Result<()> {
    folder.file(SCORES, |path| comparison.write_scores(path))?;
    folder.file(MODEL, |path| comparison.model.write(path))?;
    for (kind, trace) in comparison.controllers.iter().zip(&comparison.traces) {
        folder.file(trace_name(*kind), |path| trace.write_csv(path))?;
    }
    let summary = to_json(scenario, comparison).to_string();
    folder.file(SUMMARY, |path| {
        AtomicFile::create(path, Own::SAME_BYTES)?.commit_with(summary.as_bytes())
    })?;
    let within = Path::new("report");
    let paths = hysteron_report::write_comparison(
        scenario,
        comparison,
        &mut folder,
        within,
        Typed::now()?.made(),
    )?;
    folder.commit()?;
    say(format_args!("the report is {}", paths[0].display()));
    Ok(())
}

fn to_json(scenario: &Scenario, comparison: &Comparison) -> serde_json::Value {
    json!({
        "title": scenario.title,
        "simulated": true,
        "seeds": scenario.seeds,
        "pid": comparison.gains,
        "inner_loop": comparison.inner_gains,
        "tuned": tuned(comparison).map(|(kind, tuned)| json!({
            "controller": kind.words(), "name": kind.name(),
            "pid": tuned.gains, "margin": tuned.margin,
        })).collect::<Vec<_>>(),
        "medians": comparison.medians(),
        "ratios": comparison.ratios(),
    })
}

fn to_text(scenario: &Scenario, comparison: &Comparison) -> String {
    let [_, _, output] = scenario.plant.quantities();
    let mut parts = vec![format!(
        "{}\nmedians over {} run(s) on a simulated plant",
        scenario.title, scenario.seeds
    )];
    let medians = comparison.medians();
    let of_windows = medians.chunks(comparison.controllers.len());
    for (window, medians) in comparison.windows.iter().zip(of_windows) {
        let head = format!("{} ({} to {} s)", window.name, window.from_s, window.to_s);
        let mut rows = vec![text::row([
            head.as_str(),
            "RMSE",
            "largest",
            "prediction",
            "frozen",
            "lag",
            "drive travel",
            "saturated",
        ])];
        rows.extend(medians.iter().map(|median| {
            let score = &median.score;
            let second = Quantity::with_unit("lag", "s");
            vec![
                median.controller.to_owned(),
                number(score.rmse, &output),
                number(score.max_abs, &output),
                number(score.prediction_rmse, &output),
                number(score.frozen_rmse, &output),
                number(score.lag_s, &second),
                format!("{:.1} %", 100.0 * score.drive_travel),
                format!("{:.0} %", 100.0 * score.saturated),
            ]
        }));
        parts.push(text::table(&rows));
    }
    let ratios = comparison.ratios();
    if !ratios.is_empty() {
        let mut rows = vec![text::row([
            "ratios, medians over the runs",
            "RMSE",
            "prediction",
        ])];
        rows.extend(ratios.iter().map(|ratio| {
            vec![
                format!(
                    "{}: {} / {}",
                    ratio.window, ratio.controller, ratio.compared_with
                ),
                text::number(ratio.rmse),
                match ratio.prediction_rmse.is_nan() {
                    true => "–".into(),
                    false => text::number(ratio.prediction_rmse),
                },
            ]
        }));
        parts.push(text::table(&rows));
    }
    if let Some(gains) = &comparison.gains {
        parts.push(format!(
            "PID: gain {}, integral time {} s, derivative time {} s",
            text::number(gains.gain),
            text::number(gains.integral_s),
            text::number(gains.derivative_s)
        ));
    }
    parts.extend(tuned(comparison).map(|(kind, tuned)| {
        format!(
            "{}: gain {}, integral time {} s by the model of the first run; margin {}",
            kind.words(),
            text::number(tuned.gains.gain),
            text::number(tuned.gains.integral_s),
            text::number(tuned.margin)
        )
    }));
    parts.join("\n\n")
}

/// The gains that come from the model, of the first run.
fn tuned(comparison: &Comparison) -> impl Iterator<Item = (Kind, Tuned)> + '_ {
    let each = comparison.controllers.iter().zip(&comparison.tuned);
    each.filter_map(|(kind, runs)| Some((*kind, (*runs.first()?)?)))
}

fn number(value: f64, quantity: &Quantity) -> String {
    match value.is_nan() {
        true => "–".into(),
        false => quantity.text(value),
    }
}

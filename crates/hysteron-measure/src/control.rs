//! Makes docs/measured/control.md: controllers compared on the built-in scenarios, medians over
//! their seeds.
//!
//! ```text
//! cargo run --release -p hysteron-measure -- control > docs/measured/control.md
//! ```

use crate::result::Result;
use hysteron::Progress;
use hysteron_sim::track::{Comparison, Scenario, Score, Tuning, track};

const SCENARIOS: [&str; 6] = [
    "load-step",
    "load-step-preisach",
    "sine",
    "staircase",
    "drift",
    "faults",
];

pub(crate) fn run(_: &[String]) -> Result<()> {
    print!("{}", include_str!("text/control.md"));
    for name in SCENARIOS {
        let scenario = Scenario::load(name)?;
        eprintln!("{name} …");
        let comparison = track(&scenario, Progress::NONE)?;
        println!("\n## `{name}`: {}\n", scenario.title);
        table(&scenario, &comparison);
    }
    print!("\n{}", include_str!("text/control-step.md"));
    for name in &SCENARIOS[..2] {
        let mut scenario = Scenario::load(name)?;
        scenario.shared.tuning = Tuning::Step;
        eprintln!("{name}, tuned by a step test …");
        let comparison = track(&scenario, Progress::NONE)?;
        println!("\n### `{name}`, PID tuned by a step test\n");
        table(&scenario, &comparison);
    }
    Ok(())
}

fn table(scenario: &Scenario, comparison: &Comparison) {
    let [_, _, output] = scenario.plant.quantities();
    let unit = output.unit.unwrap_or_default();
    if let Some(gains) = comparison.gains {
        println!(
            "PID: gain {:.3}, integral time {:.3} s. {} runs.\n",
            gains.gain, gains.integral_s, scenario.seeds
        );
    }
    println!(
        "| | tracking RMSE, {unit} | largest | prediction RMSE | frozen | lag after reversals, s | \
         drive travel, % |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    let medians = comparison.medians();
    let number = |value: f64| match value.is_nan() {
        true => "–".to_owned(),
        false => format!("{value:.3}"),
    };
    let of_windows = medians.chunks(comparison.controllers.len());
    for (window, medians) in comparison.windows.iter().zip(of_windows) {
        println!(
            "| **{}** ({} to {} s) | | | | | | |",
            window.name, window.from_s, window.to_s
        );
        for median in medians {
            let Score {
                rmse,
                max_abs,
                prediction_rmse,
                frozen_rmse,
                lag_s,
                drive_travel,
                ..
            } = median.score;
            let cells = [
                rmse,
                max_abs,
                prediction_rmse,
                frozen_rmse,
                lag_s,
                100.0 * drive_travel,
            ];
            println!(
                "| {} | {} |",
                median.controller,
                cells.map(number).join(" | ")
            );
        }
    }
    println!("\n| Ratio, median over the runs | tracking RMSE | prediction RMSE |");
    println!("| --- | --- | --- |");
    for ratio in comparison.ratios() {
        println!(
            "| {}: {} / {} | {} | {} |",
            ratio.window,
            ratio.controller,
            ratio.compared_with,
            number(ratio.rmse),
            number(ratio.prediction_rmse)
        );
    }
}

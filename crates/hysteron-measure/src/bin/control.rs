//! Makes docs/control.md: controllers compared on the built-in scenarios, medians over their seeds.
//!
//! ```text
//! cargo run --release -p hysteron --example control > docs/control.md
//! ```

use hysteron::track::{Comparison, Scenario, Score, Tuning, track};

const SCENARIOS: [&str; 6] = [
    "load-step",
    "load-step-preisach",
    "sine",
    "staircase",
    "drift",
    "faults",
];

fn main() -> hysteron::Result<()> {
    println!("{HEAD}");
    for name in SCENARIOS {
        let scenario = Scenario::load(name)?;
        eprintln!("{name} …");
        let comparison = track(&scenario, &|_, _| Ok(()))?;
        println!("\n## `{name}`: {}\n", scenario.title);
        table(&scenario, &comparison);
    }
    println!("{STEP}");
    for name in &SCENARIOS[..2] {
        let mut scenario = Scenario::load(name)?;
        scenario.shared.tuning = Tuning::Step;
        eprintln!("{name}, tuned by a step test …");
        let comparison = track(&scenario, &|_, _| Ok(()))?;
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
        "| | tracking RMSE, {unit} | largest | prediction RMSE | frozen | lag after reversals, s | drive travel, % |"
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

const HEAD: &str = "# Controllers compared

All plants here are **simulated**; what they are made of is in `crates/hysteron/src/plant/`. Each number is the median over
the scenario's runs, which differ in the noise of the sensors and in the recording that the model is identified from. This page is made by
`cargo run --release -p hysteron --example control > docs/control.md`; a single scenario with its report by `hysteron track NAME -o DIR`.

- **Controllers.** PID; the inverse model alone; both together; and the same with an inverse that adapts. The inverse *holds* the input
  while the reference rests, or *anticipates* the next reversal and crosses the dead band at once.
- **One rule for all.** Every controller with a PID has the same gains, from one test on the same plant: a relay in place of the controller
  (Åström & Hägglund 1984), gains by Tyreus & Luyben 1992. The spring's loop around the temperature is tuned by a step test and SIMC
  (Skogestad 2003) and is the same in all. The last section shows what a step test on one branch gives instead.
- **Errors** are those of the true output, not of the noisy reading. *settled*: from `settle_s` after a disturbance on (two minutes on
  the spring). What the jump of the load itself leaves is the same whoever controls.
- **Prediction**: what the model in the loop expected of each sample before it learned from it. **Frozen**: the same, with the weights
  as they were when the window began and nothing learned since.
- **Lag**: from when the reference has gone back by a twentieth of its range after a reversal until the output has, each from its own
  extreme since the reference left its rest. Below zero the output is ahead.
- **Drive travel**: mean change of the drive from sample to sample, in % of its range.";

const STEP: &str = "
## Tuned by a step test instead

A small step on the rising branch knows nothing of the dead band. SIMC then gives less proportional and far more integral action, and on this
spring that is the better PID: alone it tracks better than with the relay's gains, and after the load step better than all others here.
What a compensator gains is smaller beside it. Before the step the inverse takes a quarter to two fifths off its error on the spring and two
thirds on the relays; after it the adaptive inverse errs half to three quarters as much as the fixed one. The model's predictions
gain as much as before.";

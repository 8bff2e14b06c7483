//! The report of a comparison that `hysteron_sim` made of a scenario.

use crate::error::ReportError;
use crate::made::Made;
use crate::report::{Report, Shown};
use crate::track::{NamedTrace, TrackTable, Tracking};
use hysteron::Quantity;
use hysteron_files::AtomicFolder;
use hysteron_sim::track::{Comparison, Median, Scenario};
use std::path::{Path, PathBuf};

/// Writes the report of `comparison`, which `scenario` gave, into the folder `within` another one.
/// See
/// [`Report::write_into`].
///
/// # Errors
///
/// As [`Report::write`].
pub fn write_comparison(
    scenario: &Scenario,
    comparison: &Comparison,
    folder: &mut AtomicFolder,
    within: &Path,
    made: Made<'_>,
) -> Result<Vec<PathBuf>, ReportError> {
    let [drive, input, output] = scenario.plant.quantities();
    let runs = comparison.controllers.iter().zip(&comparison.traces);
    let runs: Vec<NamedTrace<'_>> = runs
        .map(|(kind, trace)| NamedTrace {
            name: kind.words(),
            trace,
        })
        .collect();
    let events = scenario.disturbance.iter();
    let events: Vec<(f64, String)> = events.map(|event| (event.at_s, event.words())).collect();
    let table = table(scenario, comparison, &output);
    let tracking = Tracking {
        simulated: true,
        input,
        output,
        drive,
        runs: &runs,
        events: &events,
        table: &table,
        plane: comparison.model.plane(),
    };
    Report {
        title: &scenario.title,
        shown: Shown::Tracking(&tracking),
        made,
    }
    .write_into(folder, within)
}

/// Tracking errors in every window; prediction error and lag in the first and the last.
fn table(scenario: &Scenario, comparison: &Comparison, output: &Quantity) -> TrackTable {
    let medians = comparison.medians();
    let names: Vec<&str> = comparison.windows.iter().map(|w| w.name.as_str()).collect();
    let ends = [0, names.len() - 1];
    let unit = match &output.unit {
        Some(unit) => format!(" [{unit}]"),
        None => String::new(),
    };
    let mut headers: Vec<String> = names.iter().map(|w| format!("RMSE {w}{unit}")).collect();
    headers.extend(ends.map(|w| format!("prediction RMSE {}{unit}", names[w])));
    headers.extend(ends.map(|w| format!("lag after reversals {} [s]", names[w])));
    let row = |k: usize| {
        let at = |w: usize| &medians[w * comparison.controllers.len() + k];
        let number = |w: usize, of: fn(&Median) -> f64| Some(of(at(w))).filter(|v| !v.is_nan());
        let mut cells: Vec<_> = (0..names.len())
            .map(|w| number(w, |m| m.score.rmse))
            .collect();
        cells.extend(ends.map(|w| number(w, |m| m.score.prediction_rmse)));
        cells.extend(ends.map(|w| number(w, |m| m.score.lag_s)));
        (comparison.controllers[k].words().to_owned(), cells)
    };
    let notes = vec![format!(
        "Medians over {} runs with different noise, each with a model identified from a recording \
         of its own; the curves are those of the first. Lag: from when the reference has gone back \
         by a twentieth of its range after a reversal until the output has. Ratios: medians over \
         the runs.",
        scenario.seeds
    )];
    let known = |value: f64| Some(value).filter(|value| !value.is_nan());
    let ratios = comparison.ratios();
    let ratios = ratios.iter().map(|ratio| {
        let name = format!(
            "{}: {} / {}",
            ratio.window, ratio.controller, ratio.compared_with
        );
        (name, vec![known(ratio.rmse), known(ratio.prediction_rmse)])
    });
    TrackTable {
        headers,
        rows: (0..comparison.controllers.len()).map(row).collect(),
        notes,
        ratio_headers: vec!["tracking RMSE".into(), "prediction RMSE".into()],
        ratios: ratios.collect(),
    }
}

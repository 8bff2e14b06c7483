//! Runs the scenario `wire` of `track` with both ways to tune the PID, and prints
//! `docs/measured/wire.md`:
//! `cargo run --release -p hysteron-measure -- wire`

use crate::result::Result;
use hysteron::Progress;
use hysteron_sim::track::{Comparison, Kind, Scenario, Tuning, track};

const TUNINGS: [(&str, Tuning); 2] = [("relay test", Tuning::Relay), ("step test", Tuning::Step)];

pub(crate) fn run(_: &[String]) -> Result<()> {
    let mut scenario = Scenario::load("wire")?;
    let mut rows = Vec::new();
    let mut last = None;
    for (rule, tuning) in TUNINGS {
        scenario.shared.tuning = tuning;
        let comparison = track(&scenario, Progress::NONE)?;
        let named = [
            ("drive from the model".to_owned(), Kind::InverseAnticipate),
            (
                "drive from the adaptive model".to_owned(),
                Kind::AdaptiveAnticipate,
            ),
            (format!("PID, {rule}"), Kind::Pid),
            (format!("both, PID by {rule}"), Kind::InversePidAnticipate),
            (
                format!("both, adaptive, PID by {rule}"),
                Kind::AdaptivePidAnticipate,
            ),
        ];
        // Without a PID there is nothing to tune.
        let once = if last.is_some() { 2 } else { 0 };
        for (name, kind) in named.into_iter().skip(once) {
            rows.push(row(&name, kind, &comparison));
        }
        last = Some(comparison);
    }
    let model = last.ok_or("no rule to tune by")?.model;
    let body = model.thermal.ok_or("a body was asked for")?;
    let error = model.fit.as_ref().map_or(f64::NAN, |fit| fit.nrmse_percent);
    print!("{}", include_str!("text/wire.md"));
    println!(
        "The model is fitted to ramps and steps of the duty: {error:.1} % of the range, time constants\n\
         {:.2} s and {:.2} s (of the first run).\n\n\
         Tracking error, RMS in mm, of a stroke of 4 mm, median of {} runs: as fitted, in a room that is\n\
         8 K warmer, and there with a load of 1.5 N more. Twenty seconds after the start and after each\n\
         change do not count.\n",
        body.tau_heating, body.tau_cooling, scenario.seeds
    );
    println!("| controller | as fitted | warmer room | more load |");
    println!("| --- | ---: | ---: | ---: |");
    for row in rows {
        println!("{row}");
    }
    Ok(())
}

/// The errors of a controller in the windows in which the loop has settled.
fn row(name: &str, kind: Kind, comparison: &Comparison) -> String {
    let controllers = comparison.controllers.iter();
    let k = controllers.take_while(|other| **other != kind).count();
    let of_windows = comparison.medians();
    let each = comparison.controllers.len();
    let settled = comparison.windows.iter().enumerate();
    let settled = settled.filter(|(_, window)| window.settled);
    let cells = settled.map(|(w, _)| format!(" {:.3} |", of_windows[w * each + k].score.rmse));
    format!("| {name} |{}", cells.collect::<String>())
}

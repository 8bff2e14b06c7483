//! Makes docs/measured/control.md: controllers compared on the built-in scenarios, medians over
//! their seeds.
//!
//! ```text
//! cargo run --release -p hysteron-measure -- control > docs/measured/control.md
//! ```

use crate::result::Result;
use hysteron::Progress;
use hysteron_sim::track::{Comparison, Kind, Median, Scenario, Tuning, track};

/// With an adaptive one that is as good as the fixed one up to this factor, nothing is lost.
const LOST: f64 = 1.1;

const ONE_OF_EACH: [Kind; 5] = [
    Kind::Pid,
    Kind::InverseAnticipate,
    Kind::AdaptiveAnticipate,
    Kind::InversePidAnticipate,
    Kind::AdaptivePidAnticipate,
];

pub(crate) fn run(names: &[String]) -> Result<()> {
    for name in names {
        let mut scenario = Scenario::load(name)?;
        scenario.controllers = ONE_OF_EACH.to_vec();
        let t = std::time::Instant::now();
        let comparison = track(&scenario, Progress::NONE)?;
        eprintln!("{name} {:?}", t.elapsed());
        let medians = comparison.medians();
        println!(
            "{name} {:?} fit {:?}",
            comparison.gains,
            comparison.model.fit.as_ref().map(|f| f.nrmse_percent)
        );
        println!(
            "{:?} {:?} {:?}",
            comparison.model.thermal,
            comparison.model.delay(),
            comparison.model.output_range()
        );
        for (w, window) in comparison.windows.iter().enumerate() {
            print!("{:30}", window.name);
            for k in 0..comparison.controllers.len() {
                let m: &Median = &medians[w * comparison.controllers.len() + k];
                print!(" {:8.4} ({:.2})", m.score.rmse, m.score.saturated);
            }
            println!();
        }
    }
    let _ = (LOST, Tuning::Relay, |_: Comparison| ());
    Ok(())
}

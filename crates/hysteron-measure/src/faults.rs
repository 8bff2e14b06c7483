//! What faults of a recording do to a model. Prints `docs/measured/faults.md`:
//! `cargo run --release -p hysteron-measure -- faults`

#[path = "../../hysteron/tests/faulty/mod.rs"]
mod faulty;

use crate::result::Result;
use faulty::advised::{Came, advised, allowed, fit, plain, put};
use faulty::clean;
use faulty::fault::{FAULTS, Fault};
use hysteron::Recording;

/// Recordings with each fault.
const SEEDS: u64 = 8;

pub(crate) fn run(_: &[String]) -> Result<()> {
    print!("{}", include_str!("text/faults.md"));
    let pairs = [("spring", clean::spring()?), ("plays", clean::plays(1)?)];
    for (name, pair) in &pairs {
        let clean = plain(&pair[0], &pair[1], &fit())?;
        println!("\n## {name}\n\nThe clean recording: {clean:.2} %.\n");
        println!("| fault | as it is (%) | advised (%) | of what is allowed | refused |");
        println!("| --- | ---: | ---: | ---: | --- |");
        for fault in FAULTS {
            eprintln!("{name}: {}", fault.name());
            println!("{}", row(fault, pair, clean)?);
        }
    }
    Ok(())
}

/// The largest errors over the seeds.
fn row(fault: Fault, pair: &[Recording; 2], clean: f64) -> Result<String> {
    let (mut raw, mut with, mut share, mut refused) = (0.0_f64, None::<f64>, None::<f64>, 0);
    let larger = |most: Option<f64>, value: f64| Some(most.map_or(value, |most| most.max(value)));
    for seed in 0..SEEDS {
        let dirty = put(fault, &pair[0], seed);
        raw = raw.max(plain(&dirty, &pair[1], &fit()).unwrap_or(f64::INFINITY));
        match advised(&dirty, &pair[1], &fit()) {
            Ok(Came::To(error)) => {
                with = larger(with, error);
                share = larger(share, error / allowed(fault, pair, clean, seed)?);
            }
            Ok(Came::Refused(why)) => {
                eprintln!("  {why}");
                refused += 1;
            }
            Err(error) => {
                eprintln!("  {error}");
                refused += 1;
            }
        }
    }
    let number = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.2}"));
    Ok(format!(
        "| {} | {} | {} | {} | {refused} of {SEEDS} |",
        fault.name(),
        number(Some(raw).filter(|raw| raw.is_finite())),
        number(with),
        number(share),
    ))
}

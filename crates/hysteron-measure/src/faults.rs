//! What faults of a recording do to a model. Prints `docs/faults.md`:
//! `cargo run --release -p hysteron-measure -- faults`

mod advised;
mod clean;
mod fault;

use crate::result::Result;
use advised::{Came, advised, plain};
use fault::{FAULTS, Fault};
use hysteron::{Fit, Recording};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// Recordings with each fault.
const SEEDS: u64 = 3;

pub(crate) fn run(_: &[String]) -> Result<()> {
    print!("{}", include_str!("text/faults.md"));
    let fit = Fit::new().levels(20).smooth(1e-8).bootstrap(0);
    let pairs = [("spring", clean::spring()?), ("plays", clean::plays(1)?)];
    for (name, [first, second]) in &pairs {
        let clean = plain(first, second, &fit)?;
        println!("\n## {name}\n\nThe clean recording: {clean:.2} %.\n");
        println!("| fault | as it is (%) | advised (%) | times the clean one | refused |");
        println!("| --- | ---: | ---: | ---: | --- |");
        for fault in FAULTS {
            eprintln!("{name}: {}", fault.name());
            println!("{}", row(fault, first, second, &fit, clean));
        }
    }
    Ok(())
}

/// The largest errors over the seeds.
fn row(fault: Fault, first: &Recording, second: &Recording, fit: &Fit<'_>, clean: f64) -> String {
    let (mut raw, mut with, mut refused) = (0.0_f64, None::<f64>, 0);
    for seed in 0..SEEDS {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let dirty = fault.put_into(first, &mut rng);
        match plain(&dirty, second, fit) {
            Ok(error) => raw = raw.max(error),
            Err(_) => raw = f64::INFINITY,
        }
        match advised(&dirty, second, fit) {
            Ok(Came::To(error)) => with = Some(with.map_or(error, |most| most.max(error))),
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
    let raw = Some(raw).filter(|raw| raw.is_finite());
    format!(
        "| {} | {} | {} | {} | {refused} of {SEEDS} |",
        fault.name(),
        number(raw),
        number(with),
        number(with.map(|with| with / clean)),
    )
}

//! Compares designed profiles with other experiments at the same rates, and prints
//! `docs/measured/profiles.md`: `cargo run --release -p hysteron-measure -- profiles`

use crate::result::Result;
use hysteron::{DesignOptions, Excitation, Operator, Plane, Rates, design, excitation, ramps};
use hysteron_sim::rig::{Experiment, LEVELS, RANGE_DEGC};

/// Typical of a wire that is heated by a current and cools in still air, °C/s.
const RATES: Rates = Rates {
    heating: 4.0,
    cooling: 1.0,
};

/// Duration in minutes, and how many operators are determined.
struct Outcome {
    minutes: f64,
    determined: usize,
}

fn outcome(plane: Plane, turns: &[f64]) -> Result<Outcome> {
    let step = plane.step() / RATES.heating / 10.0;
    let (time, input) = ramps(turns, RATES, step);
    let classes = excitation(&[&input], plane, Operator::Mkp)?;
    Ok(Outcome {
        minutes: time.last().copied().unwrap_or_default() / 60.0,
        determined: classes
            .iter()
            .filter(|class| **class == Excitation::Determined)
            .count(),
    })
}

pub(crate) fn run(_: &[String]) -> Result<()> {
    print!("{}", include_str!("text/profiles.md"));
    println!(
        "| K | operators N | profile | duration, min | of the spiral's | operators determined | of \
         N |"
    );
    println!("| ---: | ---: | --- | ---: | ---: | ---: | ---: |");
    let (min, max) = RANGE_DEGC;
    for levels in [LEVELS / 2, LEVELS, 2 * LEVELS] {
        let plane = Plane::new(min, max, levels)?;
        let spiral = design(&DesignOptions::new(plane, RATES), &[])?;
        let whole = spiral.duration_s();
        let spiral_outcome = Outcome {
            minutes: whole / 60.0,
            determined: spiral.count(Excitation::Determined),
        };
        // First-order reversal curves: up to each level, and all the way down.
        let forc: Vec<f64> = (1..=levels)
            .rev()
            .flat_map(|p| [plane.bottom(), plane.level(p)])
            .chain([plane.bottom()])
            .collect();
        let chapter: Vec<f64> = [25.0]
            .into_iter()
            .chain(Experiment::default().targets_degc)
            .collect();
        let mut rows = vec![
            ("spiral", spiral_outcome),
            ("first-order reversal curves", outcome(plane, &forc)?),
            ("like the chapter's", outcome(plane, &chapter)?),
        ];
        for (name, part) in [
            ("spiral, 3/4 of its time", 0.75),
            ("spiral, half of its time", 0.5),
        ] {
            let options = DesignOptions {
                budget_s: Some(part * whole),
                ..DesignOptions::new(plane, RATES)
            };
            let some = design(&options, &[])?;
            let row = Outcome {
                minutes: some.duration_s() / 60.0,
                determined: some.count(Excitation::Determined),
            };
            rows.push((name, row));
        }
        for (name, row) in rows {
            println!(
                "| {levels} | {} | {name} | {:.1} | {:.2} | {} | {:.0} % |",
                plane.operators(),
                row.minutes,
                row.minutes * 60.0 / whole,
                row.determined,
                100.0 * row.determined as f64 / plane.operators() as f64,
            );
        }
    }
    Ok(())
}

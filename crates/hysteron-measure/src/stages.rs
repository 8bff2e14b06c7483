//! Measures the stages of a model on recordings, and prints `docs/measured/stages.md`:
//! `cargo run --release -p hysteron-measure -- stages ../shared/data`

use crate::judged::{error, options, read};
use crate::result::Result;
use crate::{another_day, folder, loads};
use hysteron::{Auto, Columns, Dynamics, Fit, Policy, Spacing, Start, Status, Surroundings};
use std::path::Path;

pub(crate) fn run(arguments: &[String]) -> Result<()> {
    let folder = folder::named(arguments)?;
    print!("{}", include_str!("text/stages.md"));
    loads::print(&folder)?;
    spacing(&folder)?;
    valve(&folder)?;
    ring(&folder)?;
    another_day::print(&folder)?;
    drive(&folder)
}

/// Sharp loops with equal and with chosen distances of the levels.
fn spacing(folder: &Path) -> Result<()> {
    println!("## Levels where the output moves\n");
    println!(
        "Error of the fit in percent of the range. The numbers of levels are those of the plane; `auto` is\n\
         `--spacing auto`.\n"
    );
    println!("| recording | 20 auto | 20 | 40 | 60 |");
    println!("| --- | ---: | ---: | ---: | ---: |");
    for name in [
        "bh_M130_27s_loop1",
        "bh_amorf_loop1",
        "bh_MnZn_ferrite_loop1",
    ] {
        let columns = Columns::new("H_A_per_m", "B_T");
        let recording = read(folder, &format!("{name}.csv"), columns)?;
        let run = |levels, spacing| -> Result<f64> {
            let model = Fit::from(options(levels))
                .spacing(spacing)
                .run(&recording)?;
            Ok(model.fit.map_or(f64::NAN, |fit| fit.nrmse_percent))
        };
        println!(
            "| {name} | {:.2} | {:.2} | {:.2} | {:.2} |",
            run(20, Spacing::Auto)?,
            run(20, Spacing::Uniform)?,
            run(40, Spacing::Uniform)?,
            run(60, Spacing::Uniform)?,
        );
    }
    println!();
    Ok(())
}

/// A valve at two frequencies, each predicted by a model of the other.
fn valve(folder: &Path) -> Result<()> {
    println!("## Creep and lag, from one frequency to another\n");
    println!(
        "A piezo valve with the same pattern at 20 and at 100 Hz, 20 levels, start unknown. Errors in\n\
         percent of the range: of the recording fitted, simulated from the start that the fit found, and of\n\
         the other one. `auto` takes a stage only where blocks of the recording fitted that were left out\n\
         say so.\n"
    );
    println!("| fitted | stages | found | fitted | other |");
    println!("| --- | --- | --- | ---: | ---: |");
    let columns = Columns {
        time: Some("time_s"),
        ..Columns::new("voltage_V", "position")
    };
    let recordings = [
        (20, read(folder, "valve_20Hz.csv", columns)?),
        (100, read(folder, "valve_100Hz.csv", columns)?),
    ];
    for (own, other) in [(0, 1), (1, 0)] {
        let (hertz, recording) = &recordings[own];
        let plain = Fit::from(options(20)).start(Start::Unknown);
        let fits = [
            ("none", plain.clone()),
            ("`--lag auto`", plain.clone().lag(Auto)),
            ("`--creep auto --lag auto`", plain.lag(Auto).creep(Auto)),
        ];
        for (name, fit) in fits {
            let model = fit.run(recording)?;
            let creep = model.creep();
            let terms = creep
                .iter()
                .map(|term| format!("{:.0} % in {:.3} s", 100.0 * term.coefficient, term.tau));
            let mut found: Vec<String> = terms.collect();
            if model.lag() > 0.0 {
                found.push(format!("lag {:.2} ms", 1000.0 * model.lag()));
            }
            println!(
                "| {hertz} Hz | {name} | {} | {:.2} | {:.2} |",
                if found.is_empty() {
                    "–".into()
                } else {
                    found.join(", ")
                },
                error(&model, recording, Start::Fitted)?,
                error(&model, &recordings[other].1, Start::Unknown)?,
            );
        }
    }
    println!();
    Ok(())
}

/// A valve that was shaken, and two sines of the same session, which do not excite its resonance.
fn ring(folder: &Path) -> Result<()> {
    println!("## A resonance, found on one recording and used on others\n");
    println!(
        "The valve with a pseudo-random input rings. Two slow sines of the same session do not show that:\n\
         their models are the same to the byte with and without `--dynamics auto`. Errors in percent of\n\
         the range, with a rest before each recording that explains its beginning. *Itself* is a fit to\n\
         the sine, which is not judged on what it did not see. The last row of both sines is a jump of 3 %,\n\
         which only a ring follows, and it decides this comparison: without that row the fits to the sines\n\
         themselves err 0.21 and 0.13 %, about half of what the ring leaves.\n"
    );
    println!("| predicted | without | ring | itself | ring found |");
    println!("| --- | ---: | ---: | ---: | --- |");
    let columns = Columns {
        time: Some("time_s"),
        ..Columns::new("voltage_V", "position")
    };
    let shaken = read(folder, "valve_prbn_1.csv", columns)?;
    let fit = || Fit::new().bootstrap(0);
    let still = fit().dynamics(Dynamics::Off).run(&shaken)?;
    let ringing = fit().run(&shaken)?;
    let constants = ringing.constants();
    let number = |name| constants.get(name).first().copied().unwrap_or(f64::NAN);
    for name in ["valve_prbn_1", "valve_sine100_1", "valve_sine50_1"] {
        let recording = read(folder, &format!("{name}.csv"), columns)?;
        let itself = fit().run(&recording)?;
        println!(
            "| {name} | {:.2} | {:.2} | {:.2} | {:.0} Hz, damping {:.3} |",
            error(&still, &recording, Start::Rest)?,
            error(&ringing, &recording, Start::Rest)?,
            error(&itself, &recording, Start::Rest)?,
            number("ring_frequency"),
            number("ring_damping"),
        );
    }
    println!();
    Ok(())
}

/// From a displacement to the drive, and back through the model.
fn drive(folder: &Path) -> Result<()> {
    println!("## From displacement to drive\n");
    println!(
        "A measured wire, duty to position, with a thermal body fitted to ramp and step. The measured\n\
         position is the target. The drives found go back through the model. *Met* is the share of samples\n\
         with status `ok`; the next column is their largest error, the last one the RMSE of all samples, in\n\
         percent of the range. A preview tells the drive what comes next; the drive stays within {:?}.\n",
        (0.0, 0.2)
    );
    println!("| reference | policy, preview | met | largest error | RMSE | drives |");
    println!("| --- | --- | ---: | ---: | ---: | --- |");
    let columns = Columns {
        time: Some("time_s"),
        ..Columns::new("duty", "position_m")
    };
    let recordings = [
        read(folder, "sma_baraghini_Ramp02.csv", columns)?,
        read(folder, "sma_baraghini_Step02.csv", columns)?,
    ];
    let model = Fit::from(options(20)).thermal(true).run(&recordings)?;
    for (name, recording) in ["ramp", "step"].into_iter().zip(&recordings) {
        for (policy, word) in [(Policy::Hold, "hold"), (Policy::Anticipate, "anticipate")] {
            for seconds in [0.0, 13.0] {
                let around = Surroundings::from_recording(&model, recording);
                let tolerance = match policy {
                    Policy::Hold => 0.0,
                    Policy::Anticipate => model.usual_tolerance(),
                };
                let found = model.inverse()?.previewed(
                    &mut model.start(),
                    &recording.output,
                    policy,
                    tolerance,
                    around,
                    seconds,
                )?;
                let drives: Vec<f64> = found.iter().map(|solution| solution.input).collect();
                let back = model.simulate_in(&drives, around)?;
                let (_, (low, high)) = recording.ranges();
                let errors = recording
                    .output
                    .iter()
                    .zip(&back)
                    .map(|(y, h)| (y - h).abs());
                let met = found.iter().zip(errors.clone());
                let met: Vec<f64> = met
                    .filter(|(solution, _)| solution.status == Status::Ok)
                    .map(|(_, error)| error)
                    .collect();
                let largest = met.iter().fold(0.0, |a: f64, b| a.max(*b));
                let squares: f64 = errors.map(|error| error * error).sum();
                let count = recording.len() as f64;
                let (least, most) = drives
                    .iter()
                    .fold((f64::INFINITY, 0.0_f64), |(a, b), u| (a.min(*u), b.max(*u)));
                println!(
                    "| {name} | {word}, {seconds} s | {:.0} % | {:.2} | {:.1} | {least} to {most} |",
                    100.0 * met.len() as f64 / count,
                    100.0 * largest / (high - low),
                    100.0 * (squares / count).sqrt() / (high - low),
                );
            }
        }
    }
    Ok(())
}

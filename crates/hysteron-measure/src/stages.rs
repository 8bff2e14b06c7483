//! Measures the stages of a model on recordings, and prints `docs/stages.md`:
//! `cargo run --release -p hysteron-measure -- stages ../shared/data`

use crate::folder;
use crate::result::Result;
use hysteron::{
    Auto, Columns, Dynamics, Fit, FitOptions, LoadLaw, Model, Policy, Recording, Repair, Spacing,
    Start, Status, Surroundings, evaluate_from,
};
use std::path::Path;

/// Levels of the fits under load.
const LEVELS: usize = 30;

pub(crate) fn run(arguments: &[String]) -> Result<()> {
    let folder = folder::named(arguments)?;
    print!("{}", include_str!("text/stages.md"));
    loads(&folder)?;
    spacing(&folder)?;
    valve(&folder)?;
    ring(&folder)?;
    drive(&folder)
}

fn read(folder: &Path, name: &str, columns: Columns<'_>) -> Result<Recording> {
    Ok(Recording::read(&folder.join(name), columns, Repair::Refuse)?.0)
}

fn options(levels: usize) -> FitOptions {
    FitOptions {
        levels,
        ..FitOptions::plain()
    }
}

/// The error of a model on a recording, in percent of the recording's range.
fn error(model: &Model, recording: &Recording, start: Start) -> Result<f64> {
    let forward = evaluate_from(model, recording, start)?.forward;
    Ok(forward.nrmse_percent.unwrap_or(f64::NAN))
}

/// One load left out, predicted from the others.
fn loads(folder: &Path) -> Result<()> {
    println!("## A load that was left out\n");
    println!(
        "RMSE in percent of the range at that load, {LEVELS} levels. *Shift* is the default law, *weights*\n\
         is `--load-law weights`. *Neighbours* is the rival without a model: the branches of the two\n\
         neighbouring loads, averaged at each temperature. *Itself* is a fit to the load that was left out.\n\
         The lowest and the highest load are not predicted: a model refuses loads outside its range.\n\n\
         The beam in bending is the exception: its axis hardly moves with the load, and averaging is\n\
         better. Two loads are left there, and two cannot show which law holds.\n"
    );
    println!("| recordings | left out | shift | weights | neighbours | itself |");
    println!("| --- | ---: | ---: | ---: | ---: | ---: |");
    let stress = |name: &str, output: &str, all: &[u32]| -> Result<Vec<Recording>> {
        let columns = Columns {
            load: Some("stress_MPa"),
            ..Columns::new("temperature_C", output)
        };
        let file = |load: &u32| read(folder, &format!("sma_{name}_{load}MPa.csv"), columns);
        all.iter().map(file).collect()
    };
    let bend = Columns {
        load: Some("load_N"),
        ..Columns::new("temperature_C", "extension_mm")
    };
    let sets = [
        ("flexinol", stress("flexinol", "strain", &[50, 150, 200])?),
        ("NiTiCo", stress("nitico_walgren", "strain", &[7, 50, 200])?),
        (
            "NiTiHf",
            stress("nitihf_bigelow", "strain_percent", &[7, 50, 100, 200, 400])?,
        ),
        (
            "bending",
            cycles(&read(folder, "sma_bend_3load.csv", bend)?),
        ),
    ];
    for (name, recordings) in sets {
        for left in 1..recordings.len() - 1 {
            let mut others = recordings.clone();
            let unseen = others.remove(left);
            let by = |law| -> Result<f64> {
                let model = Fit::from(options(LEVELS)).load_law(law).run(&others)?;
                error(&model, &unseen, Start::Off)
            };
            let mut alone = unseen.clone();
            alone.load = None;
            let itself = Fit::from(options(LEVELS)).run(&alone)?;
            println!(
                "| {name} | {:.0} | {:.1} | {:.1} | {:.1} | {:.1} |",
                middle(&unseen),
                by(LoadLaw::Shift)?,
                by(LoadLaw::Weights)?,
                neighbours(&recordings[left - 1], &unseen, &recordings[left + 1]),
                error(&itself, &alone, Start::Off)?,
            );
        }
    }
    println!();
    Ok(())
}

/// The median load.
fn middle(recording: &Recording) -> f64 {
    let mut load = recording.load.clone().unwrap_or_default();
    load.sort_by(f64::total_cmp);
    load[load.len() / 2]
}

/// One recording for each stretch of at least 500 samples at about the same load.
fn cycles(recording: &Recording) -> Vec<Recording> {
    let load = recording.load.clone().unwrap_or_default();
    let mut found: Vec<std::ops::Range<usize>> = Vec::new();
    let mut begin = 0;
    for n in 1..=load.len() {
        let jumps = n < load.len() && (load[n] - load[begin]).abs() > 150.0;
        if n == load.len() || jumps {
            if n - begin > 500 {
                found.push(begin..n);
            }
            begin = n;
        }
    }
    let part = |range: std::ops::Range<usize>| Recording {
        time: None,
        input: recording.input[range.clone()].to_vec(),
        output: recording.output[range.clone()].to_vec(),
        load: Some(load[range].to_vec()),
        ..recording.clone()
    };
    let mut parts: Vec<Recording> = found.into_iter().map(part).collect();
    parts.sort_by(|a, b| middle(a).total_cmp(&middle(b)));
    parts
}

/// The error of the mean of two neighbours' branches, weighted by the distance of the loads.
fn neighbours(below: &Recording, unseen: &Recording, above: &Recording) -> f64 {
    let share = (middle(unseen) - middle(below)) / (middle(above) - middle(below));
    let rising = |recording: &Recording| {
        let hottest = extreme(&recording.input, 1.0);
        let coldest = extreme(&recording.input, -1.0);
        (
            coldest.min(hottest),
            coldest.max(hottest),
            hottest > coldest,
        )
    };
    // Each recording is one loop: on the way between its extremes it moves one way, else the other.
    let branch = |recording: &Recording, n: usize| {
        let (from, to, heats) = rising(recording);
        (from..to).contains(&n) == heats
    };
    let at = |recording: &Recording, heating: bool, t: f64| {
        let own = (0..recording.len()).filter(|n| branch(recording, *n) == heating);
        let mut points: Vec<(f64, f64)> = own
            .map(|n| (recording.input[n], recording.output[n]))
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let k = points.partition_point(|point| point.0 <= t);
        match (k.checked_sub(1).map(|k| points[k]), points.get(k)) {
            (Some(a), Some(b)) => a.1 + (b.1 - a.1) * (t - a.0) / (b.0 - a.0),
            (Some(only), None) => only.1,
            (None, Some(only)) => only.1,
            (None, None) => f64::NAN,
        }
    };
    let (mut squares, mut low, mut high) = (0.0, f64::INFINITY, f64::NEG_INFINITY);
    for n in 0..unseen.len() {
        let (t, heating) = (unseen.input[n], branch(unseen, n));
        let guess = (1.0 - share) * at(below, heating, t) + share * at(above, heating, t);
        squares += (guess - unseen.output[n]).powi(2);
        (low, high) = (low.min(unseen.output[n]), high.max(unseen.output[n]));
    }
    100.0 * (squares / unseen.len() as f64).sqrt() / (high - low)
}

fn extreme(values: &[f64], sign: f64) -> usize {
    let by = |a: &usize, b: &usize| (sign * values[*a]).total_cmp(&(sign * values[*b]));
    (0..values.len()).max_by(by).unwrap_or(0)
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
         the sine, which is not judged on what it did not see. The last row of both sines is a jump,\n\
         which only a ring follows.\n"
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

//! One load left out, predicted from the others:
//! `cargo run --release -p hysteron-measure -- loads ../shared/data`

use crate::folder;
use crate::judged::{error, options, read};
use crate::result::Result;
use hysteron::{Columns, Fit, LoadLaw, Model, Recording, Start};
use std::path::Path;

/// Levels of the fits under load.
const LEVELS: usize = 30;

pub(crate) fn run(arguments: &[String]) -> Result<()> {
    print(&folder::named(arguments)?)
}

/// One load left out, predicted from the others.
pub(crate) fn print(folder: &Path) -> Result<()> {
    println!("## A load that was left out\n");
    println!(
        "RMSE in percent of the range at that load, {LEVELS} levels. *Default* is the law that the fit\n\
         chose, which the next column names; *shift* and *weights* are `--load-law shift` and\n\
         `--load-law weights`. *Neighbours* is the rival without a model: the branches of the two\n\
         neighbouring loads, averaged at each temperature. *Itself* is a fit to the load that was left out.\n\
         The lowest and the highest load are not predicted: a model refuses loads outside its range.\n\n\
         The beam in bending is the exception: its axis hardly moves with the load, and averaging is\n\
         better. Two loads are left there, and two cannot show which law holds.\n"
    );
    println!("| recordings | left out | default | law | shift | weights | neighbours | itself |");
    println!("| --- | ---: | ---: | --- | ---: | ---: | ---: | ---: |");
    let (mut logarithms, mut count) = ([0.0; 5], 0.0);
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
            let by = |law| -> Result<(f64, String)> {
                let model = Fit::from(options(LEVELS)).load_law(law).run(&others)?;
                Ok((error(&model, &unseen, Start::Off)?, chosen(&model)))
            };
            let mut alone = unseen.clone();
            alone.load = None;
            let itself = Fit::from(options(LEVELS)).run(&alone)?;
            let (auto, law) = by(LoadLaw::Auto)?;
            let errors = [
                auto,
                by(LoadLaw::Shift)?.0,
                by(LoadLaw::Weights)?.0,
                neighbours(&recordings[left - 1], &unseen, &recordings[left + 1]),
                error(&itself, &alone, Start::Off)?,
            ];
            row(&format!("{name} | {:.0}", middle(&unseen)), &law, errors);
            let sums = logarithms.iter_mut().zip(errors);
            sums.for_each(|(sum, error)| *sum += error.ln());
            count += 1.0;
        }
    }
    let means = logarithms.map(|sum| f64::exp(sum / count));
    row("geometric mean |", "all", means);
    println!();
    Ok(())
}

fn row(name: &str, law: &str, [auto, rest @ ..]: [f64; 5]) {
    let rest: String = rest.iter().map(|error| format!(" {error:.1} |")).collect();
    println!("| {name} | {auto:.1} | {law} |{rest}");
}

/// The law of the load that a fit chose.
fn chosen(model: &Model) -> String {
    let fit = model.fit.as_ref();
    let law = fit.and_then(|fit| fit.other.get("load")?["chosen"].as_object());
    let named = law.and_then(|law| law.iter().next());
    named.map_or("weights".into(), |(name, how)| {
        let of = |key: &str| match &how[key] {
            serde_json::Value::String(word) => word.clone(),
            other => other.to_string(),
        };
        match name.as_str() {
            "weights" => format!("shift, weights of order {}", of("degree")),
            "alone" => format!("weights of order {}", of("degree")),
            "gain" => format!("shift, {}", of("stroke")),
            name => format!("{name}, {}", of("stroke")),
        }
    })
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

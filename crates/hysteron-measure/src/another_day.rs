//! A model of one session, adapted on a single stroke of another.

use crate::judged::{error, read};
use crate::result::Result;
use hysteron::{
    AdaptOptions, Columns, Fit, Model, Progress, Recording, Start, adapt, branches, usual_tolerance,
};
use std::path::Path;

/// Recordings of one valve in two sessions. The pseudo-random input has no stroke over its range.
const SESSIONS: [&[&str]; 2] = [
    &["valve_sine100_1", "valve_sine50_1", "valve_prbn_1"],
    &["valve_20Hz", "valve_100Hz"],
];

pub(crate) fn print(folder: &Path) -> Result<()> {
    print!("{}", include_str!("text/another-day.md"));
    println!(
        "| fitted | of the other day | outside | alone | constant | line | adapted | itself |"
    );
    println!("| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |");
    let columns = Columns::new("voltage_V", "position");
    let open = |name: &&str| -> Result<(String, Recording, Model)> {
        let recording = read(folder, &format!("{name}.csv"), columns)?;
        let model = Fit::new().bootstrap(0).run(&recording)?;
        Ok(((*name).to_owned(), recording, model))
    };
    let days = SESSIONS.map(|names| names.iter().map(open).collect::<Result<Vec<_>>>());
    let [first, second] = days;
    let (first, second) = (first?, second?);
    let pairs = first
        .iter()
        .flat_map(|a| second.iter().flat_map(move |b| [(a, b), (b, a)]));
    let (mut sums, mut count) = ([0.0; 5], 0.0);
    for ((from, _, model), (to, recording, itself)) in pairs {
        if to == "valve_prbn_1" {
            continue;
        }
        let stroke = longest(recording);
        let adapted = adapt(model, &stroke, &AdaptOptions::default(), Progress::NONE)?;
        // One that ended worse is not written.
        let adapted = if adapted.worse {
            model.clone()
        } else {
            adapted.model
        };
        let (constant, line) = moved(model, &stroke)?;
        let each = [model, &constant, &line, &adapted, itself];
        let mut errors = [0.0; 5];
        for (error, model) in errors.iter_mut().zip(each) {
            *error = found(model, recording)?;
        }
        let plane = model.plane();
        let outside = |x: &&f64| !(plane.min()..=plane.max()).contains(*x);
        let outside = recording.input.iter().filter(outside).count();
        let share = 100.0 * outside as f64 / recording.len() as f64;
        let cells: Vec<String> = errors.iter().map(|e| format!("{e:.2}")).collect();
        println!("| {from} | {to} | {share:.0} % | {} |", cells.join(" | "));
        for (sum, error) in sums.iter_mut().zip(errors) {
            *sum += (error / errors[4]).ln();
        }
        count += 1.0;
    }
    let means: Vec<String> = sums
        .iter()
        .map(|sum| format!("{:.2}", (sum / count).exp()))
        .collect();
    println!(
        "| over *itself*, geometric mean | | | {} |\n",
        means.join(" | ")
    );
    Ok(())
}

/// The longest stroke of a recording.
fn longest(recording: &Recording) -> Recording {
    let input = &recording.input;
    let branch = branches(input, usual_tolerance(input));
    let strokes = branch.chunk_by(|a, b| a == b).scan(0, |from, stroke| {
        let stroke = *from..*from + stroke.len();
        *from = stroke.end;
        Some(stroke)
    });
    let length =
        |stroke: &std::ops::Range<usize>| (input[stroke.end - 1] - input[stroke.start]).abs();
    let longest = strokes
        .max_by(|a, b| length(a).total_cmp(&length(b)))
        .unwrap_or_default();
    Recording {
        input: input[longest.clone()].to_vec(),
        output: recording.output[longest].to_vec(),
        time: None,
        ..recording.clone()
    }
}

/// The model with a constant added, and with a line, as suits a recording best.
fn moved(model: &Model, stroke: &Recording) -> Result<(Model, Model)> {
    let outputs = model.simulate(&stroke.input)?;
    let count = outputs.len() as f64;
    let h = outputs.iter().sum::<f64>() / count;
    let y = stroke.output.iter().sum::<f64>() / count;
    let spread: f64 = outputs.iter().map(|one| (one - h).powi(2)).sum();
    let pairs = outputs.iter().zip(&stroke.output);
    let common: f64 = pairs.map(|(a, b)| (a - h) * (b - y)).sum();
    let with = |gain: f64| -> Result<Model> {
        let weights = model.weights().iter().map(|mu| gain * mu).collect();
        let offset = y - gain * (h - model.offset());
        let (operator, plane, sign) = (model.operator(), *model.plane(), model.sign());
        Ok(Model::new(operator, plane, weights, offset, sign)?)
    };
    Ok((with(1.0)?, with(common / spread)?))
}

/// The error of a model from the start that suits it best.
fn found(model: &Model, recording: &Recording) -> Result<f64> {
    let each = [Start::Off, Start::On, Start::Rest].map(|start| error(model, recording, start));
    each.into_iter()
        .try_fold(f64::INFINITY, |least, error| Ok(error?.min(least)))
}

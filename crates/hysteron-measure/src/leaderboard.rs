//! Fits every method to the same recordings, predicts others, and prints
//! `docs/measured/leaderboard.md`:
//! `cargo run --release -p hysteron-measure -- leaderboard ../shared/data`
//!
//! `--splits FOLDER` writes the tasks as tables instead. `--entry NAME=FOLDER` adds the predictions
//! of another method as a column. `--only WORD` runs the rows whose name has that word.

mod cell;
mod entry;
mod methods;
mod pairs;
mod plays;
mod prandtl;
mod splits;

use crate::result::Result;
use cell::number;
use entry::Entry;
use hysteron::range;
use methods::Method;
use splits::{Set, Split};
use std::path::PathBuf;
use std::time::Instant;

/// Why another method wins in a row, where that was found out.
const REASONS: &str = include_str!("text/leaderboard-reasons.txt");

/// A method that errs less than ours by this share wins clearly, and the page says why.
const CLEAR: f64 = 0.02;

#[derive(Default)]
struct Arguments {
    folder: Option<PathBuf>,
    splits: Option<PathBuf>,
    entries: Vec<Entry>,
    only: Option<String>,
}

fn read(words: &[String]) -> Result<Arguments> {
    let mut found = Arguments::default();
    let mut words = words.iter();
    while let Some(word) = words.next() {
        let mut value = || words.next().cloned().ok_or(format!("{word} wants a value"));
        match word.as_str() {
            "--splits" => found.splits = Some(value()?.into()),
            "--entry" => found.entries.push(Entry::parse(&value()?)?),
            "--only" => found.only = Some(value()?),
            _ => found.folder = Some(word.into()),
        }
    }
    Ok(found)
}

pub(crate) fn run(arguments: &[String]) -> Result<()> {
    let arguments = read(arguments)?;
    let folder = arguments
        .folder
        .ok_or("name the folder of the recordings")?;
    let mut sets = splits::all(&folder)?;
    if let Some(word) = &arguments.only {
        sets.retain(|set| set.name.contains(word.as_str()));
    }
    if let Some(folder) = &arguments.splits {
        return entry::write(&sets, folder);
    }
    print!("{}", include_str!("text/leaderboard.md"));
    table(&sets, &arguments.entries)?;
    if arguments.only.is_none() {
        print!("{}", include_str!("text/leaderboard-pairs.md"));
        pairs::table(&folder)?;
    }
    Ok(())
}

/// The errors of one method in one row.
#[derive(Clone, Copy)]
struct Score {
    rmse: f64,
    percent: f64,
}

fn table(sets: &[Set], entries: &[Entry]) -> Result<()> {
    let names = Method::ALL.iter().map(|method| method.name());
    let names: Vec<String> = names
        .chain(entries.iter().map(|e| e.name.clone()))
        .collect();
    println!("| data | {} |", names.join(" | "));
    println!("| --- |{}", " ---: |".repeat(names.len()));
    let (mut marked, mut units) = (Vec::new(), Vec::new());
    for set in sets {
        let of_method = |method: &Method| {
            let begin = Instant::now();
            let score = score(set, |split| method.predict(split));
            let seconds = begin.elapsed().as_secs_f64();
            eprintln!("{}, {}: {seconds:.1} s", set.name, method.name());
            score
        };
        let own = Method::ALL.iter().map(of_method);
        let theirs = entries.iter().map(|e| score(set, |split| e.predict(split)));
        let scores: Vec<Option<Score>> = own.chain(theirs).collect();
        let best = scores
            .iter()
            .flatten()
            .map(|s| s.percent)
            .fold(f64::INFINITY, f64::min);
        let ours = scores[0].map_or(f64::INFINITY, |score| score.percent);
        let others = Method::ALL
            .iter()
            .zip(&scores)
            .filter(|(method, _)| !method.is_same_optimum());
        let others = others.filter_map(|(method, score)| Some((method.name(), (*score)?.percent)));
        let winner = others
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .filter(|w| w.1 < (1.0 - CLEAR) * ours);
        let cell = |score: &Option<Score>| match score {
            None => "–".to_owned(),
            Some(score) if score.percent <= best => format!("**{}**", number(score.percent)),
            Some(score) => number(score.percent),
        };
        let cells: Vec<String> = scores.iter().map(cell).collect();
        let mark = if winner.is_some() { " ‡" } else { "" };
        println!("| {}{mark} | {} |", set.name, cells.join(" | "));
        if let Some((name, percent)) = winner {
            marked.push(format!(
                "- *{}*: {name} {} %, ours {} %. {}",
                set.name,
                number(percent),
                number(ours),
                reason(&set.name)
            ));
        }
        if let Some(unit) = set.unit {
            let cell =
                |score: &Option<Score>| score.map_or("–".into(), |s| format!("{:.4}", s.rmse));
            let cells: Vec<String> = scores.iter().map(cell).collect();
            units.push(format!(
                "| {}, in {unit} | {} |",
                set.name,
                cells.join(" | ")
            ));
        }
    }
    units.iter().for_each(|row| println!("{row}"));
    println!("\n## Where another method wins\n");
    match marked.is_empty() {
        true => println!("Nowhere."),
        false => println!("{}", marked.join("\n")),
    }
    Ok(())
}

/// Errors over all samples that count; `None` where the method cannot be used.
fn score(set: &Set, predict: impl Fn(&Split) -> Result<Option<Vec<f64>>>) -> Option<Score> {
    let (mut measured, mut squares) = (Vec::new(), 0.0);
    for split in &set.splits {
        let predicted = predict(split).unwrap_or_else(|error| {
            eprintln!("{}: {error}", split.name);
            None
        })?;
        for n in (0..split.test.len()).filter(|n| split.scored[*n]) {
            squares += (predicted[n] - split.test.output[n]).powi(2);
            measured.push(split.test.output[n]);
        }
    }
    let (low, high) = range(&measured);
    let rmse = (squares / measured.len() as f64).sqrt();
    Some(Score {
        rmse,
        percent: 100.0 * rmse / (high - low),
    })
}

/// The sentence behind `NAME:` in the file of reasons.
fn reason(name: &str) -> &'static str {
    let lines = REASONS.lines().filter_map(|line| line.split_once(": "));
    let found = lines
        .filter(|(row, _)| *row == name)
        .map(|(_, why)| why)
        .next();
    found.unwrap_or("Reason not found yet.")
}

//! Every recording of one valve predicts every other: a table of pairs.

use super::methods::Method;
use super::prandtl::Shape;
use super::{number, splits};
use crate::result::Result;
use hysteron::{Recording, RivalKind, range};
use std::path::Path;
use std::slice;

const METHODS: [Method; 6] = [
    Method::Ours,
    Method::Fixed,
    Method::Prandtl(Shape::Plain),
    Method::Prandtl(Shape::TwoSided),
    Method::Plays,
    Method::Rival(RivalKind::Interpolation),
];

/// The recordings, and how many of them, from the first on, are of one session.
const VALVES: [&str; 5] = ["sine50_1", "sine100_1", "prbn_1", "20Hz", "100Hz"];
const ONE_SESSION: usize = 3;

/// In the first 25 ms the valve moves by itself, because its drive was switched on. In the last row
/// of a recording the input has jumped back to where it began, and the output is still the old one.
const SWITCHED_ON: f64 = 0.025;

/// What of an error counts in a mean; `None` where it does not.
type Counted = fn(&Error) -> Option<f64>;

/// The error of a method on one pair, in percent of the range of the outputs.
struct Error {
    in_session: bool,
    whole: f64,
    /// Without the ends of the test.
    inside: f64,
}

pub fn table(folder: &Path) -> Result<()> {
    let valves = VALVES.map(|name| splits::valve_recording(folder, name));
    let valves: Vec<Recording> = valves.into_iter().collect::<Result<_>>()?;
    let names: Vec<String> = METHODS.iter().map(|method| method.name()).collect();
    println!("| fitted, predicted | {} |", names.join(" | "));
    println!("| --- |{}", " ---: |".repeat(names.len()));
    let mut all: Vec<Vec<Error>> = METHODS.iter().map(|_| Vec::new()).collect();
    for (from, training) in valves.iter().enumerate() {
        let predictors = METHODS
            .iter()
            .map(|method| method.fit(slice::from_ref(training)));
        let predictors = predictors.collect::<Result<Vec<_>>>()?;
        for (to, test) in valves.iter().enumerate().filter(|(to, _)| *to != from) {
            for (predict, errors) in predictors.iter().zip(&mut all) {
                let predicted = predict(test)?.ok_or("a method without a prediction")?;
                errors.push(Error {
                    in_session: from.max(to) < ONE_SESSION,
                    whole: percent(test, &predicted, |_| true),
                    inside: percent(test, &predicted, |n| is_inside(test, n)),
                });
            }
            let last = all.iter().filter_map(|errors| errors.last());
            let pair = [from, to].map(|n| VALVES[n].trim_end_matches("_1"));
            row(&pair.join(", "), last.map(|error| error.whole));
        }
    }
    let means: [(&str, Counted); 4] = [
        ("mean of all", |e| Some(e.whole)),
        ("mean within one session", |e| {
            e.in_session.then_some(e.whole)
        }),
        ("mean of all, without ends", |e| Some(e.inside)),
        ("mean within one session, without ends", |e| {
            e.in_session.then_some(e.inside)
        }),
    ];
    for (name, of) in means {
        let mean = |errors: &Vec<Error>| geometric(errors.iter().filter_map(of));
        row(name, all.iter().map(mean));
    }
    Ok(())
}

fn is_inside(test: &Recording, n: usize) -> bool {
    let since = test.time.as_ref().map_or(f64::INFINITY, |t| t[n] - t[0]);
    since >= SWITCHED_ON && n + 1 < test.len()
}

/// The error over the samples that count, in percent of the range of all outputs.
fn percent(test: &Recording, predicted: &[f64], counts: impl Fn(usize) -> bool) -> f64 {
    let kept: Vec<usize> = (0..test.len()).filter(|n| counts(*n)).collect();
    let squares = kept
        .iter()
        .map(|n| (predicted[*n] - test.output[*n]).powi(2));
    let (low, high) = range(&test.output);
    100.0 * (squares.sum::<f64>() / kept.len() as f64).sqrt() / (high - low)
}

fn geometric(errors: impl Iterator<Item = f64>) -> f64 {
    let logs: Vec<f64> = errors.map(f64::ln).collect();
    (logs.iter().sum::<f64>() / logs.len() as f64).exp()
}

/// A row with its smallest number in bold.
fn row(name: &str, errors: impl Iterator<Item = f64>) {
    let errors: Vec<f64> = errors.collect();
    let least = errors.iter().copied().fold(f64::INFINITY, f64::min);
    let cell = |error: &f64| match *error <= least {
        true => format!("**{}**", number(*error)),
        false => number(*error),
    };
    let cells: Vec<String> = errors.iter().map(cell).collect();
    println!("| {name} | {} |", cells.join(" | "));
}

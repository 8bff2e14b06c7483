//! How much of what was held out the band holds. Prints `docs/measured/coverage.md`:
//! `cargo run --release -p hysteron-measure -- coverage ../shared/data`

mod synthetic;

use crate::folder;
use crate::median::median;
use crate::result::Result;
use hysteron::{Fit, Model, Recording, Start, Verdict, branches, evaluate_from, usual_tolerance};

/// Which quarter of the branches a branch belongs to, by its number modulo 8. No two neighbours are
/// in one quarter, and each quarter has rising and falling branches.
const QUARTER: [usize; 8] = [0, 1, 2, 3, 1, 0, 3, 2];

/// With fewer branches than this, a quarter of them is most of what is known about its direction.
const MANY: usize = 8;

/// Recordings of the same actuator in two sessions, or under two drives.
const REPEATS: [[&str; 2]; 10] = [
    ["magnet_lcls2_quad_ru3", "magnet_lcls2_quad_ru4"],
    ["valve_sine50_1", "valve_sine100_1"],
    ["valve_sine100_1", "valve_sine50_1"],
    ["valve_sine50_1", "valve_prbn_1"],
    ["valve_sine100_1", "valve_prbn_1"],
    ["valve_prbn_1", "valve_sine50_1"],
    ["valve_prbn_1", "valve_sine100_1"],
    ["valve_20Hz", "valve_100Hz"],
    ["valve_100Hz", "valve_20Hz"],
    ANOTHER_DAY,
];
/// The last of them.
const ANOTHER_DAY: [&str; 2] = ["valve_20Hz", "valve_sine50_1"];

pub(crate) fn run(arguments: &[String]) -> Result<()> {
    let recordings = folder::recordings(&folder::named(arguments)?)?;
    let of_name = |name: &str| {
        let mut all = recordings.iter();
        all.find(|(other, _)| other == name)
            .and_then(|(_, found)| found.as_ref())
    };
    print!("{}", include_str!("text/coverage.md"));
    println!("## Branches held out of the same recording\n");
    println!("Each quarter of the branches in turn, of recordings with three branches or more.\n");
    println!("| recording | branches | coverage | half width | error |");
    println!("| --- | ---: | ---: | ---: | ---: |");
    let mut good = Vec::new();
    for (name, recording) in &recordings {
        let Some(recording) = recording else { continue };
        eprintln!("{name}");
        let Some(found) = over_quarters(recording)? else {
            continue;
        };
        let count = number_of_branches(recording);
        good.push((count, (90.0..=99.0).contains(&found.percent())));
        println!("| {name} | {count} | {found} |");
    }
    let share = |of: &dyn Fn(usize) -> bool| {
        let of: Vec<bool> = good
            .iter()
            .filter(|(n, _)| of(*n))
            .map(|(_, good)| *good)
            .collect();
        format!(
            "{} of {}",
            of.iter().filter(|good| **good).count(),
            of.len()
        )
    };
    println!(
        "\nBetween 90 and 99 % in {} recordings with {MANY} branches or more, and in {} with fewer.\n",
        share(&|n| n >= MANY),
        share(&|n| n < MANY)
    );
    println!("## Another recording\n");
    println!(
        "The last row is of another day. *Announced* is the error that the fit says it has on data"
    );
    println!("not fitted. The start of the second recording is estimated from its beginning.\n");
    println!("| fitted, tested | coverage | half width | error | announced | error / announced |");
    println!("| --- | ---: | ---: | ---: | ---: | ---: |");
    let mut ratios = Vec::new();
    for [fitted, tested] in REPEATS {
        let (Some(recording), Some(other)) = (of_name(fitted), of_name(tested)) else {
            continue;
        };
        eprintln!("{fitted}, {tested}");
        let model = Fit::new().run(recording)?;
        let judged = evaluate_from(&model, other, Start::Unknown)?;
        let (low, high) = other.ranges().1;
        let announced = Verdict::of_record(&model).and_then(|verdict| verdict.percent);
        let announced = announced.unwrap_or(f64::NAN);
        let error = judged.forward.nrmse_percent.unwrap_or(f64::NAN);
        if let Some(band) = judged.band {
            let width = band.half_width.iter().sum::<f64>() / other.len() as f64;
            println!(
                "| {fitted}, {tested} | {:.1} % | {:.2} % | {error:.2} % | {announced:.2} % | {:.2} |",
                band.coverage_percent,
                100.0 * width / (high - low),
                error / announced,
            );
            if [fitted, tested] != ANOTHER_DAY {
                ratios.push(error / announced);
            }
        }
    }
    println!(
        "\nWithout the last row, the error is {:.2} times what was announced, in the median.\n",
        median(ratios)
    );
    synthetic::print()
}

/// Over all branches but the first, each held out with its quarter. `None` if there are fewer than
/// three branches.
fn over_quarters(recording: &Recording) -> Result<Option<Coverage>> {
    if number_of_branches(recording) < 3 {
        return Ok(None);
    }
    let branch = branches(&recording.input, usual_tolerance(&recording.input));
    let mut found = Coverage::of_range(recording);
    for quarter in 0..4 {
        // The sample in which a branch ends is where the next one begins, so it stays.
        let held_out = |n: usize| {
            let ends = branch.get(n + 1).is_some_and(|next| *next != branch[n]);
            branch[n] > 0 && QUARTER[(branch[n] - 1) % 8] == quarter && !ends
        };
        if !(0..recording.len()).any(held_out) {
            continue;
        }
        let Some(training) = recording.only(|n| !held_out(n)) else {
            continue;
        };
        let model = Fit::new().run(&[training])?;
        found.add(&model, recording, held_out)?;
    }
    Ok((found.count > 0).then_some(found))
}

fn number_of_branches(recording: &Recording) -> usize {
    let branch = branches(&recording.input, usual_tolerance(&recording.input));
    branch.last().map_or(0, |last| last + 1)
}

/// Sums over samples that the fit has not seen.
struct Coverage {
    range: f64,
    count: usize,
    inside: usize,
    width: f64,
    squares: f64,
}

impl Coverage {
    fn of_range(recording: &Recording) -> Self {
        let (low, high) = recording.ranges().1;
        Self {
            range: high - low,
            count: 0,
            inside: 0,
            width: 0.0,
            squares: 0.0,
        }
    }

    /// Counts the samples `of`, if the model has a band.
    fn add(
        &mut self,
        model: &Model,
        recording: &Recording,
        of: impl Fn(usize) -> bool,
    ) -> Result<()> {
        let Some(band) = model.band()? else {
            return Ok(());
        };
        let recording = &*model.rested(recording)?;
        let around = hysteron::Surroundings::from_recording(model, recording);
        let output = model.simulate_in(&recording.input, around)?;
        let acting = model.acting(&recording.input, around)?;
        let half = band.run(&model.start(), &model.seen(&acting, around)?)?;
        for n in (0..recording.len()).filter(|n| of(*n)) {
            let error = recording.output[n] - output[n];
            self.inside += usize::from(error.abs() <= half[n]);
            self.count += 1;
            self.width += half[n];
            self.squares += error * error;
        }
        Ok(())
    }

    fn percent(&self) -> f64 {
        100.0 * self.inside as f64 / self.count as f64
    }
}

impl std::fmt::Display for Coverage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let count = self.count as f64;
        write!(
            f,
            "{:.1} % | {:.2} % | {:.2} %",
            self.percent(),
            100.0 * self.width / count / self.range,
            100.0 * (self.squares / count).sqrt() / self.range
        )
    }
}

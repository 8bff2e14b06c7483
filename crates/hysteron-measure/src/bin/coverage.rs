//! How much of what was held out the band holds. Prints `docs/coverage.md`:
//! `cargo run --release -p hysteron-measure --bin coverage -- ../shared/data`

#[path = "../folder/mod.rs"]
mod folder;
#[path = "../genuine/mod.rs"]
mod genuine;

use hysteron::{Fit, HoldOut, Model, Recording, Start, evaluate_from};
use std::error::Error;
use std::path::Path;

/// Share of the branches that are held out.
const SHARE: f64 = 0.25;

/// Recordings of the same actuator in two sessions, or under two drives.
const REPEATS: [[&str; 2]; 6] = [
    ["magnet_lcls2_quad_ru3", "magnet_lcls2_quad_ru4"],
    ["valve_sine50_1", "valve_sine100_1"],
    ["valve_sine100_1", "valve_sine50_1"],
    ["valve_20Hz", "valve_100Hz"],
    ["valve_100Hz", "valve_20Hz"],
    ["valve_20Hz", "valve_sine50_1"],
];

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args()
        .nth(1)
        .ok_or("name the folder of the recordings")?;
    let recordings = folder::recordings(Path::new(&folder))?;
    let of_name = |name: &str| {
        let mut all = recordings.iter();
        all.find(|(other, _)| other == name)
            .and_then(|(_, found)| found.as_ref())
    };
    print!("{}", include_str!("coverage.md"));
    println!("## Branches held out of the same recording\n");
    println!("A quarter of the branches, of recordings with three branches or more.\n");
    println!("| recording | coverage | half width | error |");
    println!("| --- | ---: | ---: | ---: |");
    let (mut rows, mut good) = (0, 0);
    for (name, recording) in &recordings {
        let Some(recording) = recording else { continue };
        eprintln!("{name}");
        let Ok(split) = recording.split(&HoldOut::Branches(SHARE)) else {
            continue;
        };
        let model = Fit::new().run(&split.training)?;
        let Some(found) = Coverage::of(&model, recording, |n| split.held_out[n])? else {
            continue;
        };
        rows += 1;
        good += usize::from((90.0..=99.0).contains(&found.percent));
        println!("| {name} | {found} |");
    }
    println!("\nBetween 90 and 99 % in {good} of {rows} recordings.\n");
    println!("## Another session\n");
    println!("The start of the second recording is estimated from its beginning.\n");
    println!("| fitted, tested | coverage | half width | error |");
    println!("| --- | ---: | ---: | ---: |");
    for [fitted, tested] in REPEATS {
        let (Some(recording), Some(other)) = (of_name(fitted), of_name(tested)) else {
            continue;
        };
        eprintln!("{fitted}, {tested}");
        let model = Fit::new().run(recording)?;
        let judged = evaluate_from(&model, other, Start::Unknown)?;
        let (low, high) = other.ranges().1;
        if let Some(band) = judged.band {
            let width = band.half_width.iter().sum::<f64>() / other.len() as f64;
            println!(
                "| {fitted}, {tested} | {:.1} % | {:.2} % | {:.2} % |",
                band.coverage_percent,
                100.0 * width / (high - low),
                judged.forward.nrmse_percent.unwrap_or(f64::NAN),
            );
        }
    }
    Ok(())
}

struct Coverage {
    percent: f64,
    half_width_percent: f64,
    error_percent: f64,
}

impl Coverage {
    /// Over the samples `of`; `None` if there is no band or no sample.
    fn of(
        model: &Model,
        recording: &Recording,
        of: impl Fn(usize) -> bool,
    ) -> Result<Option<Self>, Box<dyn Error>> {
        let Some(band) = model.band()? else {
            return Ok(None);
        };
        let around = hysteron::Surroundings::of(model, recording);
        let output = model.simulate_in(&recording.input, around)?;
        let half = band.run(&model.start(), &model.seen(&recording.input, around)?)?;
        let (mut inside, mut count, mut width, mut squares) = (0, 0, 0.0, 0.0);
        for n in (0..recording.len()).filter(|n| of(*n)) {
            let error = recording.output[n] - output[n];
            inside += usize::from(error.abs() <= half[n]);
            count += 1;
            width += half[n];
            squares += error * error;
        }
        let (low, high) = recording.ranges().1;
        let count_of = f64::from(count);
        Ok((count > 0).then(|| Self {
            percent: 100.0 * inside as f64 / count_of,
            half_width_percent: 100.0 * width / count_of / (high - low),
            error_percent: 100.0 * (squares / count_of).sqrt() / (high - low),
        }))
    }
}

impl std::fmt::Display for Coverage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{:.1} % | {:.2} % | {:.2} %",
            self.percent, self.half_width_percent, self.error_percent
        )
    }
}

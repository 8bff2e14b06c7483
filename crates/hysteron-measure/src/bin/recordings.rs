//! Fits every recording of a folder, leaves out branches, and prints `docs/recordings.md`:
//! `cargo run --release -p hysteron-measure --bin recordings -- ../shared/data`

#[path = "../genuine/mod.rs"]
mod genuine;
#[path = "../scipy/mod.rs"]
mod scipy;

use hysteron::{
    Candidates, Columns, FitOptions, LeftOut, Operator, Progress, Recording, Start, TableReader,
    left_out, plane_of,
};
use std::error::Error;
use std::path::Path;

const LEVELS: usize = 20;

/// What drives the actuator, the first of these that a recording has.
const INPUTS: [&str; 5] = [
    "temperature_C",
    "voltage_V",
    "duty",
    "current_A",
    "H_A_per_m",
];

/// What the actuator does, the first of these that a recording has.
const OUTPUTS: [&str; 9] = [
    "output",
    "strain",
    "strain_percent",
    "extension_mm",
    "position_m",
    "BL_T",
    "polarization_uC_cm2",
    "displacement_nm",
    "B_T",
];

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args()
        .nth(1)
        .ok_or("name the folder of the recordings")?;
    print!("{}", include_str!("recordings.md"));
    println!(
        "| recording | samples, branches | MKP auto | levels, smoothness | MKP, K = 20 | KP | \
         relay | SciPy, K = 20 | auto / best |"
    );
    println!("| --- | ---: | ---: | --- | ---: | ---: | ---: | ---: | ---: |");
    let mut names: Vec<String> = std::fs::read_dir(&folder)?
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| name.ends_with(".csv") && name != "MANIFEST.csv")
        .collect();
    names.sort();
    for name in names {
        let path = Path::new(&folder).join(&name);
        let name = name.trim_end_matches(".csv");
        let table = TableReader::open(&path)?;
        let find = |known: &[&'static str]| {
            let mut known = known.iter().copied();
            known.find(|k| table.header().iter().any(|h| h == k))
        };
        match (find(&INPUTS), find(&OUTPUTS)) {
            (Some(input), Some(output)) => {
                let columns = Columns::new(input, output);
                row(name, genuine::read(&path, columns)?)?;
            }
            _ => println!("| {name} | no known columns | | | | | | | |"),
        }
    }
    Ok(())
}

fn row(name: &str, recording: Recording) -> Result<(), Box<dyn Error>> {
    eprintln!("{name}");
    let (_, (low, high)) = recording.ranges();
    let recordings = [recording];
    let run = |operator, start, candidates: Option<&Candidates>| {
        let options = FitOptions {
            operator,
            start,
            levels: LEVELS,
            ..FitOptions::default()
        };
        left_out(&recordings, &options, candidates, Progress::NONE)
    };
    let auto = run(
        Operator::Mkp,
        Start::Unknown,
        Some(&Candidates::new(None, None)),
    )?;
    let fixed = [Operator::Mkp, Operator::Kp, Operator::Relay]
        .map(|operator| run(operator, Start::Off, None));
    let [mkp, kp, relay] = fixed;
    let (mkp, kp, relay) = (mkp?, kp?, relay?);
    let scipy = scipy::run(
        &recordings[0],
        plane_of(&recordings[0], LEVELS)?,
        Some(&mkp.fold),
    )?;
    let percent = |rmse: f64| 100.0 * rmse / (high - low);
    let scipy = scipy.map(|found| (percent(found.training_rmse), percent(found.left_out_rmse)));
    let others = [mkp.nrmse_percent, kp.nrmse_percent, relay.nrmse_percent];
    let best = others
        .into_iter()
        .chain(scipy.map(|(_, left_out)| left_out))
        .fold(auto.nrmse_percent, f64::min);
    let cell = |found: &LeftOut| {
        format!(
            "{:.3}, {:.3}",
            found.training_nrmse_percent, found.nrmse_percent
        )
    };
    let mut levels: Vec<usize> = auto.chosen.iter().map(|(levels, _)| *levels).collect();
    let mut smooth: Vec<f64> = auto.chosen.iter().map(|(_, smooth)| smooth.along).collect();
    levels.sort_unstable();
    smooth.sort_by(f64::total_cmp);
    let middle = levels.len() / 2;
    println!(
        "| {name} | {}, {} | {} | {}, {:.0e} | {} | {} | {} | {} | {:.2} |",
        recordings[0].len(),
        auto.branches,
        cell(&auto),
        levels[middle],
        smooth[middle],
        cell(&mkp),
        cell(&kp),
        cell(&relay),
        scipy.map_or("not installed".into(), |(t, l)| format!("{t:.3}, {l:.3}")),
        auto.nrmse_percent / best,
    );
    Ok(())
}

//! Fits every recording of a folder and prints `docs/recordings.md`:
//! `cargo run --release -p hysteron --example recordings -- ../shared/data`

use hysteron::{
    Columns, FitOptions, FitSummary, Operator, Recording, Repair, Sign, Solver, TableReader, fit,
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

/// What it does.
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
    let folder = Path::new(&folder);
    print!("{}", include_str!("recordings.md"));
    println!(
        "| recording | input → output | samples | sign | MKP | weights not zero | KP | relay | MKP, least squares |"
    );
    println!("| --- | --- | ---: | :---: | ---: | ---: | ---: | ---: | ---: |");
    let mut names: Vec<String> = std::fs::read_dir(folder)?
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| name.ends_with(".csv") && name != "MANIFEST.csv")
        .collect();
    names.sort();
    for name in names {
        let path = folder.join(&name);
        let table = TableReader::open(&path)?;
        let find = |known: &[&'static str]| {
            known
                .iter()
                .copied()
                .find(|k| table.header().iter().any(|h| h == k))
        };
        let (Some(input), Some(output)) = (find(&INPUTS), find(&OUTPUTS)) else {
            println!("| {name} | no known columns | | | | | | | |");
            continue;
        };
        let columns = Columns::new(input, output);
        let recording = Recording::read(&path, columns, Repair::Refuse)?.0;
        let run = |operator, solver| -> Result<(FitSummary, Sign), Box<dyn Error>> {
            let options = FitOptions {
                operator,
                solver,
                levels: LEVELS,
                ..FitOptions::default()
            };
            let model = fit(&recording, &options)?;
            let sign = model.sign();
            Ok((model.fit.ok_or("a fit says how it went")?, sign))
        };
        let (mkp, sign) = run(Operator::Mkp, Solver::Nnls)?;
        let (kp, _) = run(Operator::Kp, Solver::Nnls)?;
        let (relay, _) = run(Operator::Relay, Solver::Nnls)?;
        let (least_squares, _) = run(Operator::Mkp, Solver::Ols)?;
        println!(
            "| {} | {input} → {output} | {} | {} | {:.3} | {} | {:.3} | {:.3} | {:.3} |",
            name.trim_end_matches(".csv"),
            mkp.samples,
            if sign == Sign::Positive { "+" } else { "−" },
            mkp.nrmse_percent,
            mkp.weights_not_zero,
            kp.nrmse_percent,
            relay.nrmse_percent,
            least_squares.nrmse_percent,
        );
    }
    Ok(())
}

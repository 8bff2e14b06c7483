//! Fits every recording of a folder, leaves out branches, and prints `docs/measured/recordings.md`:
//! `cargo run --release -p hysteron-measure -- recordings ../shared/data`

use crate::result::Result;
use crate::{folder, scipy};
use hysteron::{
    Candidates, FitOptions, LeftOut, Operator, Progress, Recording, Start, left_out, plane_of,
};

const LEVELS: usize = 20;

pub(crate) fn run(arguments: &[String]) -> Result<()> {
    let folder = folder::named(arguments)?;
    print!("{}", include_str!("text/recordings.md"));
    println!(
        "| recording | samples, branches | MKP auto | levels, smoothness | MKP, K = 20 | KP | \
         relay | SciPy, K = 20 | auto / best |"
    );
    println!("| --- | ---: | ---: | --- | ---: | ---: | ---: | ---: | ---: |");
    for (name, recording) in folder::recordings(&folder)? {
        match recording {
            Some(recording) => row(&name, recording)?,
            None => println!("| {name} | no known columns | | | | | | | |"),
        }
    }
    Ok(())
}

fn row(name: &str, recording: Recording) -> Result<()> {
    eprintln!("{name}");
    let (_, (low, high)) = recording.ranges();
    let recordings = [recording];
    let run = |operator, start, candidates: Option<&Candidates>| {
        let options = FitOptions {
            operator,
            start,
            levels: LEVELS,
            ..FitOptions::plain()
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

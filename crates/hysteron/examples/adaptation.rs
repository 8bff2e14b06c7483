//! Adapts models over measured recordings, and prints `docs/adaptation.md`:
//! `cargo run --release -p hysteron --example adaptation -- ../shared/data`

use hysteron::{
    AdaptOptions, Adaptive, Columns, DriftParts, Errors, FitOptions, Learner, Model, Plane,
    PrepareOptions, Recording, Repair, Start, Step, Turning, adapt, fit, fit_experiment, plane_of,
    prepare,
};
use std::error::Error;
use std::ops::Range;
use std::path::{Path, PathBuf};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

const LEVELS: usize = 20;
/// Passes over a loop that a model is adapted to.
const PASSES: usize = 3;
const LEARNERS: [Learner; 4] = [
    Learner::Gradient,
    Learner::Increments,
    Learner::LeastSquares,
    Learner::Drift,
];

fn main() -> Result<()> {
    let folder = std::env::args()
        .nth(1)
        .ok_or("name the folder of the recordings")?;
    let folder = PathBuf::from(folder);
    print!("{}", include_str!("adaptation.md"));
    cycles(&folder)?;
    stresses(&folder)
}

fn options(learner: Learner, recording: &Recording, model: Option<&Model>) -> AdaptOptions {
    let (_, (lo, hi)) = recording.ranges();
    let env = |name: &str| std::env::var(name).ok().and_then(|v| v.parse::<f64>().ok());
    let steps = matches!(learner, Learner::Gradient | Learner::Increments);
    let keep = |on: bool, v: Option<f64>| if on { v } else { None };
    let spread = |model: Option<&Model>| -> Option<f64> {
        let model = model?;
        let plain = AdaptOptions {
            learner,
            correlation: keep(learner == Learner::LeastSquares, env("CORR")),
            ..AdaptOptions::default()
        };
        let hysteron::Method::LeastSquares { spread, .. } =
            plain.adaptation(model, recording).ok()?.method
        else {
            return None;
        };
        Some(spread * env("SPREADX")?)
    };
    AdaptOptions {
        learner,
        gain: keep(steps, env("GAIN")),
        span: keep(learner == Learner::Increments, env("SPAN")),
        forgetting: keep(!steps, env("FORGET")),
        correlation: keep(learner == Learner::LeastSquares, env("CORR")),
        spread: if learner == Learner::Drift {
            env("SHARE")
        } else if !steps {
            spread(model)
        } else {
            None
        },
        noise: keep(!steps, env("NOISE").map(|v| v * (hi - lo))),
        offset_share: env("KAPPA"),
        trial: env("TRIAL").map(|t| t as u32),
        dead_zone: env("ZONE").map(|v| v * (hi - lo)),
        ..AdaptOptions::default()
    }
}

/// An estimator over `recording`, as `hysteron adapt` would make it.
fn estimator(model: &Model, recording: &Recording, learner: Learner) -> Result<Adaptive> {
    let adaptation = options(learner, recording, Some(model)).adaptation(model, recording)?;
    Ok(match learner {
        Learner::Drift => DriftParts::of(model, None)?.adaptive(adaptation)?,
        _ => Adaptive::new(model, adaptation)?,
    })
}

fn read(folder: &Path, name: &str, columns: Columns<'_>) -> Result<Recording> {
    Ok(Recording::read(&folder.join(format!("{name}.csv")), columns, Repair::Refuse)?.0)
}

fn part(recording: &Recording, range: Range<usize>) -> Recording {
    let mut part = recording.clone();
    let cut = |series: &[f64]| series[range.clone()].to_vec();
    (part.input, part.output) = (cut(&recording.input), cut(&recording.output));
    part.time = recording.time.as_deref().map(cut);
    part.load = recording.load.as_deref().map(cut);
    part
}

fn rmse(measured: &[f64], modelled: &[f64]) -> f64 {
    Errors::between(measured, modelled, |_| true).map_or(f64::NAN, |errors| errors.rmse)
}

/// Thermal cycles, from one highest temperature to the next.
fn cycles(folder: &Path) -> Result<()> {
    let columns = Columns::new("temperature_C", "extension_mm");
    let raw = read(folder, "sma_isobaric_cycles_1_to_4", columns)?;
    // The readout drops its sign below zero: given back, and nothing else done.
    let steps = PrepareOptions {
        spikes: Step::Auto,
        resample: Step::Off,
        low_pass: Step::Off,
        lag: Step::Off,
        band: Step::Off,
    };
    let (whole, _) = prepare(&raw, &steps)?;
    // The load is put on at rest, which temperature says nothing of.
    let warm = whole.input.iter().position(|t| *t < whole.input[0] - 2.0);
    let whole = part(&whole, warm.unwrap_or(0)..whole.len());
    let ((low, high), (least, most)) = whole.ranges();
    let mut turning = Turning::new(0.2 * (high - low));
    let mut bounds = vec![0];
    for &t in &whole.input {
        if let Some((n, hysteron::Direction::Falling)) = turning.push(t)
            && n > 0
        {
            bounds.push(n);
        }
    }
    bounds.push(whole.len());
    let cycles: Vec<Recording> = bounds
        .windows(2)
        .map(|b| part(&whole, b[0]..b[1]))
        .collect();
    let plane = plane_of(&whole, LEVELS)?;
    let fitted = |recording: &Recording| {
        let options = FitOptions {
            start: Start::On,
            range: Some((plane.min(), plane.max())),
            levels: LEVELS,
            ..FitOptions::default()
        };
        fit(recording, &options)
    };
    let first = fitted(&cycles[0])?;
    let percent = |measured: &Recording, output: &[f64]| {
        100.0 * rmse(&measured.output, output) / (most - least)
    };
    let heads: Vec<String> = (2..=cycles.len())
        .map(|n| format!(" cycle {n} |"))
        .collect();
    println!("\n| | {}", heads.concat());
    println!("| --- |{}", " ---: |".repeat(cycles.len() - 1));
    let line = |name: &str, cells: &[f64]| {
        let cells: Vec<String> = cells.iter().map(|c| format!(" {c:.2} |")).collect();
        println!("| {name} |{}", cells.concat());
    };
    let run = |model: &Model, state: &mut hysteron::State, cycle: &Recording| -> Result<Vec<f64>> {
        let mut output = vec![0.0; cycle.len()];
        model.run(state, &cycle.input, &mut output)?;
        Ok(output)
    };
    let mut state = first.saturated();
    let of_first = run(&first, &mut state, &cycles[0])?;
    eprintln!(
        "cycle lengths {:?}, fit of first {:.2}",
        bounds,
        percent(&cycles[0], &of_first)
    );
    let (mut fixed, mut corrected, mut refitted) = (vec![], vec![], vec![]);
    let mut last = 0.0;
    for n in 1..cycles.len() {
        let cycle = &cycles[n];
        let output = run(&first, &mut state, cycle)?;
        fixed.push(percent(cycle, &output));
        let moved: Vec<f64> = output
            .iter()
            .zip(&cycle.output)
            .map(|(h, y)| {
                let moved = h + last;
                last = y - h;
                moved
            })
            .collect();
        corrected.push(percent(cycle, &moved));
        let model = fitted(&cycles[n - 1])?;
        let output = run(&model, &mut model.saturated(), cycle)?;
        refitted.push(percent(cycle, &output));
    }
    line("fixed: model of cycle 1", &fixed);
    line("fixed, and the error of the sample before", &corrected);
    line("fitted to the cycle before", &refitted);
    for learner in LEARNERS {
        let mut adaptive = estimator(&first, &cycles[0], learner)?;
        adaptive.saturate()?;
        for &input in &cycles[0].input {
            adaptive.predict(input)?;
        }
        let (mut next, mut ahead) = (vec![], vec![]);
        for cycle in &cycles[1..] {
            let mut frozen = adaptive.clone();
            let output: Vec<f64> = cycle
                .input
                .iter()
                .map(|&t| frozen.predict(t))
                .collect::<hysteron::Result<_>>()?;
            ahead.push(percent(cycle, &output));
            let samples = cycle.input.iter().zip(&cycle.output);
            let output: Vec<f64> = samples
                .map(|(&t, &y)| Ok(adaptive.step(t, y)?.output))
                .collect::<hysteron::Result<_>>()?;
            next.push(percent(cycle, &output));
        }
        line(&format!("{learner:?}, sample by sample"), &next);
        line(&format!("{learner:?}, whole cycle ahead"), &ahead);
    }
    Ok(())
}

/// A model of one stress, adapted to another.
fn stresses(folder: &Path) -> Result<()> {
    let materials = [
        ("sma_flexinol_", "strain", vec!["50", "150", "200"]),
        (
            "sma_nitihf_bigelow_",
            "strain_percent",
            vec!["7", "50", "100", "200", "400"],
        ),
    ];
    println!("\n| from, to | fixed | refit | gradient | increments | least squares | drift |");
    println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: |");
    for (material, output, stresses) in &materials {
        let columns = Columns {
            load: Some("stress_MPa"),
            ..Columns::new("temperature_C", output)
        };
        let loops: Vec<Recording> = stresses
            .iter()
            .map(|stress| {
                let mut recording = read(folder, &format!("{material}{stress}MPa"), columns)?;
                // The stress as set: what is read wanders about it.
                recording.load = Some(vec![stress.parse()?; recording.len()]);
                Ok(recording)
            })
            .collect::<Result<_>>()?;
        let mut all = loops[0].clone();
        for recording in &loops[1..] {
            all.input.extend(&recording.input);
            all.output.extend(&recording.output);
        }
        let plane = plane_of(&part_of(&all), LEVELS)?;
        for n in 1..loops.len() {
            let name = format!("{material}{} → {}", stresses[n - 1], stresses[n]);
            let models = [
                fitted(&loops[n - 1..n], &plane)?,
                fitted(&loops[n..=n], &plane)?,
            ];
            row(&name, models, &loops[n], &LEARNERS)?;
        }
        let triples: &[[usize; 3]] = match loops.len() {
            3 => &[[0, 2, 1], [0, 1, 2]],
            _ => &[[1, 3, 2], [2, 4, 3], [1, 2, 3], [2, 3, 4]],
        };
        for &[a, b, to] in triples {
            let name = format!(
                "{material}{} and {} → {}",
                stresses[a], stresses[b], stresses[to]
            );
            let pair = [loops[a].clone(), loops[b].clone()];
            let models = [
                fitted_load(&pair, &plane)?,
                fitted(&loops[to..=to], &plane)?,
            ];
            row(&name, models, &loops[to], &[Learner::Drift])?;
        }
    }
    Ok(())
}

fn part_of(recording: &Recording) -> Recording {
    Recording {
        load: None,
        ..recording.clone()
    }
}

fn fit_options(plane: &Plane) -> FitOptions {
    FitOptions {
        range: Some((plane.min(), plane.max())),
        levels: LEVELS,
        sign: Some(hysteron::Sign::Negative),
        ..FitOptions::default()
    }
}

fn fitted(loops: &[Recording], plane: &Plane) -> Result<Model> {
    Ok(fit(&part_of(&loops[0]), &fit_options(plane))?)
}

fn fitted_load(loops: &[Recording], plane: &Plane) -> Result<Model> {
    Ok(fit_experiment(loops, &fit_options(plane), &|_, _| Ok(()))?)
}

fn row(name: &str, [from, to]: [Model; 2], target: &Recording, learners: &[Learner]) -> Result<()> {
    let target = part_of(target);
    let (_, (low, high)) = target.ranges();
    let judge = |model: &Model| -> Result<f64> {
        Ok(100.0 * rmse(&target.output, &model.simulate(&target.input)?) / (high - low))
    };
    let mut passes = target.clone();
    for _ in 1..PASSES {
        passes.input.extend(&target.input);
        passes.output.extend(&target.output);
    }
    let fixed = match &from.load {
        Some(_) => DriftParts::of(&from, None)?.model,
        None => from.clone(),
    };
    let mut cells = vec![
        format!("{:.2}", judge(&fixed)?),
        format!("{:.2}", judge(&to)?),
    ];
    for learner in LEARNERS {
        cells.push(match learners.contains(&learner) {
            true => {
                let one = adapt(&from, &target, &options(learner, &target, Some(&from)))?;
                let more = adapt(&from, &passes, &options(learner, &target, Some(&from)))?;
                format!("{:.2}, {:.2}", judge(&one.model)?, judge(&more.model)?)
                    + &if std::env::var("COUNTS").is_ok() {
                        format!(" {:?}", more.counts)
                    } else {
                        String::new()
                    }
            }
            false => String::new(),
        });
    }
    println!("| {name} | {} |", cells.join(" | "));
    Ok(())
}

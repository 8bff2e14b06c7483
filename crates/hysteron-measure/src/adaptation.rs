//! Adapts models over measured recordings, and prints `docs/measured/adaptation.md`:
//! `cargo run --release -p hysteron-measure -- adaptation ../shared/data`

use crate::folder;
use crate::result::Result;
use hysteron::{
    AdaptOptions, Adaptive, Columns, DriftBasis, Errors, Fit, FitOptions, Learner, Model, Progress,
    Recording, Repair, Sign, Start, State, Window, adapt, plane_of,
};
use hysteron_sim::rig::{Experiment, Reproduction};
use std::ops::Range;
use std::path::Path;

const LEVELS: usize = 20;
/// Passes over a loop that a model is adapted to.
const PASSES: usize = 3;
/// Learners of weights.
const LEARNERS: [(&str, Learner); 5] = [
    ("auto", Learner::Auto),
    ("refit", Learner::Refit),
    ("increments", Learner::Increments),
    ("least squares", Learner::LeastSquares),
    ("drift", Learner::Drift),
];

/// Beginning and end of the names of recordings of one loop at each of several stresses, and the
/// column of the output.
const MATERIALS: [(&str, &[f64], &str); 2] = [
    ("flexinol", &[50.0, 150.0, 200.0], "strain"),
    (
        "nitihf_bigelow",
        &[7.0, 50.0, 100.0, 200.0, 400.0],
        "strain_percent",
    ),
];

pub(crate) fn run(arguments: &[String]) -> Result<()> {
    let folder = &folder::named(arguments)?;
    print!("{}", include_str!("text/adaptation.md"));
    cycles(folder)?;
    print!("\n{}", include_str!("text/adaptation-stress.md"));
    let mut pairs = Vec::new();
    println!(
        "| from → to, MPa | fixed | fitted | auto | refit | increments | least squares | drift \
         | least squares, forgetting 1 |"
    );
    println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for (material, stresses, output) in MATERIALS {
        let loops = Loops::read(folder, material, stresses, output)?;
        for to in 1..stresses.len() {
            loops.row(to - 1, to)?;
        }
        pairs.push(loops);
    }
    print!("\n{}", include_str!("text/adaptation-load.md"));
    println!(
        "| from → to, MPa | middle | at its load | fitted | auto | refit | drift | drift, forgetting 1 | load \
         | load found |"
    );
    println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for loops in pairs {
        for to in 1..loops.stresses.len() {
            if to + 1 < loops.stresses.len() {
                loops.row_of_load([to - 1, to + 1], to)?;
            }
            if to >= 2 {
                loops.row_of_load([to - 2, to - 1], to)?;
            }
        }
    }
    print!("{}", include_str!("text/adaptation-end.md"));
    unchanged()
}

/// The demo's second recording, of the spring that its model is fitted to.
fn unchanged() -> Result<()> {
    let demo = Reproduction::run(&Experiment::default(), [1, 2])?;
    println!("| RMSE, mm | adapting | fixed | written |");
    println!("| --- | ---: | ---: | --- |");
    let longer = AdaptOptions {
        window: Some(Window::Cycles(4)),
        ..adapting(Learner::Refit)
    };
    let each = LEARNERS.map(|(name, learner)| (name, adapting(learner)));
    let others = [
        ("load", adapting(Learner::Load)),
        ("refit, 4 cycles", longer),
    ];
    for (name, options) in each.into_iter().chain(others) {
        let adapted = adapt(&demo.model, &demo.prepared[1], &options, Progress::NONE)?;
        let late = adapted.late.ok_or("no sample judges")?;
        let written = if adapted.worse { "no" } else { "yes" };
        let (adapting, fixed) = (late.adapting.rmse, late.fixed.rmse);
        println!("| {name} | {adapting:.3} | {fixed:.3} | {written} |");
    }
    print!("{}", include_str!("text/adaptation-unchanged.md"));
    Ok(())
}

fn adapting(learner: Learner) -> AdaptOptions {
    AdaptOptions {
        learner,
        ..AdaptOptions::default()
    }
}

/// Least squares that forgets nothing.
fn remembering(learner: Learner) -> AdaptOptions {
    AdaptOptions {
        forgetting: Some(1.0),
        ..adapting(learner)
    }
}

fn read(folder: &Path, name: &str, output: &str) -> Result<Recording> {
    let columns = Columns::new("temperature_C", output);
    let path = folder.join(format!("sma_{name}.csv"));
    Ok(Recording::read(&path, columns, Repair::Refuse)?.0)
}

fn part(recording: &Recording, range: Range<usize>) -> Recording {
    Recording {
        input: recording.input[range.clone()].to_vec(),
        output: recording.output[range].to_vec(),
        ..recording.clone()
    }
}

/// RMSE in percent of a range.
fn percent(measured: &[f64], modelled: &[f64], (low, high): (f64, f64)) -> f64 {
    let errors = Errors::between(measured, modelled, |_| true);
    errors.map_or(f64::NAN, |errors| 100.0 * errors.rmse / (high - low))
}

fn simulated(model: &Model, state: &mut State, input: &[f64]) -> Result<Vec<f64>> {
    let mut output = vec![0.0; input.len()];
    model.run(state, input, &mut output)?;
    Ok(output)
}

fn cycles(folder: &Path) -> Result<()> {
    let raw = read(folder, "isobaric_cycles_1_to_4", "extension_mm")?;
    let (whole, cycles) = crate::cycles::cycles(&raw)?;
    let plane = plane_of(&whole, LEVELS)?;
    let range = cycles[0].ranges().1;
    let fitted = |cycle: &Recording| {
        let options = FitOptions {
            start: Start::On,
            range: Some((plane.min(), plane.max())),
            levels: LEVELS,
            ..FitOptions::plain()
        };
        Fit::from(&options).run(cycle)
    };
    let line = |name: &str, cells: &[f64]| {
        let cells: Vec<String> = cells.iter().map(|c| format!(" {c:.2} |")).collect();
        println!("| {name} |{}", cells.concat());
    };
    let heads: Vec<String> = (2..=cycles.len())
        .map(|n| format!(" cycle {n} |"))
        .collect();
    println!("| |{}", heads.concat());
    println!("| --- |{}", " ---: |".repeat(cycles.len() - 1));

    let first = fitted(&cycles[0])?;
    let mut state = first.saturated();
    simulated(&first, &mut state, &cycles[0].input)?;
    let (mut fixed, mut corrected, mut refitted, mut last) = (vec![], vec![], vec![], 0.0);
    let mut persisted = vec![];
    for pair in cycles.windows(2) {
        let (before, cycle) = (&pair[0], &pair[1]);
        let output = simulated(&first, &mut state, &cycle.input)?;
        fixed.push(percent(&cycle.output, &output, range));
        let mut moved = Vec::new();
        for (h, y) in output.iter().zip(&cycle.output) {
            moved.push(h + last);
            last = y - h;
        }
        corrected.push(percent(&cycle.output, &moved, range));
        let model = fitted(before)?;
        let output = simulated(&model, &mut model.saturated(), &cycle.input)?;
        refitted.push(percent(&cycle.output, &output, range));
        persisted.push(percent(&cycle.output, &persistent(before, cycle), range));
    }
    line("a whole cycle ahead: model of cycle 1, fixed", &fixed);
    line("the output of the cycle before", &persisted);
    line("model fitted to the cycle before", &refitted);
    let mut sample_by_sample = vec![(
        "sample by sample: model of cycle 1, and its error at the sample before".to_owned(),
        corrected,
    )];
    for (name, learner) in LEARNERS {
        let mut adaptive = estimator(&first, &cycles[0], learner)?;
        let (mut ahead, mut next) = (vec![], vec![]);
        for cycle in &cycles[1..] {
            adaptive.refit()?;
            let mut frozen = adaptive.clone();
            let whole = cycle.input.iter().map(|&t| frozen.simulate(t));
            let whole: Vec<f64> = whole.collect::<hysteron::Result<_>>()?;
            ahead.push(percent(&cycle.output, &whole, range));
            let samples = cycle.input.iter().zip(&cycle.output);
            let each = samples.map(|(&t, &y)| Ok(adaptive.step(t, y)?.output));
            let each: Vec<f64> = each.collect::<hysteron::Result<_>>()?;
            next.push(percent(&cycle.output, &each, range));
        }
        line(name, &ahead);
        sample_by_sample.push((name.to_owned(), next));
    }
    for (name, cells) in sample_by_sample {
        line(&name, &cells);
    }
    Ok(())
}

/// What a cycle would be if it were the one `before`: at each input, on the way down and on the way
/// up, the output there.
fn persistent(before: &Recording, cycle: &Recording) -> Vec<f64> {
    let coldest = |recording: &Recording| {
        let places = recording.input.iter().enumerate();
        let coldest = places.min_by(|a, b| a.1.total_cmp(b.1));
        coldest.map_or(0, |(n, _)| n)
    };
    let turn = coldest(before);
    let branch = |range: Range<usize>| {
        let part = part(before, range);
        let mut points: Vec<(f64, f64)> = part.input.into_iter().zip(part.output).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    };
    let (down, up) = (branch(0..turn + 1), branch(turn..before.len()));
    let here = coldest(cycle);
    let inputs = cycle.input.iter().enumerate();
    let each = inputs.map(|(n, &t)| between(if n <= here { &down } else { &up }, t));
    each.collect()
}

/// The value at `t` on a polygon through points in order; beyond its ends that of the end.
fn between(points: &[(f64, f64)], t: f64) -> f64 {
    let n = points.partition_point(|point| point.0 < t);
    let (low, high) = (points[n.saturating_sub(1)], points[n.min(points.len() - 1)]);
    match high.0 > low.0 {
        true => low.1 + (high.1 - low.1) * (t - low.0) / (high.0 - low.0),
        false => high.1,
    }
}

/// A learner as [`adapt`] makes it, at the end of the recording that its model was fitted to.
fn estimator(model: &Model, seen: &Recording, learner: Learner) -> Result<Adaptive> {
    let options = AdaptOptions {
        start: Start::On,
        ..adapting(learner)
    };
    let mut adaptive = options.adaptive_after(model, seen)?;
    for &input in &seen.input {
        adaptive.simulate(input)?;
    }
    Ok(adaptive)
}

/// One loop at each of several stresses.
struct Loops {
    material: &'static str,
    stresses: &'static [f64],
    loops: Vec<Recording>,
    options: FitOptions,
}

impl Loops {
    fn read(
        folder: &Path,
        material: &'static str,
        stresses: &'static [f64],
        output: &str,
    ) -> Result<Self> {
        let each = stresses.iter();
        let each = each.map(|stress| read(folder, &format!("{material}_{stress}MPa"), output));
        let loops: Vec<Recording> = each.collect::<Result<_>>()?;
        let mut all = loops[0].clone();
        for recording in &loops[1..] {
            all.input.extend(&recording.input);
            all.output.extend(&recording.output);
        }
        let plane = plane_of(&all, LEVELS)?;
        Ok(Self {
            material,
            stresses,
            loops,
            options: FitOptions {
                range: Some((plane.min(), plane.max())),
                levels: LEVELS,
                // A strain is recovered on heating; at the lowest stress there is hardly any to
                // tell that from.
                sign: Some(Sign::Negative),
                ..FitOptions::plain()
            },
        })
    }

    /// Error of a model on a loop, run freely.
    fn judge(&self, model: &Model, to: usize) -> Result<f64> {
        let target = &self.loops[to];
        let output = model.simulate(&target.input)?;
        Ok(percent(&target.output, &output, target.ranges().1))
    }

    /// Errors of a model that was adapted to a loop, after one pass and after [`PASSES`].
    fn adapted(&self, model: &Model, to: usize, options: &AdaptOptions) -> Result<String> {
        let target = &self.loops[to];
        let after = |passes: usize| -> Result<f64> {
            let many = Recording {
                input: target.input.repeat(passes),
                output: target.output.repeat(passes),
                ..target.clone()
            };
            self.judge(&adapt(model, &many, options, Progress::NONE)?.model, to)
        };
        Ok(format!("{:.1}, {:.1}", after(1)?, after(PASSES)?))
    }

    /// The load that the method `load` finds in one pass through a loop.
    fn load_found(&self, model: &Model, to: usize) -> Result<f64> {
        let options = adapting(Learner::Load);
        let found = adapt(model, &self.loops[to], &options, Progress::NONE)?.shift;
        let load = found.and_then(|found| found.load);
        Ok(load.ok_or("the shift tells no load")?)
    }

    fn row(&self, from: usize, to: usize) -> Result<()> {
        let model = |n: usize| Fit::from(&self.options).run(&self.loops[n]);
        let before = model(from)?;
        let options = LEARNERS.map(|(_, learner)| adapting(learner));
        let options = options
            .into_iter()
            .chain([remembering(Learner::LeastSquares)]);
        let adapted = options.map(|options| self.adapted(&before, to, &options));
        println!(
            "| {} {} → {} | {:.1} | {:.1} | {} |",
            self.material,
            self.stresses[from],
            self.stresses[to],
            self.judge(&before, to)?,
            self.judge(&model(to)?, to)?,
            adapted.collect::<Result<Vec<_>>>()?.join(" | "),
        );
        Ok(())
    }

    fn row_of_load(&self, from: [usize; 2], to: usize) -> Result<()> {
        let under = |n: usize| Recording {
            load: Some(vec![self.stresses[n]; self.loops[n].len()]),
            ..self.loops[n].clone()
        };
        let model = Fit::from(&self.options).run(&from.map(under))?;
        let middle = DriftBasis::of(&model, None)?.model;
        let known = match model.at_load(self.stresses[to]) {
            Ok(model) => format!("{:.1}", self.judge(&model, to)?),
            Err(_) => "outside".into(),
        };
        println!(
            "| {} {} and {} → {} | {:.1} | {known} | {:.1} | {} | {} | {} | {} | {} | {:.0} |",
            self.material,
            self.stresses[from[0]],
            self.stresses[from[1]],
            self.stresses[to],
            self.judge(&middle, to)?,
            self.judge(&Fit::from(&self.options).run(&self.loops[to])?, to)?,
            self.adapted(&model, to, &adapting(Learner::Auto))?,
            self.adapted(&model, to, &adapting(Learner::Refit))?,
            self.adapted(&model, to, &adapting(Learner::Drift))?,
            self.adapted(&model, to, &remembering(Learner::Drift))?,
            self.adapted(&model, to, &adapting(Learner::Load))?,
            self.load_found(&model, to)?,
        );
        Ok(())
    }
}

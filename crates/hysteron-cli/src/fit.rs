//! `hysteron fit`

mod lines;

use crate::columns::{Given, Named};
use crate::prepare::BeforeFit;
use crate::terminal::{Result, print, say};
use crate::{args, hold_out, prepare, progress, recording, text};
use hysteron::{
    Advice, Choice, Columns, Dynamics, Fit, FitOptions, FitSummary, HeldOut, HoldOut, LoadLaw,
    Model, Preparation, Progress, RateDependence, Recording, Sign, Solver, Spacing, Step, Verdict,
    prior_of_fleet,
};
use hysteron_files::shell_word;
use lines::to_text;
use serde_json::json;
use std::path::{Path, PathBuf};

pub(crate) fn run(args: &args::Fit) -> Result<()> {
    if args.out == Path::new("-") {
        return Err("a model goes to a file: name one with -o".into());
    }
    let how = &args.how;
    let held_out = how.tests.hold_out.iter().filter_map(|what| match what {
        args::HoldOut::File(file) => Some(file),
        args::HoldOut::Part(_) => None,
    });
    let inputs = args.data.iter().chain(&args.repeat).chain(held_out);
    let inputs: Vec<&Path> = inputs.map(PathBuf::as_path).collect();
    let given = Given::of(&how.columns, how.quantities.load.as_deref());
    let named = Named::of(inputs[0], &given, &how.repair)?;
    if let Some(load) = &named.unused_load {
        let word = shell_word(load);
        say(format_args!(
            "`{load}` is not used: with --load {word} the model depends on it"
        ));
    }
    let columns = named.columns();
    let file = Model::file(args.force.target(&args.out, &inputs))?;
    let (mut recordings, mut reports) = (Vec::new(), Vec::new());
    let mut doubts = 0;
    for data in &args.data {
        for one in read(args, data, columns)? {
            recordings.push(one.recording);
            reports.push((one.report, one.rate));
            doubts += one.doubts;
        }
    }
    let read = |file: &Path| {
        let read = read(args, file, columns)?.into_iter();
        Ok(read.map(|one| one.recording).collect())
    };
    let mut repeats = Vec::new();
    for file in &args.repeat {
        let more: Vec<Recording> = read(file)?;
        repeats.extend(more);
    }
    let what = hold_out::what(args, read)?;
    let (model, held_out) = identify(args, &recordings, repeats, what.as_ref())?;
    file.commit_with(model.to_json().as_bytes())?;

    prepare::after_fit(&model, reports.iter().map(|(_, rate)| rate.as_ref()));
    let mut clipped = 0;
    let mut advice = prepare::advice(&model, &recordings, &how.prepare)?;
    advice.extend(held_out.iter().flat_map(HeldOut::advice));
    for advice in advice {
        say(format_args!("{}", crate::remedy::text_of_advice(&advice)));
        if let Advice::Clipped { inputs, .. } = advice {
            clipped = inputs;
        }
    }
    let verdict = Verdict::of_fit_holding_out(&model, &recordings, what.as_ref())?;
    let verdict = verdict.doubting(doubts);
    match (&model.fit, args.json.json) {
        (None, _) => Ok(()),
        (Some(fit), true) => {
            let mut object = to_json(args, &model, fit, clipped, &reports);
            object["verdict"] = json!(verdict);
            if let Some(held_out) = &held_out {
                object["hold_out"] = json!(held_out);
            }
            print(&object.to_string())
        }
        (Some(fit), false) => {
            let held_out = held_out.map(|held_out| hold_out::to_text(&held_out, &model));
            let lines = [Some(to_text(args, &model, fit, &recordings)), held_out];
            let lines = lines.into_iter().flatten().collect::<Vec<_>>().join("\n");
            print(&format!("{lines}\n\n{}", text::verdict(&verdict)))
        }
    }
}

/// The recordings of a file with the units asked for, and prepared.
fn read(args: &args::Fit, data: &Path, columns: Columns<'_>) -> Result<Vec<BeforeFit>> {
    let recordings = recording::segments(data, columns, &args.how.repair)?;
    let count = recordings.len();
    let each = recordings
        .into_iter()
        .enumerate()
        .map(|(n, mut recording)| {
            let units = [
                (
                    &args.how.quantities.input_unit,
                    &mut recording.input_quantity,
                ),
                (
                    &args.how.quantities.output_unit,
                    &mut recording.output_quantity,
                ),
            ];
            for (unit, quantity) in units {
                if unit.is_some() {
                    quantity.unit.clone_from(unit);
                }
            }
            prepare::before_fit(recording, &args.how.prepare, &recording::which(n, count))
        });
    each.collect()
}

fn identify(
    args: &args::Fit,
    recordings: &[Recording],
    repeats: Vec<Recording>,
    what: Option<&HoldOut>,
) -> Result<(Model, Option<HeldOut>)> {
    let bar = progress::stages();
    let report = |stage: &'static str, done: f64| {
        progress::stage(&bar, stage, done);
        Ok(())
    };
    let fit = fit_of(&args.how)?.repeats(repeats);
    let fit = fit.progress(Progress::new(&report));
    let found = match what {
        None => (fit.run(recordings)?, None),
        Some(what) => {
            let (model, held_out) = hysteron::fit_holding_out(&fit, recordings, what)?;
            (model, Some(held_out))
        }
    };
    bar.finish_and_clear();
    Ok(found)
}

/// The fit that the options ask for.
pub(crate) fn fit_of(args: &args::FitHow) -> Result<Fit<'static>> {
    let levels = match args.plane.levels {
        args::Levels::Auto => Choice::Auto,
        args::Levels::Fixed(levels) => Choice::Fixed(levels),
    };
    let options = FitOptions {
        operator: args.plane.operator.into(),
        range: args.plane.range,
        solver: match args.weights.solver {
            args::Solver::Nnls => Solver::Nnls,
            args::Solver::Ols => Solver::Ols,
        },
        sign: match args.plane.sign {
            args::Sign::Auto => None,
            args::Sign::Positive => Some(Sign::Positive),
            args::Sign::Negative => Some(Sign::Negative),
        },
        offset: args.plane.offset,
        ridge: args.weights.ridge,
        robust: args.weights.robust == args::Robust::Auto,
        load_law: match args.stages.load_law {
            args::LoadLaw::Auto => LoadLaw::Auto,
            args::LoadLaw::Shift => LoadLaw::Shift,
            args::LoadLaw::Weights => LoadLaw::Weights,
        },
        load_degree: match args.stages.load_degree {
            args::Degree::Auto => None,
            args::Degree::Fixed(degree) => Some(degree),
        },
        spacing: match args.plane.spacing {
            args::Spacing::Uniform => Spacing::Uniform,
            args::Spacing::Auto => Spacing::Auto,
        },
        delay: count("delay", args.stages.delay)?,
        creep: count("creep", args.stages.creep)?,
        lag: match args.stages.lag {
            Step::Auto => Choice::Auto,
            Step::Off => Choice::Fixed(0.0),
            Step::Value(lag) => Choice::Fixed(lag),
        },
        dynamics: match args.stages.dynamics {
            args::Dynamics::Auto => Dynamics::Auto,
            args::Dynamics::Off => Dynamics::Off,
            args::Dynamics::Lag => Dynamics::Lag,
            args::Dynamics::Ring => Dynamics::Ring,
        },
        curve: count("curve", args.stages.curve)?,
        ..FitOptions::plain()
    };
    let mut fit = Fit::from(options)
        .levels(levels)
        .smooth(args.weights.smooth)
        .start(args.weights.start)
        .bootstrap(args.tests.bootstrap.map_or(Choice::Auto, Choice::Fixed));
    if let Some(body) = args.stages.thermal {
        fit = fit.thermal(body);
    }
    match &args.weights.prior {
        Some(models) => Ok(fit.prior(prior_of_fleet(models)?)),
        None => Ok(fit),
    }
}

fn to_json(
    args: &args::Fit,
    model: &Model,
    fit: &FitSummary,
    clipped: usize,
    reports: &[(Option<Preparation>, Option<RateDependence>)],
) -> serde_json::Value {
    let plane = model.plane();
    let preparation: Vec<_> = reports.iter().map(|(report, _)| report).collect();
    let rate: Vec<_> = reports.iter().map(|(_, rate)| rate).collect();
    json!({
        "model": args.out,
        "operators": plane.operators(),
        "plane": {"min": plane.min(), "max": plane.max(), "levels": plane.levels()},
        "offset": model.offset(),
        "sign": model.sign().factor() as i64,
        "clipped": clipped,
        "thermal": model.thermal,
        "fit": fit,
        "preparation": preparation,
        "rate": rate,
    })
}

/// How many of something: terms, pieces.
fn count(option: &str, step: Step) -> Result<Choice<usize>> {
    match step {
        Step::Auto => Ok(Choice::Auto),
        Step::Off => Ok(Choice::Fixed(0)),
        Step::Value(count) if count.fract() == 0.0 && count >= 0.0 => {
            Ok(Choice::Fixed(count as usize))
        }
        Step::Value(count) => Err(format!("--{option} {count}: a whole number is needed").into()),
    }
}

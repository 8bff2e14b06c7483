//! `hysteron fit`

use crate::terminal::{Result, print, say};
use crate::{args, hold_out, prepare, progress, recording, text};
use hysteron::{
    Advice, Choice, Columns, Criterion, FirstOrder, Fit, FitOptions, FitSummary, HeldOut, HoldOut,
    LoadLaw, Model, Preparation, Progress, RateDependence, Recording, Sign, Smooth, Solver,
    Spacing, Step, Validation, prior_of_fleet,
};
use serde_json::json;
use std::path::{Path, PathBuf};

pub(crate) fn run(args: &args::Fit) -> Result<()> {
    let columns = Columns {
        time: args.how.prepare.time.as_deref(),
        load: args.how.load.as_deref(),
        ..Columns::new(&args.how.input, &args.how.output)
    };
    if args.out == Path::new("-") {
        return Err("a model goes to a file: name one with -o".into());
    }
    let held_out = args.how.hold_out.iter().filter_map(|what| match what {
        args::HoldOut::File(file) => Some(file),
        args::HoldOut::Part(_) => None,
    });
    let inputs = args.data.iter().chain(&args.repeat).chain(held_out);
    let inputs: Vec<&Path> = inputs.map(PathBuf::as_path).collect();
    let file = Model::file(args.force.target(&args.out, &inputs))?;
    let (mut recordings, mut reports) = (Vec::new(), Vec::new());
    for data in &args.data {
        for (recording, preparation, rate) in read(args, data, columns)? {
            recordings.push(recording);
            reports.push((preparation, rate));
        }
    }
    let read = |file: &Path| {
        let read = read(args, file, columns)?.into_iter();
        Ok(read.map(|(recording, ..)| recording).collect())
    };
    let mut repeats = Vec::new();
    for file in &args.repeat {
        let more: Vec<Recording> = read(file)?;
        repeats.extend(more);
    }
    let what = hold_out::what(args, read)?;
    let (model, held_out) = identify(args, &recordings, repeats, what.as_ref())?;
    file.commit_with(model.to_json().as_bytes())?;

    let mut clipped = 0;
    let mut advice = hysteron::advice(&model, &recordings)?;
    advice.extend(held_out.iter().flat_map(HeldOut::advice));
    for advice in advice {
        say(format_args!("{}", crate::remedy::text_of_advice(&advice)));
        if let Advice::Clipped { inputs, .. } = advice {
            clipped = inputs;
        }
    }
    match (&model.fit, args.json.json) {
        (None, _) => Ok(()),
        (Some(fit), true) => {
            let mut object = to_json(args, &model, fit, clipped, &reports);
            if let Some(held_out) = &held_out {
                object["hold_out"] = json!(held_out);
            }
            print(&object.to_string())
        }
        (Some(fit), false) => {
            let held_out = held_out.map(|held_out| hold_out::to_text(&held_out, &model));
            let lines = [Some(to_text(args, &model, fit)), held_out];
            print(&lines.into_iter().flatten().collect::<Vec<_>>().join("\n"))
        }
    }
}

/// The recordings of a file with the units asked for, and prepared.
fn read(args: &args::Fit, data: &Path, columns: Columns<'_>) -> Result<Vec<Prepared>> {
    let recordings = recording::segments(data, columns, &args.how.repair)?;
    let count = recordings.len();
    let each = recordings
        .into_iter()
        .enumerate()
        .map(|(n, mut recording)| {
            let units = [
                (&args.how.input_unit, &mut recording.input_quantity),
                (&args.how.output_unit, &mut recording.output_quantity),
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
    let levels = match args.levels {
        args::Levels::Auto => Choice::Auto,
        args::Levels::Fixed(levels) => Choice::Fixed(levels),
    };
    let options = FitOptions {
        operator: args.operator.into(),
        range: args.range,
        solver: match args.solver {
            args::Solver::Nnls => Solver::Nnls,
            args::Solver::Ols => Solver::Ols,
        },
        sign: match args.sign {
            args::Sign::Auto => None,
            args::Sign::Positive => Some(Sign::Positive),
            args::Sign::Negative => Some(Sign::Negative),
        },
        offset: args.offset,
        ridge: args.ridge,
        robust: args.robust == args::Robust::Auto,
        load_law: match args.load_law {
            args::LoadLaw::Shift => LoadLaw::Shift,
            args::LoadLaw::Weights => LoadLaw::Weights,
        },
        load_degree: match args.load_degree {
            args::Degree::Auto => None,
            args::Degree::Fixed(degree) => Some(degree),
        },
        spacing: match args.spacing {
            args::Spacing::Uniform => Spacing::Uniform,
            args::Spacing::Auto => Spacing::Auto,
        },
        creep: count("creep", args.creep)?,
        lag: match args.lag {
            Step::Auto => Choice::Auto,
            Step::Off => Choice::Fixed(0.0),
            Step::Value(lag) => Choice::Fixed(lag),
        },
        curve: count("curve", args.curve)?,
        ..FitOptions::plain()
    };
    let fit = Fit::from(options)
        .levels(levels)
        .smooth(args.smooth)
        .start(args.start)
        .bootstrap(args.bootstrap.map_or(Choice::Auto, Choice::Fixed))
        .thermal(args.thermal.is_some());
    match &args.prior {
        Some(models) => Ok(fit.prior(prior_of_fleet(models)?)),
        None => Ok(fit),
    }
}

type Prepared = (Recording, Option<Preparation>, Option<RateDependence>);

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

fn to_text(args: &args::Fit, model: &Model, fit: &FitSummary) -> String {
    let negative = model.weights().iter().filter(|mu| **mu < 0.0).count();
    let mut lines = vec![
        format!(
            "{}: {} samples, {} of {} weights not zero{}",
            args.out.display(),
            fit.samples,
            fit.weights_not_zero,
            model.plane().operators(),
            match negative {
                0 => String::new(),
                count => format!(", {count} below zero (no inverse)"),
            },
        ),
        format!(
            "RMSE {} ({:.2} % of the range), largest error {}",
            text::with_unit(fit.rmse, &model.output),
            fit.nrmse_percent,
            text::with_unit(fit.max_abs, &model.output),
        ),
    ];
    lines.extend(
        fit.validation
            .as_ref()
            .map(|found| choice_line(model, fit, found)),
    );
    lines.extend(outliers_line(fit, model));
    lines.extend(model.thermal.as_ref().map(thermal_line));
    lines.extend(load_line(model));
    lines.extend(after_line(model, args));
    lines.extend(curve_line(model, args));
    lines.extend(start_line(fit));
    lines.extend(prior_line(fit));
    lines.extend(text::confidence(fit, model));
    lines.join("\n")
}

/// What was chosen, why, and what it was better than.
fn choice_line(model: &Model, fit: &FitSummary, found: &Validation) -> String {
    let Smooth { along, across } = fit.smooth;
    let smooth = match fit.smooth.is_none() {
        true => "no smoothness".to_owned(),
        false => format!("smoothness {along:e} along, {across:e} across"),
    };
    let spacing = match model.spacing().is_empty() {
        true => "",
        false => " close together where the output moves",
    };
    let by = match found.criterion {
        Criterion::LeftOut => "the error on branches left out",
        Criterion::Evidence => "the evidence, as there are few branches",
    };
    let parts = if found.whole_branches {
        ""
    } else {
        "parts of "
    };
    let plain = found.scores.iter().filter(|score| score.smooth.is_none());
    let plain = plain.min_by(|a, b| a.rmse.total_cmp(&b.rmse));
    let better = match (found.criterion, plain) {
        (Criterion::LeftOut, Some(plain)) if !fit.smooth.is_none() => format!(
            " ({:.2} % with {} levels without smoothness)",
            found.nrmse_percent * plain.rmse / found.rmse.max(f64::MIN_POSITIVE),
            plain.levels,
        ),
        _ => String::new(),
    };
    format!(
        "{} levels{spacing}, {smooth}, chosen by {by}: {:.2} % of the range on {parts}branches \
         left out{better}",
        model.plane().levels(),
        found.nrmse_percent,
    )
}

/// Which readings had no weight: the first few by recording and row, counted from 1.
fn outliers_line(fit: &FitSummary, model: &Model) -> Option<String> {
    const NAMED: usize = 5;
    let count = fit.outliers.len();
    let named = fit.outliers.iter().take(NAMED).map(|outlier| {
        let recording = match fit.other_files.is_empty() {
            true => String::new(),
            false => format!("recording {}, ", outlier.recording + 1),
        };
        let by = text::with_unit(outlier.by, &model.output);
        format!("{recording}sample {} by {by}", outlier.sample + 1)
    });
    let named = named.collect::<Vec<_>>().join("; ");
    let more = if count > NAMED { "; …" } else { "" };
    (count > 0)
        .then(|| format!("{count} outliers without weight, and not in these errors: {named}{more}"))
}

/// What the load does.
fn load_line(model: &Model) -> Option<String> {
    let load = model.load.as_ref()?;
    let curves = load.curves.as_ref()?;
    let unit = |quantity: &hysteron::Quantity| {
        let name = || quantity.name.clone();
        quantity.unit.clone().unwrap_or_else(name)
    };
    let (input, weight) = (unit(&model.input), unit(&load.quantity));
    let [low, high] = [load.range().0, load.range().1].map(text::number);
    // The field states the slope of the phase diagram: load per temperature.
    let slope = match curves.slope() {
        0.0 => "does not shift the axis".into(),
        slope => format!(
            "shifts the axis by {} {input}/{weight} ({} {weight}/{input})",
            text::number(slope),
            text::number(1.0 / slope),
        ),
    };
    let scaled = if curves.scales.is_empty() {
        ""
    } else {
        ", scales it"
    };
    let weights = match (curves.gains.is_empty(), load.weights_order()) {
        (false, _) => "changes stroke and offset".into(),
        (true, order) => format!("changes the weights with order {order}"),
    };
    let name = &load.quantity.name;
    Some(format!(
        "{name} from {low} to {high}: it {slope}{scaled}, and {weights}"
    ))
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

/// The output curve; said where it was asked for.
fn curve_line(model: &Model, args: &args::Fit) -> Option<String> {
    let constants = model.constants();
    match constants.get("curve_sums").len() {
        0 if args.how.curve == Step::Off => None,
        0 => Some("no output curve: it does not predict parts of the recording left out".into()),
        knots => Some(format!("output curve of {} pieces", knots - 1)),
    }
}

/// What happens after the operators; said where it was asked for.
fn after_line(model: &Model, args: &args::Fit) -> Option<String> {
    let (creep, lag) = (model.creep(), model.lag());
    let asked = args.how.creep != Step::Off || args.how.lag != Step::Off;
    let mut said = Vec::new();
    for term in &creep {
        said.push(format!(
            "creep of {:.2} % with {} s",
            100.0 * term.coefficient,
            text::number(term.tau)
        ));
    }
    if lag > 0.0 {
        said.push(format!("lag of {} s", text::number(lag)));
    }
    match (said.is_empty(), asked) {
        (_, false) => None,
        (true, true) => {
            Some("no creep and no lag: they do not predict parts of the recording left out".into())
        }
        (false, true) => Some(said.join(", ")),
    }
}

fn prior_line(fit: &FitSummary) -> Option<String> {
    let models = fit.other.get("prior")?.get("models")?;
    Some(format!(
        "what the recording does not say is taken from {models} other actuators"
    ))
}

/// The start that was found; what the weights alone would fit, where that says more.
fn start_line(fit: &FitSummary) -> Option<String> {
    if let Some(rest) = fit.other.get("rest") {
        let [first, second] = [0, 1].map(|n| rest.get(n).and_then(|x| x.as_f64()));
        let (first, second) = (first.map(text::number)?, second.map(text::number)?);
        let at = match first == second {
            true => first,
            false => format!("{first}, then {second}"),
        };
        return Some(format!(
            "start: all off, then at rest at an input of {at}, then the first input; kept in the model"
        ));
    }
    let found = fit.other.get("start_found")?;
    let free = found.get("free_nrmse_percent")?.as_f64()?;
    Some(format!(
        "start found from the first {} samples and kept in the model: all errors are from it; with \
         every operator free at the start, which no input may lead to, {free:.2} % of the range",
        found.get("samples")?
    ))
}

fn thermal_line(body: &FirstOrder) -> String {
    let [heating, cooling] = [body.tau_heating, body.tau_cooling].map(text::number);
    match body.tau_heating == body.tau_cooling {
        true => format!(
            "thermal body: time constant {heating} s; heating and cooling are not told apart, \
             which takes drives of different shape, such as a ramp and a step"
        ),
        false => format!("thermal body: time constants {heating} s heating, {cooling} s cooling"),
    }
}

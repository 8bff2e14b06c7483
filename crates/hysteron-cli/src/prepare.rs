//! `hysteron prepare`, and the same steps before a fit.

use crate::remedy::say_doubts;
use crate::terminal::{Result, print, say};
use crate::{args, recording, text};
use hysteron::{
    Advice, Columns, Judged, LowPass, Model, Place, Preparation, PrepareOptions, Progress,
    Quantity, RateDependence, Recording, Repairs, SensorLag, Smoothed, Step, TableWriter,
};
use serde_json::json;

pub(crate) fn run(args: &args::Prepare) -> Result<()> {
    let inputs = [args.data.as_path()];
    let table = TableWriter::plain(Some(args.force.target(&args.out, &inputs)))?;
    let columns = Columns {
        time: args.time.as_deref(),
        ..Columns::new(&args.input, &args.output)
    };
    let (recordings, others) = recording::segments_with_others(&args.data, columns, &args.repair)?;
    let options = options(&args.steps, args.sensor_lag, PrepareOptions::default());
    let (mut prepared, mut reports) = (Vec::new(), Vec::new());
    for recording in &recordings {
        let (recording, report) = hysteron::prepare(recording, &options, Progress::NONE)?;
        reports.push((report, hysteron::rate_dependence(&recording)?));
        prepared.push(recording);
    }
    let left_out = others.write_to(&prepared, &recordings, table)?;
    if !left_out.is_empty() {
        let names = left_out.join(", ");
        say(format_args!(
            "left out, because text cannot be resampled: {names}"
        ));
    }
    if args.json.json {
        let each = reports.iter().map(|(report, rate)| {
            json!({
                "preparation": report,
                "rate": rate,
                "rate_dependent": is_material(rate),
            })
        });
        let object = json!({"table": args.out, "recordings": each.collect::<Vec<_>>()});
        return print(&object.to_string());
    }
    let count = |of: fn(&Preparation) -> usize| -> usize {
        reports.iter().map(|(report, _)| of(report)).sum()
    };
    let mut said = vec![format!(
        "{}: {} samples of {}",
        args.out.display(),
        count(|report| report.samples),
        count(|report| report.samples_before)
    )];
    for (n, ((report, rate), recording)) in reports.iter().zip(&recordings).enumerate() {
        let lines = lines(report, recording).into_iter();
        let lines = lines.chain(rate.as_ref().map(rate_line));
        said.extend(lines.map(|line| recording::which(n, recordings.len()) + &line));
    }
    print(&said.join("\n"))
}

/// The recording after the steps that were asked for: none without `--prepare` or a step's own
/// option. The report goes to standard error, behind `which` recording it is.
pub(crate) fn asked_for(
    recording: Recording,
    args: &args::PrepareFirst,
    which: &str,
) -> Result<(Recording, Option<Preparation>)> {
    let options = steps_of(args);
    if options == PrepareOptions::all(Step::Off) {
        return Ok((recording, None));
    }
    let (prepared, report) = hysteron::prepare(&recording, &options, Progress::NONE)?;
    for line in lines(&report, &recording) {
        say(format_args!("{which}{line}"));
    }
    Ok((prepared, Some(report)))
}

/// The recordings of a file, each after the steps that were asked for.
pub(crate) fn each_asked_for(
    recordings: Vec<Recording>,
    args: &args::PrepareFirst,
) -> Result<Vec<Recording>> {
    let count = recordings.len();
    let each = recordings.into_iter().enumerate();
    let each = each.map(|(n, one)| Ok(asked_for(one, args, &recording::which(n, count))?.0));
    each.collect()
}

/// What is to be said of a fit to recordings that were prepared as asked for.
pub(crate) fn advice(
    model: &Model,
    recordings: &[Recording],
    args: &args::PrepareFirst,
) -> Result<Vec<Advice>> {
    let mut advice = hysteron::advice(model, recordings)?;
    if args.prepare {
        // What the preparation left, it has judged.
        advice.retain(|one| !one.is_judged_by_preparation());
    }
    Ok(advice)
}

/// Whether a model of the prepared recordings errs less on what it leaves out of them than this one
/// of the recordings as they are. Recordings that cannot be prepared are no better.
pub(crate) fn helps(
    recordings: &[Recording],
    model: &Model,
    fit: impl Fn(&[Recording]) -> Result<Model>,
) -> Result<bool> {
    let options = PrepareOptions::default();
    let ready = recordings.iter();
    let ready = ready.map(|one| Ok(hysteron::prepare(one, &options, Progress::NONE)?.0));
    let Ok(ready) = ready.collect::<hysteron::Result<Vec<Recording>>>() else {
        return Ok(false);
    };
    let left_out = |model: &Model| Some(model.fit.as_ref()?.validation.as_ref()?.rmse);
    let with = fit(&ready).ok().as_ref().and_then(left_out);
    Ok(with
        .zip(left_out(model))
        .is_some_and(|(with, without)| with < without))
}

/// A recording to be fitted, and what is known of it before.
pub(crate) struct BeforeFit {
    pub(crate) recording: Recording,
    pub(crate) report: Option<Preparation>,
    pub(crate) rate: Option<RateDependence>,
    /// The number of doubts that were said.
    pub(crate) doubts: usize,
}

/// As [`asked_for`], with what a fit is warned of; the report is for the JSON.
pub(crate) fn before_fit(
    recording: Recording,
    args: &args::PrepareFirst,
    which: &str,
) -> Result<BeforeFit> {
    let (recording, report) = asked_for(recording, args, which)?;
    let doubts = match report {
        None => doubts_said(&recording, which)?,
        // With the preparation they are refused.
        Some(_) => 0,
    };
    Ok(BeforeFit {
        rate: hysteron::rate_dependence(&recording)?,
        doubts,
        recording,
        report,
    })
}

/// Says what in a recording is not to be believed; returns the number of doubts.
pub(crate) fn doubts_said(recording: &Recording, which: &str) -> Result<usize> {
    let doubts = hysteron::doubts(recording)?;
    say_doubts(&doubts, which);
    Ok(doubts.len())
}

/// Says how the loops of recordings depend on rate, if their model does not follow that.
pub(crate) fn after_fit<'a>(
    model: &Model,
    rates: impl ExactSizeIterator<Item = Option<&'a RateDependence>>,
) {
    if model.is_timed() || !model.delay().is_none() {
        return;
    }
    let count = rates.len();
    for (n, rate) in rates.enumerate() {
        let missed = rate.filter(|rate| rate.is_material());
        if let Some(rate) = missed {
            let which = crate::recording::which(n, count);
            say(format_args!("{which}{}", rate_line(rate)));
        }
    }
}

/// The steps that were asked for before a fit.
pub(crate) fn steps_of(args: &args::PrepareFirst) -> PrepareOptions {
    let defaults = match args.prepare {
        true => PrepareOptions::default(),
        false => PrepareOptions::all(Step::Off),
    };
    options(&args.steps, args.sensor_lag, defaults)
}

fn is_material(rate: &Option<RateDependence>) -> Option<bool> {
    rate.as_ref().map(RateDependence::is_material)
}

fn options(steps: &args::Steps, lag: Option<Step>, defaults: PrepareOptions) -> PrepareOptions {
    PrepareOptions {
        signs: steps
            .signs
            .map_or(defaults.signs, |signs| signs == args::OnOff::On),
        spikes: steps.spikes.unwrap_or(defaults.spikes),
        resample: steps.resample.unwrap_or(defaults.resample),
        low_pass: steps.low_pass.unwrap_or(defaults.low_pass),
        lag: lag.unwrap_or(defaults.lag),
        dead_band: steps.dead_band.unwrap_or(defaults.dead_band),
        believe: steps.believe || defaults.believe,
    }
}

/// What a step that was left to the data gained.
fn judged_line(judged: &Judged, output: &Quantity) -> String {
    let step = judged.step;
    let samples = hysteron::counted(judged.samples, "sample");
    let verdict = if judged.kept { "taken" } else { "not taken" };
    match (judged.before, judged.after) {
        (Some(before), Some(after)) if judged.is_on_simulated() => format!(
            "{step}: {verdict}. On a simulated recording like this one, with this noise, it leaves \
             {} of it, of {}",
            output.text(after),
            output.text(before)
        ),
        (Some(before), Some(after)) => format!(
            "{step}: {verdict}. With its {samples} a model errs by {} on what it did not \
             see, without by {}",
            output.text(after),
            output.text(before)
        ),
        _ => format!(
            "{step}: {verdict}. The recording is too short to tell whether its {samples} \
             help"
        ),
    }
}

/// Where the samples that are listed stand in the file, if they have lines there.
fn lines_of(repairs: &Repairs, recording: &Recording) -> String {
    let places = repairs.first.iter().map(|n| recording.place(n - 1));
    let lines = places.filter_map(|place| match place? {
        Place::Line(line) => Some(line.to_string()),
        Place::Row(_) => None,
    });
    match lines.collect::<Vec<_>>() {
        lines if lines.is_empty() => String::new(),
        lines => format!(" (lines {} of the file)", lines.join(" ")),
    }
}

/// One line a step, and one for what it gained.
fn lines(report: &Preparation, recording: &Recording) -> Vec<String> {
    let (input, output) = (&recording.input_quantity, &recording.output_quantity);
    let mut lines = vec![format!(
        "noise: {} of {}, {} of {}",
        input.text(report.input_noise),
        input.name,
        output.text(report.output_noise),
        output.name
    )];
    lines.extend(report.spikes.as_ref().map(|spikes| {
        let of = |repairs: &Repairs, name: &str| match repairs.first.is_empty() {
            true => format!("none in {name}"),
            false => format!(
                "{} in {name}{}, samples {}{}{}",
                repairs.spikes + repairs.signs,
                match repairs.signs {
                    0 => String::new(),
                    signs => format!(" ({signs} given their sign back)"),
                },
                repairs
                    .first
                    .iter()
                    .map(usize::to_string)
                    .collect::<Vec<_>>()
                    .join(" "),
                if repairs.spikes + repairs.signs > repairs.first.len() {
                    " …"
                } else {
                    ""
                },
                lines_of(repairs, recording),
            ),
        };
        format!(
            "spikes: {}, {}",
            of(&spikes.input, &input.name),
            of(&spikes.output, &output.name)
        )
    }));
    lines.extend(report.resampled.map(|step| {
        format!(
            "resampled: every {} s, {} samples of {}",
            text::number(step),
            report.samples,
            report.samples_before
        )
    }));
    lines.extend(
        report
            .low_pass
            .as_ref()
            .map(|filter| low_pass_line(filter, recording)),
    );
    lines.extend(report.lag.as_ref().map(|lag| lag_line(lag, recording)));
    lines.extend(report.dead_band.as_ref().map(|band| {
        format!(
            "dead band: {}, {} false reversals gone, {} samples moved by up to {}",
            input.text(band.size),
            band.false_reversals,
            band.samples_changed,
            input.text(band.largest_change)
        )
    }));
    lines.extend(
        report
            .judged
            .iter()
            .map(|judged| judged_line(judged, output)),
    );
    lines
}

fn low_pass_line(filter: &LowPass, recording: &Recording) -> String {
    let unit = if filter.in_hertz {
        "Hz"
    } else {
        "cycles a sample"
    };
    let series = [
        (&filter.input, &recording.input_quantity),
        (&filter.output, &recording.output_quantity),
    ];
    let of = |(smoothed, quantity): (&Option<Smoothed>, &hysteron::Quantity)| match smoothed {
        None => format!("none for {}", quantity.name),
        Some(smoothed) => format!(
            "{} at {} {unit} ({} rms taken away)",
            quantity.name,
            text::number(smoothed.cutoff),
            quantity.text(smoothed.removed)
        ),
    };
    format!("low-pass: {}", series.map(of).join(", "))
}

fn lag_line(lag: &SensorLag, recording: &Recording) -> String {
    let undone = match lag.undone {
        Some(tau) => format!("{} s undone", text::number(tau)),
        None => "none undone".into(),
    };
    let line = match (lag.estimate, lag.rmse_before, lag.rmse_after) {
        (Some(tau), Some(before), Some(after)) => format!(
            "sensor lag: {undone}; with {} s a static model errs by {} rms, without by {}",
            text::number(tau),
            recording.output_quantity.text(after),
            recording.output_quantity.text(before)
        ),
        _ => format!("sensor lag: {undone}"),
    };
    match (lag.undone, lag.one_speed) {
        (Some(_), Some(speed)) => format!(
            "{line}; all was recorded at one speed ({} per second), where a wider loop looks the \
             same: at other speeds it is a guess",
            recording.input_quantity.text(speed)
        ),
        _ => line,
    }
}

fn rate_line(rate: &RateDependence) -> String {
    format!(
        "rate: {} % of the output's range, of {} % that a static model misses (R² {:.3} by time, \
         {:.3} by the input's path; {} s){}",
        text::number(rate.percent),
        text::number(rate.nrmse_percent),
        rate.r2_time,
        rate.r2_path,
        text::number(rate.time_constant),
        match rate.is_material() {
            true => ": the loops depend on rate, which a static model cannot follow",
            false => "",
        }
    )
}

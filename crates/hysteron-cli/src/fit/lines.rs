//! What `fit` says of a model, line by line.

use crate::args::Dynamics;
use crate::{args, text};
use hysteron::{Criterion, FirstOrder, FitSummary, Model, Recording, Smooth, Step, Validation};

/// All lines.
pub(super) fn to_text(
    args: &args::Fit,
    model: &Model,
    fit: &FitSummary,
    recordings: &[Recording],
) -> String {
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
            model.output.text(fit.rmse),
            fit.nrmse_percent,
            model.output.text(fit.max_abs),
        ),
    ];
    lines.extend(
        fit.validation
            .as_ref()
            .map(|found| choice_line(model, fit, found)),
    );
    lines.extend(outliers_line(fit, model, recordings));
    let bare = model.latent() == 0.0;
    lines.extend(model.thermal.as_ref().map(|body| thermal_line(body, bare)));
    lines.extend(hysteron::rested_words(&fit.rests(), &model.input));
    lines.extend(model.fit.as_ref().and_then(unasked_line));
    lines.extend(latent_line(model));
    lines.extend(load_line(model));
    lines.extend(model.late_words());
    lines.extend(missing_lines(model, args));
    lines.extend(curve_line(model, args));
    lines.extend(start_line(fit));
    lines.extend(prior_line(fit));
    lines.extend(fit.confidence.as_ref().map(text::sessions));
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

/// Which readings were left out: the first few by recording and row, counted from 1.
fn outliers_line(fit: &FitSummary, model: &Model, recordings: &[Recording]) -> Option<String> {
    const NAMED: usize = 5;
    let count = fit.outliers.len();
    let named = fit.outliers.iter().take(NAMED).map(|outlier| {
        let recording = match fit.other_files.is_empty() {
            true => String::new(),
            false => format!("recording {}, ", outlier.recording + 1),
        };
        let by = model.output.text(outlier.by);
        let own = recordings.get(outlier.recording);
        let number = || format!("sample {}", outlier.sample + 1);
        let named = own.map_or_else(number, |own| own.named(outlier.sample));
        format!("{recording}{named} by {by}")
    });
    let named = named.collect::<Vec<_>>().join("; ");
    let more = if count > NAMED { "; …" } else { "" };
    (count > 0).then(|| {
        format!(
            "{}, left out of the fit and of these errors: {named}{more}",
            hysteron::counted(count, "outlier")
        )
    })
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
    let registered = match model.registration().is_none() {
        true => "",
        false => ", moves where rising and falling input pass each threshold",
    };
    let name = &load.quantity.name;
    let left_out = loads_left_out(model, &weight).unwrap_or_default();
    Some(format!(
        "{name} from {low} to {high}: it {slope}{scaled}{registered}, and {weights}{left_out}"
    ))
}

/// The error on loads that were left out, and the loads that were not used for that.
fn loads_left_out(model: &Model, unit: &str) -> Option<String> {
    let found = model.fit.as_ref()?.other.get("load")?;
    let error = match found["left_out_percent"].as_f64() {
        Some(error) => format!("\nloads left out: predicted to {error:.2} % of their range"),
        None => {
            "\nloads left out: none is between two others, so nothing shows how well others are \
                 predicted"
                .into()
        }
    };
    let silent = found["silent"].as_array()?.iter();
    let silent: Vec<String> = silent
        .filter_map(serde_json::Value::as_f64)
        .map(text::number)
        .collect();
    let silent = match silent.is_empty() {
        true => String::new(),
        false => format!(
            "; hardly any stroke at {} {unit}: not used to choose the law",
            silent.join(", ")
        ),
    };
    Some(error + &silent)
}

/// The output curve; said where it was asked for.
fn curve_line(model: &Model, args: &args::Fit) -> Option<String> {
    let constants = model.constants();
    match constants.get("curve_sums").len() {
        0 if args.how.stages.curve == Step::Off => None,
        0 => Some("no output curve: it does not predict parts of the recording left out".into()),
        knots => Some(format!("output curve of {} pieces", knots - 1)),
    }
}

/// What was asked for behind the operators and was not found.
fn missing_lines(model: &Model, args: &args::Fit) -> Vec<String> {
    let stages = &args.how.stages;
    let lagging = stages.lag != Step::Off || stages.dynamics == Dynamics::Lag;
    let asks_after = stages.creep != Step::Off || lagging;
    let mut lines = Vec::new();
    if asks_after && model.creep().is_empty() && model.lag() == 0.0 {
        let words = "no creep and no lag: they do not predict parts of the recording left out";
        lines.push(words.to_owned());
    }
    if stages.dynamics == Dynamics::Ring && model.constants().get("ring_frequency").is_empty() {
        lines.push("no ring: recordings with a load get none".to_owned());
    }
    lines
}

fn prior_line(fit: &FitSummary) -> Option<String> {
    let models = fit.other.get("prior")?.get("models")?;
    Some(format!(
        "what the recording does not determine is taken from {models} other actuators"
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
        "start found from the first {} samples and kept in the model, and used for all errors here; \
         with a free start of each operator, which perhaps no input reaches, the error is {free:.2} % \
         of the range",
        found.get("samples")?
    ))
}

/// What the transformation binds.
fn latent_line(model: &Model) -> Option<String> {
    let latent = Some(model.latent()).filter(|latent| *latent > 0.0)?;
    let tried = model.fit.as_ref()?.other.get("thermal")?.get("latent")?;
    let [without, with] = ["without", "with"].map(|name| tried.get(name)?.as_f64());
    Some(format!(
        "the transformation binds heat: a whole stroke would warm the body by {} more; error on \
         what was left out {} %, without it {} %",
        text::number(latent),
        text::number(with?),
        text::number(without?),
    ))
}

/// What a body gains that nobody asked for.
fn unasked_line(fit: &FitSummary) -> Option<String> {
    Some(format!(
        "nobody asked for this body: the error on what was left out is {:.2} % with it and {:.2} % \
         without; the input has to be a power: of a current or a voltage, give the square; \
         --dynamics off looks for no body, ring or lag",
        fit.validation.as_ref()?.nrmse_percent,
        fit.error_without_body()?
    ))
}

/// The time constants. Where no heat is bound, drives of one shape may hide that there are two.
fn thermal_line(body: &FirstOrder, bare: bool) -> String {
    let [heating, cooling] = [body.tau_heating, body.tau_cooling].map(text::number);
    match body.tau_heating == body.tau_cooling {
        true if !bare => format!("thermal body: time constant {heating} s"),
        true => format!(
            "thermal body: time constant {heating} s; heating and cooling are not told apart, \
             which takes drives of different shape, such as a ramp and a step"
        ),
        false => format!("thermal body: time constants {heating} s heating, {cooling} s cooling"),
    }
}

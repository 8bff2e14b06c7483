//! Titles and captions: what each figure shows, with its numbers.

use crate::evaluation::figure::Figure;
use crate::evaluation::figures::{
    SHOWN, choices_hidden, classes_counted, dead_band_shown, known_errors, resting_loads,
};
use crate::evaluation::view::View;
use crate::number::{capitalised, percent};
use crate::number::{count, significant};
use crate::quantity::Labelled;
use crate::residuals::CLASSES;
use crate::stack::Figures;
use hysteron::{Criterion, Errors};

/// The short title at the head of a figure.
pub(crate) fn title(figure: Figure, view: &View<'_>) -> String {
    let (input, output) = (&view.input.name, &view.output.name);
    let title = match figure {
        Figure::LoadLoops => match view.source.load() {
            Some(load) => format!("major loops by {}", load.quantity.name),
            None => String::new(),
        },
        Figure::LoadShift => match view.source.load() {
            Some(load) => format!("shift by {}", load.quantity.name),
            None => String::new(),
        },
        Figure::LoadMeasured => match view.source.load() {
            Some(load) => format!("{output} over {input}, by {}", load.quantity.name),
            None => String::new(),
        },
        Figure::Excitation => "What is known of each operator".into(),
        Figure::StandardErrors => "Standard errors of the weights".into(),
        Figure::CrossValidation => "Choice of levels and smoothness".into(),
        Figure::PlaneEvolution => "Evolution of the plane".into(),
        Figure::WeightsPlane => "Weights on the plane".into(),
        Figure::WeightsMap => "Size of the weights".into(),
        Figure::OutputTime => format!("{output} over {}", view.time_label.name),
        Figure::Loops => format!("{output} over {input}"),
        Figure::OutputDiscrepancy => format!("discrepancy of the modelled {output}"),
        Figure::OutputResiduals => format!("discrepancy of the modelled {output} over {input}"),
        Figure::OutputHistogram => "How often each discrepancy occurs".into(),
        Figure::InputTime => format!("{input} from the inverse model"),
        Figure::InputDiscrepancy => format!("discrepancy of the modelled {input}"),
        Figure::DeadBand => "Largest dead-band discrepancy, close up".into(),
    };
    capitalised(&title)
}

/// What a figure shows, in a sentence or two.
pub(crate) fn caption(figure: Figure, view: &View<'_>) -> String {
    let (input, output, recorded) = (&view.input.name, &view.output.name, view.recorded());
    let caption = match figure {
        Figure::LoadLoops => load_loops(view),
        Figure::LoadShift => load_shift(view),
        Figure::LoadMeasured => load_measured(view),
        Figure::Excitation => excitation(view),
        Figure::StandardErrors => standard_errors(view),
        Figure::CrossValidation => cross_validation(view),
        Figure::PlaneEvolution => format!(
            "Operator states on the plane at telling moments of the {input}. The dashed line is \
             the present {input}: rising, it switches operators on below it; falling, it switches \
             them off to its right."
        ),
        Figure::WeightsPlane => format!(
            "{} of {} weights are not zero. Each stands at the thresholds of its operator: α, \
             where the falling {input} switches it off, and β, where the rising {input} switches \
             it on.",
            count(view.source.weights_not_zero()),
            count(view.source.weights().len()),
        ),
        Figure::WeightsMap => "The weights μ over the plane; the darker, the larger.".into(),
        Figure::OutputTime => format!(
            "Modelled {output} and {recorded} {output}: {} over {} samples.{}",
            rmse_and_max(&view.evaluation.forward, &view.output),
            count(view.evaluation.forward.samples),
            band(view),
        ),
        Figure::Loops => format!(
            "Modelled and {recorded} {output} over {recorded} {input}: major and minor loops."
        ),
        Figure::OutputResiduals => format!(
            "Modelled minus {recorded} {output} at each {input}. What the model cannot follow shows \
             here as a pattern."
        ),
        Figure::OutputHistogram => format!(
            "Modelled minus {recorded} {output}: share of the samples in each of {CLASSES} classes \
             of equal width. Noise alone gives a bell around zero."
        ),
        Figure::OutputDiscrepancy => {
            format!(
                "Modelled minus {recorded} {output}: {}.",
                rmse_and_max(&view.evaluation.forward, &view.output)
            )
        }
        Figure::InputTime => format!(
            "The {input} that the inverse model finds for the {recorded} {output}, beside the \
             {recorded} {input}. While the {output} rests, hold keeps its {input}; anticipate \
             crosses the dead band as soon as the {output} is known to reverse."
        ),
        Figure::InputDiscrepancy => {
            format!(
                "Modelled minus {recorded} {input}. {}",
                inverse_errors(view).unwrap_or_default()
            )
        }
        Figure::DeadBand => dead_band(view),
    };
    let caption = capitalised(&caption);
    if view.simulated() {
        format!("Simulated recording. {caption}")
    } else {
        caption
    }
}

fn load_loops(view: &View<'_>) -> String {
    let Some(load) = view.source.load() else {
        return String::new();
    };
    format!(
        "One model that depends on the {}: the whole loop at the smallest, the middle and the \
         largest that it was identified at.",
        load.quantity.name
    )
}

/// The slope of the shift, both ways: the field states that of the phase diagram, load per
/// temperature.
fn load_shift(view: &View<'_>) -> String {
    let load = view.source.load();
    let Some((load, curves)) = load.and_then(|load| Some((load, load.curves.as_ref()?))) else {
        return String::new();
    };
    let (name, slope) = (&load.quantity.name, curves.slope());
    let what = format!(
        "By how much the {name} shifts the loop along the {}.",
        view.input.name
    );
    if slope == 0.0 {
        return format!("{what} On average it does not.");
    }
    let unit = |quantity: Labelled| quantity.unit.unwrap_or(quantity.name);
    let input = unit(view.input.difference(&view.input.name));
    let load = unit(Labelled::first([&load.quantity, &load.quantity], "load"));
    let each = match curves.loads.len() {
        2 => String::new(),
        _ => {
            let pairs = curves.loads.windows(2).zip(curves.shifts.windows(2));
            let slopes = pairs.map(|(load, shift)| (shift[1] - shift[0]) / (load[1] - load[0]));
            let (least, most) = slopes.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), slope| {
                (a.min(slope), b.max(slope))
            });
            let [least, most] = [least, most].map(|slope| significant(slope, 3));
            format!(" From piece to piece it is {least} to {most} {input}/{load}.")
        }
    };
    format!(
        "{what} Its slope is {} {input}/{load} on average, or {} {load}/{input}.{each}",
        significant(slope, 3),
        significant(1.0 / slope, 3),
    )
}

fn load_measured(view: &View<'_>) -> String {
    let Some((load, found)) = view.source.load().zip(resting_loads(view)) else {
        return String::new();
    };
    let loads = match found.len() {
        1 => "one".to_owned(),
        count => format!("{count} values"),
    };
    format!(
        "The recording where the {} rests, at {loads} of it: {} loops, and over them what the \
         model says of the same samples.",
        load.quantity.name,
        view.recorded(),
    )
}

fn excitation(view: &View<'_>) -> String {
    let Some(confidence) = view.confidence() else {
        return String::new();
    };
    format!(
        "What the {} that was fitted says of each operator: {}.",
        view.input.name,
        classes_counted(&confidence.excitation)
    )
}

fn standard_errors(view: &View<'_>) -> String {
    let Some(confidence) = view.confidence() else {
        return String::new();
    };
    let largest = known_errors(confidence).fold(0.0, f64::max);
    format!(
        "Standard errors of the weights, from {} replicates of a bootstrap over branches; the \
         largest is {}. Weights that are held at zero in every replicate have none.",
        count(confidence.replicates),
        view.output.value(largest)
    )
}

fn cross_validation(view: &View<'_>) -> String {
    let Some(validation) = view.validation() else {
        return String::new();
    };
    let parts = match validation.whole_branches {
        true => "",
        false => "parts of ",
    };
    let left_out = format!(
        "{} on {parts}branches left out, {} of the range",
        view.output.value(validation.rmse),
        percent(validation.nrmse_percent),
    );
    let chosen = match validation.criterion {
        Criterion::LeftOut => format!(
            "Error on {parts}branches left out, in {} folds, at the best strength across. Chosen is \
             the smallest: {left_out}.",
            validation.folds
        ),
        Criterion::Evidence => format!(
            "Error over the samples fitted. The evidence chose, because there are few branches to \
             leave out, so the smallest error is not the best. What was chosen errs {left_out}."
        ),
    };
    let hidden = choices_hidden(validation);
    let hidden = match hidden.is_empty() {
        true => String::new(),
        false => format!(
            " Errors of more than {SHOWN} times the smallest are not shown: {} levels.",
            hidden.join(", ")
        ),
    };
    let rivals = validation.rivals.iter().map(|rival| {
        let error = percent(rival.nrmse_percent);
        format!("{} errs {error}", rival.name)
    });
    let rivals: Vec<String> = rivals.collect();
    let rivals = match rivals.is_empty() {
        true => String::new(),
        false => format!(" On the same samples left out, {}.", rivals.join(", ")),
    };
    format!("{chosen}{hidden}{rivals}")
}

fn band(view: &View<'_>) -> String {
    view.band().map_or(String::new(), |band| {
        let inside = percent(band.coverage_percent);
        format!(" {inside} of them lie inside the 95\u{a0}% band.")
    })
}

/// `RMSE 0.12 mm, max 0.45 mm`.
pub(crate) fn rmse_and_max(errors: &Errors, quantity: &Labelled) -> String {
    format!(
        "RMSE {}, max {}",
        quantity.value(errors.rmse),
        quantity.value(errors.max_abs)
    )
}

fn inverse_errors(view: &View<'_>) -> Option<String> {
    let inverse = view.inverse()?;
    let policy = |name: &str, run: &hysteron::InverseRun| {
        let part = |errors: &Option<Errors>, place: String| {
            let errors = errors.as_ref()?;
            Some(format!("{} {place}", rmse_and_max(errors, &view.input)))
        };
        let moving = part(&run.moving, format!("where the {} moves", view.output.name));
        let resting = part(&run.dead_band, "in the dead band".to_owned());
        let parts: Vec<String> = moving.into_iter().chain(resting).collect();
        format!("{name}: {}.", parts.join(", "))
    };
    Some(format!(
        "{} {}",
        policy("Hold", &inverse.hold),
        policy("Anticipate", &inverse.anticipate)
    ))
}

fn dead_band(view: &View<'_>) -> String {
    let (Some(inverse), Some(worst)) = (view.inverse(), dead_band_shown(view)) else {
        return String::new();
    };
    let at = |series: &[f64]| series.get(worst.sample).copied().unwrap_or(f64::NAN);
    let measured = at(&view.recording.input);
    let [begin, end] = [worst.stretch.start, worst.stretch.end - 1]
        .map(|k| view.time_label.value(at_index(&view.time, k)));
    format!(
        "The {} rests from {begin} to {end} while the {} travels. At {} the held {} is off by {}, \
         the anticipated one by {}.",
        view.output.name,
        view.input.name,
        view.time_label.value(at(&view.time)),
        view.input.name,
        view.input
            .value((at(&inverse.hold.input_model) - measured).abs()),
        view.input
            .value((at(&inverse.anticipate.input_model) - measured).abs()),
    )
}

fn at_index(series: &[f64], k: usize) -> f64 {
    series.get(k).copied().unwrap_or(f64::NAN)
}

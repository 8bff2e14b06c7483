//! What an FMU of a model with stages has more.

use hysteron::{Error, LoadDependence, Model, Remedy, Result, Sample, Setting};
use hysteron_core::MAX_PARTS;
use std::fmt::Write;

/// The weights that depend on the load, if they do.
pub(super) fn parts(model: &Model) -> Option<&LoadDependence> {
    model.load.as_ref().filter(|load| load.parts().len() > 1)
}

/// Refuses a model that no binary takes.
pub(super) fn check(model: &Model) -> Result<()> {
    let count = parts(model).map_or(1, |load| load.parts().len());
    if count <= MAX_PARTS {
        return Ok(());
    }
    let what = format!("the weights have {count} parts over the load, and a block has {MAX_PARTS}");
    let remedy = Remedy::new("export it at one load with {}", [Setting::any("load")]);
    Err(Error::Export(what).remedied(remedy))
}

/// Whether the load is an input of the block.
pub(super) fn is_loaded(model: &Model) -> bool {
    !model.stages().axis.load.loads.is_empty() || parts(model).is_some()
}

/// Whether the model has nothing but operators, all of them off at the start, and no dead time.
pub(super) fn is_plain(model: &Model) -> bool {
    let bare = model.constants().is_none() && !is_loaded(model);
    bare && model.fitted().is_none() && model.delay().is_none()
}

/// The start values of input and load: the drive or input at the lower end, and the middle load.
pub(super) fn first(model: &Model) -> (f64, f64) {
    let load = match &model.load {
        Some(load) => {
            let (low, high) = load.range();
            0.5 * (low + high)
        }
        None => 0.0,
    };
    let input = match model.thermal {
        Some(_) => model.drive_range().0,
        None if is_plain(model) => model.plane().bottom(),
        None => model.active_range().0,
    };
    (input, load)
}

/// The start value of the wanted output: that at rest with the first input.
pub(super) fn first_target(model: &Model) -> Result<f64> {
    if is_plain(model) {
        return Ok(model.output_range().0);
    }
    let (input, load) = first(model);
    let sample = Sample {
        input,
        dt: None,
        load: model.load.as_ref().map(|_| load),
    };
    Ok(model.step(&mut model.start(), sample)?.output)
}

/// Whether the model has constants of stages that version 2 and 3 have no lines for.
fn has_others(model: &Model) -> bool {
    let constants = model.constants();
    let mut others = constants
        .iter()
        .filter(|(constant, _)| constant.line_of_version_2().is_none());
    others.any(|(_, numbers)| !numbers.is_empty())
}

/// Whether there is a line for each constant of every stage.
pub(super) fn is_whole(model: &Model) -> bool {
    has_others(model) || !model.delay().is_none()
}

/// The line of the dead time, if there is one.
pub(super) fn delay(model: &Model) -> String {
    let delay = model.delay();
    match delay.is_none() {
        true => String::new(),
        false => format!("delay {} {:?}\n", delay.samples(), delay.seconds()),
    }
}

/// The lines of `model.txt` for stages and start.
pub(super) fn lines(model: &Model, first: (f64, f64)) -> String {
    let constants = model.constants();
    let start = model.fitted().map_or_else(Vec::new, |state| {
        [state.input()]
            .into_iter()
            .chain(state.turning_points())
            .collect()
    });
    let (in_body, others): (Vec<_>, Vec<_>) = constants
        .iter()
        .partition(|(constant, _)| constant.line_of_version_2() == Some("body"));
    let body: Vec<f64> = in_body
        .into_iter()
        .flat_map(|(_, list)| list)
        .copied()
        .collect();
    let (low, high) = model.drive_range();
    let drive = match model.thermal {
        Some(_) => vec![low, high],
        None => Vec::new(),
    };
    let mut entries = vec![
        ("first", vec![first.0, first.1]),
        ("start", start),
        ("body", body),
        ("drive", drive),
    ];
    let whole = is_whole(model);
    entries.extend(others.into_iter().filter_map(|(constant, numbers)| {
        let line = constant.line_of_version_2();
        let numbers = match (constant.name, numbers) {
            ("lag", []) => vec![0.0],
            _ => numbers.to_vec(),
        };
        Some((line.or(whole.then_some(constant.name))?, numbers))
    }));
    let parts = parts(model).map_or_else(Vec::new, |load| {
        let (low, high) = load.range();
        vec![
            ("range", vec![low, high]),
            ("parts", load.joined().0.to_vec()),
        ]
    });
    let mut text = String::new();
    for (key, numbers) in entries.into_iter().chain(parts) {
        text += key;
        for number in numbers {
            // The shortest that reads back as the same number. Writing to a text cannot fail.
            let _ = write!(text, " {number:?}");
        }
        text.push('\n');
    }
    text
}

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

/// Whether the model has nothing but operators, all of them off at the start.
pub(super) fn is_plain(model: &Model) -> bool {
    let stages = !model.stages().axis.spacing.is_empty() || model.is_timed() || is_loaded(model);
    !stages && model.fitted().is_none()
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

/// The lines of `model.txt` for stages and start.
pub(super) fn lines(model: &Model, first: (f64, f64)) -> String {
    let stages = model.stages();
    let start = model.fitted().map_or_else(Vec::new, |state| {
        [state.input()]
            .into_iter()
            .chain(state.turning_points())
            .collect()
    });
    let body = stages.body.map_or_else(Vec::new, |body| {
        vec![body.ambient, body.gain, body.tau_heating, body.tau_cooling]
    });
    let (low, high) = model.drive_range();
    let drive = if stages.body.is_some() {
        &[low, high][..]
    } else {
        &[]
    };
    let load = stages.axis.load;
    let entries: [(&str, &[f64]); 13] = [
        ("first", &[first.0, first.1]),
        ("start", &start),
        ("body", &body),
        ("drive", drive),
        ("loads", load.loads),
        ("shifts", load.shifts),
        ("scales", load.scales),
        ("gains", load.gains),
        ("offsets", load.offsets),
        ("spacing", stages.axis.spacing),
        ("creep", stages.creep.coefficients),
        ("taus", stages.creep.taus),
        ("lag", &[stages.lag]),
    ];
    let parts = parts(model).map_or_else(Vec::new, |load| {
        let (low, high) = load.range();
        vec![
            ("range", vec![low, high]),
            ("parts", load.joined().0.to_vec()),
        ]
    });
    let parts = parts
        .iter()
        .map(|(key, numbers)| (*key, numbers.as_slice()));
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

//! Identifies the stages around the operators, together with the weights.
//!
//! `body` is the thermal body, `warm` where it began in each recording, `latent` the heat that it
//! loses to the operators, `load` the shift by the load, `spacing` the place of the levels, `ring`,
//! `after` and `curve` those behind the operators, from the last to the first, and `lag` a lag that
//! nobody asked for. Each finds its constants and hands on recordings as the next stage sees them.
//! Most of them are judged by `blocks`. `nelder_mead` is the search of body, heat and ring.

mod after;
pub(super) mod blocks;
mod body;
mod curve;
mod lag;
mod latent;
mod load;
mod nelder_mead;
mod resonator;
mod ring;
mod search;
mod spacing;
mod undone;
mod warm;

use body::Search;
pub(super) use body::may_heat;
pub(crate) use lag::with_right_input;
use latent::Heated;
pub(crate) use search::{step_of, time_passes};
pub use spacing::SpacingShape;
#[cfg(feature = "data")]
pub(crate) use spacing::shape_of as spacing_shape;
pub(crate) use undone::check_time;

use crate::error::Result;
use crate::identify::changed::few;
use crate::identify::choose::{Open, Seen, tested};
use crate::identify::fixed::fit_weights_without;
use crate::identify::options::{Choice, FitOptions, LoadLaw, Spacing, Thermal};
use crate::model::{Found, Model, Outlier};
use crate::progress::Progress;
use crate::recording::Recording;
use crate::series::range;
use serde_json::json;
use std::borrow::Cow;

/// The entry of a fit's record for a ring that was found.
pub(crate) const RING: &str = "ring";
/// The entry for creep and lag that were looked for.
pub(crate) const AFTER: &str = "after";

/// What a fit identifies besides the weights.
pub(crate) struct Asked<'a> {
    /// What heats the operators.
    pub(crate) thermal: Thermal,
    /// What is left to the data.
    pub(crate) open: Open,
    /// Whether the number of replicates follows from the levels.
    pub(crate) auto_bootstrap: bool,
    /// How the levels follow the output, where that was chosen before.
    pub(crate) shape: Option<SpacingShape>,
    /// Whether what was given is tested on what is left out, too.
    pub(crate) tested: bool,
    /// Whether a ring may be found, if the options look for one.
    pub(crate) rings: bool,
    /// Samples without weight.
    pub(crate) outliers: &'a [Outlier],
}

/// Identifies stages and weights.
pub(crate) fn fit(
    recordings: &[Recording],
    options: &FitOptions,
    asked: Asked<'_>,
    progress: Progress<'_>,
) -> Result<Model> {
    let mut found = Found::default();
    let mut notes = std::collections::BTreeMap::new();
    let mut seen: Cow<'_, [Recording]> = Cow::Borrowed(recordings);
    if asked.thermal != Thermal::None {
        let given = Search::new(recordings, options, progress)?;
        let rested = warm::rested(recordings, options, progress)?;
        let (first_order, told_apart) = body::find(&rested, options, progress)?;
        let mut heated = Heated::unbound(first_order);
        let mut rested = given.rested(rested, heated)?;
        let mut note = json!({"told_apart": told_apart});
        if asked.thermal == Thermal::Auto
            && recordings.iter().all(|recording| recording.load.is_none())
            && let Some(binding) = latent::find(&rested, options, (heated, told_apart), progress)?
        {
            heated = binding.heated;
            note["latent"] = json!(binding.report);
            rested = given.rested(rested, heated)?;
        }
        seen = Cow::Owned(heated.behind(&rested)?);
        found.thermal = Some(heated.body);
        found.latent = heated.per_output.abs();
        let ranges = recordings.iter().map(|recording| range(&recording.input));
        found.drive = ranges.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        notes.insert("thermal".to_owned(), note);
    }
    let mut options = options.clone();
    let loaded = seen.iter().any(|recording| recording.load.is_some());
    if loaded && options.load_law != LoadLaw::Weights {
        let law = load::find(&seen, &options, progress)?;
        options.load_degree = Some(law.degree);
        seen = Cow::Owned(law.seen);
        notes.insert("load".to_owned(), json!(law.report));
        found.registration = law.registration;
        options.load_curves = law.curves.clone().filter(|_| law.uses_curves);
        found.curves = law.curves;
    }
    // Before the levels are chosen: what rings would be taken for a rough plane.
    let mut ring = None;
    if options.looks_for_ring()
        && asked.rings
        && !loaded
        && let Some(swinging) = ring::find(&seen, &options, asked.open, progress)?
    {
        notes.insert(RING.to_owned(), json!(swinging.report));
        seen = Cow::Owned(swinging.recordings);
        ring = Some(swinging.constants);
    }
    // So would what comes late.
    let after = match options.asks_after() {
        true => Some(after::find(&seen, &options, asked.open, progress)?),
        false
            if options.looks_for_lag()
                && ring.is_none()
                && asked.thermal == Thermal::None
                && !loaded =>
        {
            lag::find(&seen, &options, asked.open, progress)?
        }
        false => None,
    };
    if let Some((after, report)) = after {
        notes.insert(AFTER.to_owned(), json!(report));
        seen = Cow::Owned(undone::before(&after, &seen)?);
        found.behind = after;
    }
    if let Some([frequency, damping]) = ring {
        let named = [("ring_frequency", frequency), ("ring_damping", damping)];
        let named = named.map(|(name, number)| (name, vec![number]));
        found.behind = found.behind.with(named)?;
    }
    let (few_seen, few_measured) = (few(&seen, &seen), few(recordings, &seen));
    let unspaced = Seen {
        operators: &few_seen,
        even: &few_seen,
        measured: &few_measured,
    };
    let (mut options, mut validation) = asked.open.choose(unspaced, &options, None, progress)?;
    let mut bent = None;
    if options.spacing == Spacing::Auto {
        let chosen = (asked.open, &validation);
        let spaced = spacing::find(unspaced, &options, chosen, asked.shape, progress)?;
        if let Some(mut spaced) = spaced {
            if asked.tested && spaced.validation.is_none() {
                let bent = Seen {
                    operators: &spaced.recordings,
                    ..unspaced
                };
                spaced.validation = Some(tested(bent, &spaced.options, progress)?);
            }
            bent = Some(spaced.behind(&seen));
            found.spacing = spaced.corners;
            (options, validation) = (spaced.options, spaced.validation);
        }
    }
    if asked.tested && validation.is_none() {
        validation = Some(tested(unspaced, &options, progress)?);
    }
    drop((few_seen, few_measured));
    if let Some(bent) = bent {
        seen = Cow::Owned(bent);
    }
    if asked.auto_bootstrap {
        options.bootstrap = FitOptions::usual_bootstrap(options.levels);
    }
    if options.curve != Choice::Fixed(0)
        && !loaded
        && let Some(bent) = curve::find(&seen, &options, progress)?
    {
        notes.insert("curve".to_owned(), json!(bent.report));
        seen = Cow::Owned(bent.recordings);
        options = bent.options;
        found.curve = Some(bent.bend);
    }
    let model = fit_weights_without(&seen, &options, asked.outliers, progress)?;
    let changes_noise = !found.behind.is_none();
    let mut model = model.with_stages(found)?;
    if let Some(fit) = &mut model.fit {
        if changes_noise {
            // What was left out was judged with the stages undone, which makes noise larger.
            notes.insert("undone".to_owned(), json!({"rmse": fit.rmse}));
        }
        fit.validation = validation;
        fit.other.extend(notes);
    }
    Ok(model)
}

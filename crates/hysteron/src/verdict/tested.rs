//! What a fit was tested on, as its record tells.

use super::Basis;
use crate::hold_out::{HeldOut, PART, RivalErrors};
use crate::model::{Criterion, FitSummary};
use crate::series::Errors;

/// A curve is found after the plane was chosen. This entry of the record has the error on blocks
/// left out with all stages.
const CURVE: &str = "curve";

/// A fit whose error on what it saw is so many times that on what was left out has a stage that was
/// not there when something was left out. Where a part was held out, that part is easier than the
/// rest.
pub(super) const BEYOND: f64 = 1.5;

/// The error on what a fit was tested on, and that of the best rival there.
pub(super) struct Tested {
    pub(super) basis: Basis,
    pub(super) rmse: f64,
    pub(super) percent: Option<f64>,
    pub(super) rival: Option<(String, f64)>,
}

impl Tested {
    pub(super) fn of(fit: &FitSummary) -> Self {
        if let Some(held_out) = fit.other.get("hold_out").and_then(HeldOut::from_record) {
            return Self {
                basis: Basis::HeldOut,
                rmse: held_out.model.rmse,
                percent: held_out.model.nrmse_percent,
                rival: best_of(&held_out.rivals),
            };
        }
        let validation = fit.validation.as_ref();
        let validation = validation.filter(|found| found.criterion == Criterion::LeftOut);
        let rivals = validation.into_iter().flat_map(|found| &found.rivals);
        let rival = best(rivals.map(|rival| (rival.name.clone(), rival.nrmse_percent)));
        // Percents of one range.
        let one_percent = fit.rmse / fit.nrmse_percent;
        let curve = fit
            .other
            .get(CURVE)
            .and_then(|found| found["with"].as_f64());
        let left_out = match (curve, validation) {
            (Some(percent), _) => Some((Basis::PartsLeftOut, percent * one_percent, percent))
                .filter(|(_, rmse, _)| rmse.is_finite()),
            (None, Some(found)) => {
                let basis = match found.whole_branches {
                    true => Basis::BranchesLeftOut,
                    false => Basis::PartsLeftOut,
                };
                Some((basis, found.rmse, found.nrmse_percent))
            }
            (None, None) => None,
        };
        match left_out {
            Some((basis, rmse, percent)) if fit.rmse <= BEYOND * rmse => Self {
                basis,
                rmse,
                percent: Some(percent),
                rival,
            },
            _ => Self {
                basis: Basis::Fitted,
                rmse: fit.rmse,
                percent: Some(fit.nrmse_percent),
                rival: None,
            },
        }
    }
}

/// Errors that differ by less than this share are those of the same samples.
const SAME: f64 = 1e-9;

/// The best rival beside a model that was tested on these very samples, as its errors tell: rivals
/// that were fitted to what the model was. Who evaluates it there again has no other verdict.
pub(super) fn rival_here(fit: &FitSummary, errors: &Errors) -> Option<(String, f64)> {
    let held_out = HeldOut::from_record(fit.other.get("hold_out")?)?;
    let near = |a: f64, b: f64| (a - b).abs() <= SAME * a.abs().max(b.abs());
    let model = &held_out.model;
    let is_here = model.samples == errors.samples
        && near(model.rmse, errors.rmse)
        && near(model.max_abs, errors.max_abs);
    best_of(&held_out.rivals).filter(|_| is_here)
}

/// Whether the fit was tested on another recording, and not on a part of one that it saw.
pub(super) fn on_others(fit: &FitSummary) -> bool {
    fit.other.contains_key("hold_out") && !fit.other.contains_key(PART)
}

/// The best rival of what was held out, and its error in percent.
pub(super) fn best_of(rivals: &[RivalErrors]) -> Option<(String, f64)> {
    let percent = |rival: &RivalErrors| Some((rival.name.to_owned(), rival.errors.nrmse_percent?));
    best(rivals.iter().filter_map(percent))
}

fn best(rivals: impl Iterator<Item = (String, f64)>) -> Option<(String, f64)> {
    rivals.min_by(|a, b| a.1.total_cmp(&b.1))
}

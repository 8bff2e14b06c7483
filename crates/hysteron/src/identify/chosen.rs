//! What a fit chose where it was left to the data. Fits of the same kind of actuator can take it
//! over, which costs a small share of choosing again.

use crate::identify::fit::Fit;
use crate::identify::options::{Choice, Dynamics, Spacing, Thermal};
use crate::identify::stages::{SpacingShape, spacing_shape};
use crate::model::{FitSummary, Model, Smooth, Start};
use crate::recording::Recording;
use serde::Serialize;

/// The choices of a fit. Numbers that belong to one actuator alone are not among them: its weights,
/// outliers and plane, the corners of its levels, its resonance.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Chosen {
    /// Number of levels.
    pub levels: usize,
    /// Smoothness.
    pub smooth: Smooth,
    /// State before the recording.
    pub start: Start,
    /// Where the operators rested, in the unit of the input; `None` for a rest that each fit finds.
    pub rest: Option<[f64; 2]>,
    /// How levels follow the path of the output; `None` for equal distances.
    pub spacing: Option<SpacingShape>,
    /// Dead time, in samples.
    pub delay: usize,
    /// Whether a resonance was found. Then each fit looks for its own.
    pub rings: bool,
    /// Whether a thermal body was found that nobody asked for. Then each fit finds its own.
    pub heated: bool,
}

impl Chosen {
    /// What the fit of this model to the recording chose.
    pub(crate) fn of(model: &Model, recording: &Recording) -> Self {
        let fit = model.fit.as_ref();
        Self {
            levels: model.plane().levels(),
            smooth: fit.map_or(Smooth::NONE, |fit| fit.smooth),
            start: fit.map_or(Start::Off, |fit| fit.start),
            rest: fit.and_then(FitSummary::rest),
            spacing: spacing_shape(model, recording),
            delay: model.delay().samples(),
            rings: fit.is_some_and(|fit| fit.other.contains_key("ring")),
            heated: fit.is_some_and(|fit| fit.error_without_body().is_some()),
        }
    }

    /// The same, with a rest that each fit finds by itself; `None` where there is no rest.
    pub(crate) fn resting_anywhere(&self) -> Option<Self> {
        self.rest.map(|_| Self {
            rest: None,
            ..self.clone()
        })
    }
}

impl Fit<'_> {
    /// Whether anything is left to the data that [`Chosen`] could decide. Dead time, resonance and
    /// body are looked for in recordings with time only (`timed`).
    pub(crate) fn leaves_choices(&self, timed: bool) -> bool {
        let Self { options, open, .. } = self;
        let chosen = open.levels || open.smooth || self.auto_start;
        let moves = options.delay == Choice::Auto || options.dynamics == Dynamics::Auto;
        let open = chosen || options.spacing == Spacing::Auto || (timed && moves);
        self.prior.is_none() && open
    }

    /// The same fit with what was `chosen` where it left that to the data. Its model is tested on
    /// what is left out, as that of a fit that chooses.
    pub(crate) fn sharing(&self, chosen: &Chosen) -> Self {
        let mut fit = self.testing();
        if self.open.levels {
            fit = fit.levels(chosen.levels);
        }
        if self.open.smooth {
            fit = fit.smooth(chosen.smooth);
        }
        if self.auto_start {
            fit = fit.start(chosen.start);
            fit.options.rest = chosen.rest;
        }
        match chosen.spacing {
            _ if self.options.spacing != Spacing::Auto => {}
            None => fit = fit.spacing(Spacing::Uniform),
            shape => fit.shape = shape,
        }
        let body = match chosen.heated {
            true => Thermal::Auto,
            false => Thermal::None,
        };
        fit.thermal.get_or_insert(body);
        // A body and a dead time change places, so the dead time is looked for again.
        if self.options.delay == Choice::Auto && !fit.is_heated() {
            fit = fit.delay(chosen.delay);
        }
        if !chosen.rings && fit.options.dynamics == Dynamics::Auto {
            fit.options.dynamics = Dynamics::Off;
        }
        fit
    }

    /// The same fit, whose model is tested on what is left out even if nothing is chosen by it.
    pub(crate) fn testing(&self) -> Self {
        let mut fit = self.clone();
        fit.tested = true;
        fit
    }

    /// The same fit without a bootstrap.
    pub(crate) fn without_bootstrap(&self) -> Self {
        self.clone().bootstrap(0)
    }

    /// Whether there is a bootstrap.
    pub(crate) fn has_bootstrap(&self) -> bool {
        self.auto_bootstrap || self.options.bootstrap > 0
    }
}

#[cfg(test)]
impl Chosen {
    /// The choice of so many levels, and of nothing else.
    pub(crate) fn with_levels(levels: usize) -> Self {
        Self {
            levels,
            smooth: Smooth::NONE,
            start: Start::Off,
            rest: None,
            spacing: None,
            delay: 0,
            rings: false,
            heated: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_is_looked_for_as_the_pilots_found_it() {
        let chosen = |heated| Chosen {
            heated,
            ..Chosen::with_levels(10)
        };
        for (heated, body) in [(true, Thermal::Auto), (false, Thermal::None)] {
            assert_eq!(Fit::new().sharing(&chosen(heated)).thermal, Some(body));
            let said = Fit::new().thermal(true).sharing(&chosen(heated));
            assert_eq!(said.thermal, Some(Thermal::FirstOrder));
        }
    }
}

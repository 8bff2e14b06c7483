//! The settings of a fleet's fit.

use super::choice::{FleetChoice, FleetShared};
use crate::data::{Columns, ReadOptions};
use crate::identify::Fit;
use crate::prepare::{PrepareOptions, Step};
use crate::progress::Progress;
use crate::recording::HoldOut;

/// What is fitted, and how. The same for every actuator.
#[derive(Debug, Clone)]
pub struct FleetOptions<'a> {
    /// The columns of each recording.
    pub columns: Columns<'a>,
    /// The column that tells the actuators apart; `None` if each file holds one.
    pub by: Option<&'a str>,
    /// The fit. Its progress is not asked for, and its repeats are not used.
    pub fit: Fit<'a>,
    /// How files are read. The limit of memory holds for each file.
    pub read: ReadOptions,
    /// The preparation before the fit; `None` for none.
    pub prepare: Option<PrepareOptions>,
    /// What is held out of each fit; `None` for nothing.
    pub hold_out: Option<HoldOut>,
    /// Who chooses what the fit leaves to the data.
    pub choice: FleetChoice,
    /// Unit of the input, if it is not that of the file.
    pub input_unit: Option<String>,
    /// Unit of the output, if it is not that of the file.
    pub output_unit: Option<String>,
}

impl<'a> FleetOptions<'a> {
    /// Fits with these columns, without preparation.
    #[must_use]
    pub fn new(columns: Columns<'a>, fit: Fit<'a>) -> Self {
        Self {
            columns,
            by: None,
            fit,
            read: ReadOptions::default(),
            prepare: None,
            hold_out: None,
            choice: FleetChoice::default(),
            input_unit: None,
            output_unit: None,
        }
    }

    /// The steps of the preparation, if there are any.
    pub(super) fn steps(&self) -> Option<&PrepareOptions> {
        let steps = self.prepare.as_ref();
        steps.filter(|steps| **steps != PrepareOptions::all(Step::Off))
    }

    /// What the result depends on, besides the samples: in a text, for a digest. It has what the
    /// pilots chose.
    pub(super) fn described(&self, shared: Option<&FleetShared>) -> String {
        let Self {
            columns,
            by,
            fit,
            read,
            prepare: _,
            hold_out,
            choice: _,
            input_unit,
            output_unit,
        } = self;
        let fit = fit.clone().repeats(Vec::new()).progress(Progress::NONE);
        let repair = read.repair;
        let steps = self.steps();
        let version = env!("CARGO_PKG_VERSION");
        let units = (input_unit, output_unit);
        format!(
            "{version} {columns:?} {by:?} {fit:?} {repair:?} {steps:?} {hold_out:?} {units:?} \
             {shared:?}"
        )
    }
}

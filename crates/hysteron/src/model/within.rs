//! A recording as the operators see it, without the stages around them. What learns weights works
//! on such a recording, and its result goes back between the stages.

use crate::error::{Error, Result};
use crate::model::{
    FirstOrder, LoadCurves, Model, Operators, Registration, Sign, StageConstants, Surroundings,
};
use crate::recording::Recording;
use crate::remedy::{Remedy, Setting};
use hysteron_core::Curve;
use std::borrow::Cow;

/// The stages that a fit found.
#[derive(Debug, Clone, Default)]
pub(crate) struct Found {
    pub(crate) thermal: Option<FirstOrder>,
    pub(crate) drive: Option<(f64, f64)>,
    /// The heat that is bound, in degrees per unit of the operators' output.
    pub(crate) latent: f64,
    pub(crate) curves: Option<LoadCurves>,
    pub(crate) registration: Registration,
    pub(crate) spacing: Vec<f64>,
    pub(crate) behind: StageConstants<f64>,
    pub(crate) curve: Option<Bend>,
}

/// A curve from the output of the operators, in its unit and with its sign, to the output.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bend {
    pub(crate) sums: Vec<f64>,
    pub(crate) outputs: Vec<f64>,
}

impl Bend {
    pub(crate) fn core(&self) -> Curve<'_, f64> {
        Curve {
            sums: &self.sums,
            outputs: &self.outputs,
        }
    }

    /// The curve over the operators' sum `h` alone, where these give `offset + sign · h`: the offset
    /// of the output, sums and outputs.
    pub(crate) fn anchored(&self, offset: f64, sign: Sign) -> (f64, Vec<f64>, Vec<f64>) {
        let (sign, base) = (sign.factor(), self.core().at(offset));
        let mut sums: Vec<f64> = self.sums.iter().map(|h| sign * (h - offset)).collect();
        let mut outputs: Vec<f64> = self.outputs.iter().map(|y| sign * (y - base)).collect();
        if sign < 0.0 {
            sums.reverse();
            outputs.reverse();
        }
        (base, sums, outputs)
    }
}

impl Model {
    /// The model of the operators alone.
    #[must_use]
    pub(crate) fn within(&self) -> Self {
        let mut model = Self::from(self.operators().clone());
        model.input = self.input.clone();
        model.output = self.output.clone();
        model.fit = self.fit.clone();
        model.start = self.start.clone();
        model
    }

    /// The recording as [`Model::within`] sees it: its input behind body, load, registration
    /// and spacing, its output in front of the stages behind the operators. For a model at one load.
    ///
    /// # Errors
    /// As [`Model::run_in`]; [`Error::Thermal`] where time stands still and the model has a lag
    /// or a ring.
    pub(crate) fn recording_within<'r>(
        &self,
        recording: &'r Recording,
    ) -> Result<Cow<'r, Recording>> {
        if self.is_plain() {
            return Ok(Cow::Borrowed(recording));
        }
        let around = Surroundings::from_recording(self, recording);
        Ok(Cow::Owned(Recording {
            input: self.seen(&recording.input, around)?.into_owned(),
            output: self.before_stages(recording)?,
            load: None,
            rest: None,
            ..recording.clone()
        }))
    }

    /// The same model, with the stages that its fit found.
    pub(crate) fn with_stages(mut self, found: Found) -> Result<Self> {
        self.thermal = found.thermal;
        self.drive = found.drive;
        let (off, on) = self.operators.output_range();
        self.latent = found.latent * (on - off).abs();
        if let Some(load) = &mut self.load {
            load.curves = found.curves;
        }
        self.registration = found.registration;
        self.spacing = found.spacing;
        let (offset, sign) = (self.offset(), self.sign());
        let anchored = found.curve.map(|curve| curve.anchored(offset, sign));
        let offset = anchored.as_ref().map_or(offset, |(offset, ..)| *offset);
        self.behind = found.behind;
        // The weights were fitted to what is in front of these stages, and so was the offset.
        let offset = self.stages().behind.settled(offset);
        if offset != self.offset() {
            let (operator, plane) = (self.operator(), *self.plane());
            let weights = self.weights().to_vec();
            self.operators = Operators::new(operator, plane, weights, offset, self.sign())?;
        }
        self.check_stages()?;
        match anchored {
            None => Ok(self),
            Some((_, sums, outputs)) => {
                self.with_behind([("curve_sums", sums), ("curve_outputs", outputs)])
            }
        }
    }

    /// The same stages around other operators.
    #[must_use]
    pub(crate) fn around(&self, operators: Operators) -> Self {
        let mut model = self.clone();
        model.operators = operators;
        model
    }

    /// The same stages around operators as [`Model::within`] has them: an offset that moved there is
    /// in front of the stages behind the operators.
    ///
    /// # Errors
    /// As [`Model::with_behind`].
    pub(crate) fn around_within(&self, operators: Operators) -> Result<Self> {
        if self.is_plain() {
            return Ok(self.around(operators));
        }
        let (factor, own) = (self.sign().factor(), self.offset());
        let moved = factor * (operators.offset() - own);
        let behind = self.stages().behind;
        let knots: Vec<f64> = behind.curve.sums.iter().map(|knot| knot - moved).collect();
        let offset = match knots.is_empty() {
            true => own + factor * behind.settled(moved),
            false => own,
        };
        let (operator, plane, sign) = (operators.operator(), *operators.plane(), operators.sign());
        let weights = operators.weights().to_vec();
        let model = self.around(Operators::new(operator, plane, weights, offset, sign)?);
        match knots.is_empty() {
            true => Ok(model),
            false => model.with_behind([("curve_sums", knots)]),
        }
    }

    /// The measured output in front of the stages behind the operators: what these must have given.
    pub(crate) fn before_stages(&self, recording: &Recording) -> Result<Vec<f64>> {
        let stages = self.stages();
        if self.behind.is_none() {
            return Ok(recording.output.clone());
        }
        let time = recording
            .time
            .as_ref()
            .ok_or_else(crate::model::needs_time)?;
        let mut past = None;
        let measured = recording.output.iter().enumerate();
        let sums = measured.map(|(n, &y)| {
            let dt = time[n] - time[n.saturating_sub(1)];
            let (h, next) = stages.undo_after(past, dt, y);
            past = Some(next);
            h.is_finite().then_some(h).ok_or_else(|| {
                let what =
                    "time stands still in the recording, which a model with a lag or a ring cannot have";
                let remedy = Remedy::new("repair it ({})", [Setting::any("repair")]);
                Error::Thermal(what.into()).remedied(remedy)
            })
        });
        sums.collect()
    }

    /// What the stages behind the operators make of `outputs` of these, over recordings one after the
    /// other.
    pub(crate) fn behind_operators(&self, recordings: &[Recording], outputs: &[f64]) -> Vec<f64> {
        if self.behind.is_none() {
            return outputs.to_vec();
        }
        let stages = self.stages();
        let samples = recordings.iter().flat_map(|recording| {
            let time = recording.time.as_deref();
            (0..recording.len()).map(move |n| {
                let dt = time.map(|time| time[n] - time[n.saturating_sub(1)]);
                (n, dt.unwrap_or_default())
            })
        });
        let mut past = None;
        let passed = samples.zip(outputs).map(|((n, dt), &output)| {
            let (y, next) = stages.after(past.filter(|_| n > 0), dt, output);
            past = Some(next);
            y
        });
        passed.collect()
    }
}

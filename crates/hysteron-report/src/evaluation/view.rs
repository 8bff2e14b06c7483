//! What every figure reads: the parts of an evaluation in the words and units that are shown.

use crate::clock::clock;
use crate::error::ReportError;
use crate::evaluation::source::Source;
use crate::quantity::Labelled;
use hysteron::{BandEvaluation, Confidence, Evaluation, InverseEvaluation, Validation};
use hysteron::{Model, Origin, Recording, Verdict, one_after_the_other};
use std::borrow::Cow;

/// All recordings, one after the other, behind the thermal body of the model.
fn behind_body<'a>(
    model: &Model,
    recordings: &'a [Recording],
) -> Result<Cow<'a, Recording>, ReportError> {
    if model.thermal.is_none() {
        return one_after_the_other(recordings).ok_or(ReportError::NoRecording);
    }
    let behind = recordings.iter().map(|recording| {
        let recording = model.rested(recording)?;
        Ok(model.behind_body(&recording)?.into_owned())
    });
    let behind: Vec<Recording> = behind.collect::<Result<_, ReportError>>()?;
    let all = one_after_the_other(&behind).ok_or(ReportError::NoRecording)?;
    Ok(Cow::Owned(all.into_owned()))
}

/// What figures show as the input: the temperature of the body, where there is one. Without a
/// thermometer it is in units of the drive that holds it.
fn shown_input(model: &Model, input: Labelled) -> Labelled {
    let Some(body) = model.thermal else {
        return input;
    };
    let in_drive = body.gain == 1.0 && body.ambient == 0.0;
    Labelled {
        name: "temperature of the body".into(),
        unit: input.unit.filter(|_| in_drive),
    }
}

/// An evaluation, ready to be drawn.
pub(crate) struct View<'a> {
    /// All recordings, one after the other, with the input that the operators see: behind the
    /// thermal body, if there is one.
    pub(crate) recording: Cow<'a, Recording>,
    /// The first samples of all recordings but the first one.
    pub(crate) begins: Vec<usize>,
    pub(crate) evaluation: &'a Evaluation,
    pub(crate) verdict: Option<&'a Verdict>,
    pub(crate) source: Source<'a>,
    pub(crate) input: Labelled,
    pub(crate) output: Labelled,
    /// Seconds, or sample numbers where the recording has no time.
    pub(crate) time: Cow<'a, [f64]>,
    pub(crate) time_label: Labelled,
}

impl<'a> View<'a> {
    /// The parts, once they fit together.
    pub(crate) fn new(
        model: &'a Model,
        recordings: &'a [Recording],
        (evaluation, verdict): (&'a Evaluation, Option<&'a Verdict>),
    ) -> Result<Self, ReportError> {
        let recording = behind_body(model, recordings)?;
        let ends = recordings.iter().scan(0, |end, recording| {
            *end += recording.len();
            Some(*end)
        });
        let begins = ends.take(recordings.len() - 1).collect();
        let expected = recording.input.len();
        let mut lengths = vec![
            ("recording.output", recording.output.len()),
            ("output_model", evaluation.output_model.len()),
        ];
        if let Some(band) = &evaluation.band {
            lengths.push(("band.half_width", band.half_width.len()));
        }
        if let Ok(inverse) = &evaluation.inverse {
            let [hold, anticipate] =
                [&inverse.hold, &inverse.anticipate].map(|run| run.input_model.len());
            lengths.extend([
                ("inverse.moving", inverse.moving.len()),
                ("inverse.hold.input_model", hold),
                ("inverse.anticipate.input_model", anticipate),
            ]);
        }
        if let Some((series, found)) = lengths.into_iter().find(|&(_, found)| found != expected) {
            return Err(ReportError::Length {
                series,
                expected,
                found,
            });
        }
        let source = Source::new(model);
        let input = Labelled::first([&recording.input_quantity, source.input()], "input");
        let (time, time_label) = clock(&recording);
        let time = time.into_owned().into();
        Ok(Self {
            input: shown_input(model, input),
            output: Labelled::first([&recording.output_quantity, source.output()], "output"),
            recording,
            begins,
            evaluation,
            verdict,
            source,
            time,
            time_label,
        })
    }

    /// The sample at which the model errs most, as the verdict tells it, and how a legend says it.
    pub(crate) fn worst(&self) -> Option<(usize, String)> {
        let worst = self.verdict?.worst.as_ref()?;
        let first = match worst.recording.checked_sub(1) {
            None => 0,
            Some(n) => *self.begins.get(n)?,
        };
        Some((first + worst.sample, format!("worst: {}", worst.named())))
    }

    pub(crate) fn inverse(&self) -> Option<&'a InverseEvaluation> {
        self.evaluation.inverse.as_ref().ok()
    }

    /// What the recording fitted says of the weights, where the model tells.
    pub(crate) fn confidence(&self) -> Option<&'a Confidence> {
        self.source.fit()?.confidence.as_ref()
    }

    /// How levels and smoothness were chosen, where the model tells.
    pub(crate) fn validation(&self) -> Option<&'a Validation> {
        let validation = self.source.fit()?.validation.as_ref();
        validation.filter(|validation| !validation.scores.is_empty())
    }

    pub(crate) fn band(&self) -> Option<&'a BandEvaluation> {
        self.evaluation.band.as_ref()
    }

    /// Lower and upper edge of the prediction band.
    pub(crate) fn band_edges(&self) -> Option<[Vec<f64>; 2]> {
        let (lower, upper) = self.band()?.ends(&self.evaluation.output_model);
        Some([lower, upper])
    }

    pub(crate) fn is_simulated(&self) -> bool {
        self.recording.origin == Origin::Simulated
    }

    /// What the recorded curves are called.
    pub(crate) fn recorded(&self) -> &'static str {
        match self.is_simulated() {
            true => "simulated plant",
            false => "measured",
        }
    }
}

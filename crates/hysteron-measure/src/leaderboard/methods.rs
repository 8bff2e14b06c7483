//! The methods of the leaderboard. Each sees what was fitted, and the input and load of the test.

use super::prandtl::{PrandtlIshlinskii, Shape};
use super::splits::Split;
use crate::result::Result;
use crate::scipy;
use hysteron::{Fit, FitOptions, Operator, Recording, Rival, RivalKind, Surroundings, plane_of};

/// Levels of the fits with a fixed number, and plays of the Prandtl-Ishlinskii models.
const LEVELS: usize = 20;

/// Levels of the large relay model.
const MANY: usize = 60;

#[derive(Clone, Copy, PartialEq)]
pub enum Method {
    /// `Fit::new()`, nothing else.
    Ours,
    Fixed,
    Relay(usize),
    Prandtl(Shape),
    SciPy,
    Rival(RivalKind),
}

impl Method {
    pub const ALL: [Self; 12] = [
        Self::Ours,
        Self::Fixed,
        Self::Relay(LEVELS),
        Self::Relay(MANY),
        Self::Prandtl(Shape::Plain),
        Self::Prandtl(Shape::TwoSided),
        Self::SciPy,
        Self::Rival(RivalKind::Line),
        Self::Rival(RivalKind::MeanCurve),
        Self::Rival(RivalKind::BranchPolynomial),
        Self::Rival(RivalKind::Interpolation),
        Self::Rival(RivalKind::Persistence),
    ];

    pub fn name(self) -> String {
        match self {
            Self::Ours => "ours".into(),
            Self::Fixed => format!("MKP {LEVELS}"),
            Self::Relay(levels) => format!("relay {levels}"),
            Self::Prandtl(Shape::Plain) => "PI".into(),
            Self::Prandtl(Shape::TwoSided) => "PI two-sided".into(),
            Self::SciPy => "SciPy".into(),
            Self::Rival(kind) => kind.name().into(),
        }
    }

    /// Whether the method has no operators. Where it wins, a model has failed.
    pub fn is_simple(self) -> bool {
        matches!(self, Self::Rival(_))
    }

    /// The output at every sample of the test; `None` where the method cannot be used.
    pub fn predict(self, split: &Split) -> Result<Option<Vec<f64>>> {
        match self {
            Self::Ours => fitted(&Fit::new(), split).map(Some),
            Self::Fixed => {
                let options = FitOptions {
                    levels: LEVELS,
                    ridge: 0.0,
                    ..FitOptions::plain()
                };
                fitted(&options.into(), split).map(Some)
            }
            Self::Relay(levels) => {
                let options = FitOptions {
                    operator: Operator::Relay,
                    levels,
                    ..FitOptions::plain()
                };
                fitted(&options.into(), split).map(Some)
            }
            Self::Prandtl(shape) => between_loads(split, |training, input| {
                let model = PrandtlIshlinskii::fit(training, shape, LEVELS);
                Ok(Some(model.predict(input)))
            }),
            Self::SciPy => between_loads(split, |training, input| {
                scipy::predict(training, plane_of(training, LEVELS)?, input)
            }),
            Self::Rival(RivalKind::Persistence) => {
                // Refuses what is not periodic.
                let rival = Rival::fit(RivalKind::Persistence, &split.training);
                Ok(rival.and_then(|rival| rival.predict(&split.test)).ok())
            }
            Self::Rival(kind) => {
                let rival = Rival::fit(kind, &split.training)?;
                Ok(Some(rival.predict(&split.test)?))
            }
        }
    }
}

/// A model of this crate. It starts the test as its fit started.
fn fitted(fit: &Fit<'_>, split: &Split) -> Result<Vec<f64>> {
    let model = fit.run(&split.training)?;
    let around = Surroundings::from_recording(&model, &split.test);
    Ok(model.simulate_in(&split.test.input, around)?)
}

/// For methods without a load: one model for each load fitted, and the mean of the two nearest
/// ones, weighted by their distances. Without a load there is one recording to fit.
fn between_loads(
    split: &Split,
    predict: impl Fn(&Recording, &[f64]) -> Result<Option<Vec<f64>>>,
) -> Result<Option<Vec<f64>>> {
    let input = &split.test.input;
    let Some(load) = &split.test.load else {
        return match split.training.as_slice() {
            [only] => predict(only, input),
            _ => Ok(None),
        };
    };
    let mut known = Vec::new();
    for training in &split.training {
        let Some(output) = predict(training, input)? else {
            return Ok(None);
        };
        known.push((middle(training), output));
    }
    known.sort_by(|a, b| a.0.total_cmp(&b.0));
    let at = |(n, load): (usize, &f64)| {
        let above = known.partition_point(|(known, _)| known <= load);
        let above = above.clamp(1, known.len() - 1);
        let [(a, low), (b, high)] = [&known[above - 1], &known[above]];
        let share = ((load - a) / (b - a)).clamp(0.0, 1.0);
        (1.0 - share) * low[n] + share * high[n]
    };
    Ok(Some(load.iter().enumerate().map(at).collect()))
}

/// The median load.
fn middle(recording: &Recording) -> f64 {
    let mut load = recording.load.clone().unwrap_or_default();
    load.sort_by(f64::total_cmp);
    load.get(load.len() / 2).copied().unwrap_or_default()
}

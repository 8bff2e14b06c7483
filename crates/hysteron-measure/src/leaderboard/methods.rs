//! The methods of the leaderboard. Each sees what was fitted, and the input and load of the test.

use super::plays::RidgeOnPlays;
use super::prandtl::{PrandtlIshlinskii, Shape};
use super::splits::Split;
use crate::result::Result;
use crate::scipy;
use hysteron::{Fit, FitOptions, Operator, Recording, Rival, RivalKind, Surroundings, plane_of};
use std::slice;

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
    Plays,
    SciPy,
    Rival(RivalKind),
}

impl Method {
    pub const ALL: [Self; 13] = [
        Self::Ours,
        Self::Fixed,
        Self::Relay(LEVELS),
        Self::Relay(MANY),
        Self::Prandtl(Shape::Plain),
        Self::Prandtl(Shape::TwoSided),
        Self::Plays,
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
            Self::Plays => "ridge on plays".into(),
            Self::SciPy => "SciPy".into(),
            Self::Rival(kind) => kind.name().into(),
        }
    }

    /// Whether the method may beat ours without notice: it is a fit of ours done elsewhere.
    pub fn is_same_optimum(self) -> bool {
        matches!(self, Self::SciPy)
    }

    /// The output at every sample of the test; `None` where the method cannot be used.
    pub fn predict(self, split: &Split) -> Result<Option<Vec<f64>>> {
        match self {
            Self::Prandtl(_) | Self::Plays | Self::SciPy => between_loads(self, split),
            _ => self.fit(&split.training)?(&split.test),
        }
    }

    /// What predicts after a fit to these recordings. The methods that know no load take one
    /// recording.
    pub fn fit(self, training: &[Recording]) -> Result<Predictor> {
        let first = training.first().ok_or("nothing to fit")?;
        Ok(match self {
            Self::Ours => fitted(&Fit::new(), training)?,
            Self::Fixed => {
                let options = FitOptions {
                    levels: LEVELS,
                    ridge: 0.0,
                    ..FitOptions::plain()
                };
                fitted(&options.into(), training)?
            }
            Self::Relay(levels) => {
                let options = FitOptions {
                    operator: Operator::Relay,
                    levels,
                    ..FitOptions::plain()
                };
                fitted(&options.into(), training)?
            }
            Self::Prandtl(shape) => {
                let model = PrandtlIshlinskii::fit(first, shape, LEVELS);
                Box::new(move |test| Ok(Some(model.predict(&test.input))))
            }
            Self::Plays => {
                let model = RidgeOnPlays::fit(first)?;
                Box::new(move |test| Ok(Some(model.predict(&test.input))))
            }
            Self::SciPy => {
                let training = first.clone();
                let plane = plane_of(&training, LEVELS)?;
                Box::new(move |test| scipy::predict(&training, plane, &test.input))
            }
            Self::Rival(RivalKind::Persistence) => {
                // Refuses what is not periodic.
                let rival = Rival::fit(RivalKind::Persistence, training).ok();
                Box::new(move |test| Ok(rival.as_ref().and_then(|own| own.predict(test).ok())))
            }
            Self::Rival(kind) => {
                let rival = Rival::fit(kind, training)?;
                Box::new(move |test| Ok(Some(rival.predict(test)?)))
            }
        })
    }
}

/// The output at every sample of a recording whose outputs are not looked at; `None` where the
/// method cannot be used.
pub type Predictor = Box<dyn Fn(&Recording) -> Result<Option<Vec<f64>>>>;

/// A model of this crate. It starts the test as its fit started.
fn fitted(fit: &Fit<'_>, training: &[Recording]) -> Result<Predictor> {
    let model = fit.run(training)?;
    Ok(Box::new(move |test| {
        let around = Surroundings::from_recording(&model, test);
        Ok(Some(model.simulate_in(&test.input, around)?))
    }))
}

/// For methods without a load: one model for each load fitted, and the mean of the two nearest
/// ones, weighted by their distances. Without a load there is one recording to fit.
fn between_loads(method: Method, split: &Split) -> Result<Option<Vec<f64>>> {
    let predict = |training: &Recording| method.fit(slice::from_ref(training))?(&split.test);
    let Some(load) = &split.test.load else {
        return match split.training.as_slice() {
            [only] => predict(only),
            _ => Ok(None),
        };
    };
    let mut known = Vec::new();
    for training in &split.training {
        let Some(output) = predict(training)? else {
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

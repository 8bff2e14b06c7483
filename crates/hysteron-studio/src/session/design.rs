//! The profile of input that the data of a fit lack.

use super::fault::Fault;
use super::id::Id;
use super::plane::cells;
use super::state::Session;
use super::thinned::{Shape, thinned};
use super::wish::Wish;
use hysteron::{Design, DesignOptions, Excitation, Plane, Rates, design};
use serde::Serialize;

/// A profile, and what the data determine with it.
#[derive(Debug, Clone, Serialize)]
pub struct DesignView {
    /// Times in seconds, with no more points than the picture can show.
    pub time: Vec<Option<f64>>,
    /// Inputs at these times.
    pub input: Vec<Option<f64>>,
    /// The input, with its unit.
    pub unit: String,
    /// Samples of the profile; 0 if nothing is missing.
    pub samples: usize,
    /// Its duration in seconds.
    pub duration: f64,
    /// The duration that determines every operator.
    pub full_duration: f64,
    /// Branches.
    pub branches: usize,
    /// The levels of the plane.
    pub levels: Vec<f64>,
    /// How well each operator is determined by what is recorded, as in a plane; 0 never, 1 once,
    /// 2 not told apart, 3 well.
    pub before: Vec<Vec<Option<f64>>>,
    /// The same with the profile.
    pub after: Vec<Vec<Option<f64>>>,
    /// The number of operators in each class by what is recorded.
    pub counts_before: [usize; 4],
    /// The same with the profile.
    pub counts_after: [usize; 4],
    /// The command that does the same.
    pub command: String,
}

/// Pixels of the picture over time.
const PIXELS: (u32, u32) = (1400, 320);

fn counts(classes: &[Excitation]) -> [usize; 4] {
    Excitation::ALL.map(|class| classes.iter().filter(|other| **other == class).count())
}

impl Session {
    /// The plane of a fit. Levels that are not evenly spaced are laid out evenly between their ends.
    fn plane_of(&self, fit: Id) -> Result<Plane, Fault> {
        let model = &self.fitted(fit)?.model;
        Ok(match model.spacing() {
            [_, first, .., last] => {
                Plane::new(*first, *last, model.plane().levels()).map_err(hysteron::Error::from)?
            }
            _ => *model.plane(),
        })
    }

    fn profile(&self, wish: &Wish) -> Result<Design, Fault> {
        let fitted = self.fitted(wish.fit)?;
        let options = DesignOptions {
            operator: fitted.model.operator(),
            budget_s: wish.budget.map(|minutes| 60.0 * minutes),
            ..DesignOptions::new(
                self.plane_of(wish.fit)?,
                Rates {
                    heating: wish.heating,
                    cooling: wish.cooling,
                },
            )
        };
        let mut recorded: Vec<Vec<f64>> = Vec::new();
        let files = fitted.files.iter().filter(|_| !wish.whole);
        for file in files.filter_map(|file| self.file(*file).ok()) {
            // Where there is a thermal body, the plane is that of the temperature.
            for recording in file.parts()?.all() {
                let recording = fitted.model.rested(recording)?;
                recorded.push(fitted.model.behind_body(&recording)?.input.clone());
            }
        }
        let inputs: Vec<&[f64]> = recorded.iter().map(Vec::as_slice).collect();
        Ok(design(&options, &inputs)?)
    }

    pub(super) fn design(&self, wish: &Wish) -> Result<DesignView, Fault> {
        let found = self.profile(wish)?;
        let count = found.plane.levels();
        let points = found.time.iter().zip(&found.input).map(|(t, u)| [*t, *u]);
        let (time, input) = thinned(points, PIXELS, [None; 2], Shape::OverTime);
        let before = match &found.recorded {
            Some(recorded) => recorded.clone(),
            None => vec![Excitation::Never; found.excitation.len()],
        };
        let shown =
            |classes: &[Excitation]| cells(count, classes.iter().map(|c| f64::from(*c as u8)));
        let fitted = self.fitted(wish.fit)?;
        Ok(DesignView {
            time,
            input,
            unit: fitted.model.input.to_column(),
            samples: found.time.len(),
            duration: found.duration_s(),
            full_duration: found.full_duration_s,
            branches: found.legs.len(),
            levels: (1..=count).map(|k| found.plane.level(k)).collect(),
            before: shown(&before),
            after: shown(&found.excitation),
            counts_before: counts(&before),
            counts_after: counts(&found.excitation),
            command: super::commands::design(self, fitted, &found.plane, wish),
        })
    }

    /// The profile as a table.
    pub(super) fn profile_table(&self, wish: &Wish) -> Result<Vec<u8>, Fault> {
        let found = self.profile(wish)?;
        if found.time.is_empty() {
            let problem = "nothing is missing: the recordings determine every operator";
            return Err(Fault::missing(
                problem,
                "ask for a profile of the whole plane",
            ));
        }
        Ok(found.to_csv()?)
    }
}

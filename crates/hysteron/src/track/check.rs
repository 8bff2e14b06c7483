//! What a scenario may say.

use super::{LoopOptions, Reference, Scenario};
use crate::{Adaptation, Error, Result};

impl Scenario {
    /// Refuses what cannot be run.
    ///
    /// # Errors
    /// [`Error::Scenario`] names the field.
    pub(super) fn check(&self) -> Result<()> {
        require(
            positive(self.interval_s),
            "interval_s",
            "the time between samples must be above zero",
        )?;
        let samples = self.duration_s / self.interval_s;
        let fine = (10.0..=1e7).contains(&samples);
        require(
            fine,
            "duration_s",
            "from 10 to 10 million samples are needed",
        )?;
        let fine = self.settle_s >= 0.0 && self.settle_s < self.duration_s;
        require(fine, "settle_s", "must lie between 0 and the duration")?;
        require(
            (1..=1000).contains(&self.seeds),
            "seeds",
            "from 1 to 1000 runs",
        )?;
        let some = !self.reference.is_empty();
        require(some, "reference", "at least one part is needed")?;
        for (n, part) in self.reference.iter().enumerate() {
            part.check(&format!("reference[{n}]"))?;
        }
        let some = !self.controllers.is_empty();
        require(some, "controllers", "at least one is needed")?;
        self.check_model()?;
        let LoopOptions {
            filter_s,
            tolerance,
            ..
        } = self.shared;
        require(from_zero(filter_s), "loop.filter_s", NOT_NEGATIVE)?;
        require(from_zero(tolerance), "loop.tolerance", NOT_NEGATIVE)?;
        let adaptation: Adaptation<f64> = self.adaptation.into();
        adaptation
            .check()
            .or_else(|error| refuse("adaptation", &error.to_string()))?;
        self.check_events()
    }

    fn check_model(&self) -> Result<()> {
        let options = &self.model;
        options
            .plane()
            .or_else(|error| refuse("model", &error.to_string()))?;
        let (heating, cooling) = options.rates;
        let fine = positive(heating) && positive(cooling);
        require(fine, "model.rates", "both must be above zero")?;
        require(from_zero(options.smooth), "model.smooth", NOT_NEGATIVE)
    }

    /// On a plant, so that what it does not know is refused before anything is run.
    fn check_events(&self) -> Result<()> {
        let mut plant = self
            .plant
            .build(1)
            .or_else(|error| refuse("plant", &error.to_string()))?;
        let mut last = 0.0;
        for (n, event) in self.disturbance.iter().enumerate() {
            let field = format!("disturbance[{n}]");
            let fine = event.at_s >= last && event.at_s < self.duration_s;
            require(
                fine,
                &format!("{field}.at_s"),
                "must be in order and within the duration",
            )?;
            last = event.at_s;
            let whats = event.disturbances();
            require(
                !whats.is_empty(),
                &field,
                "load_n, room_degc, predeformation_mm, stuck or lost is needed",
            )?;
            for what in whats {
                plant
                    .disturb(what)
                    .or_else(|error| refuse(&field, &error.to_string()))?;
            }
        }
        Ok(())
    }
}

impl Reference {
    fn check(&self, field: &str) -> Result<()> {
        let require =
            |fine, name: &str, problem| require(fine, &format!("{field}.{name}"), problem);
        let finite =
            |value: &f64, name| require(value.is_finite(), name, "must be a finite number");
        let above_zero = "must be above zero";
        match self {
            Self::Constant { value } => finite(value, "value"),
            Self::Sine {
                amplitude,
                period_s,
                phase_deg,
            } => {
                finite(amplitude, "amplitude")?;
                finite(phase_deg, "phase_deg")?;
                require(positive(*period_s), "period_s", above_zero)
            }
            Self::Trapezoid {
                low,
                high,
                ramp_s,
                rest_s,
            } => {
                finite(low, "low")?;
                finite(high, "high")?;
                require(positive(*ramp_s), "ramp_s", above_zero)?;
                require(from_zero(*rest_s), "rest_s", NOT_NEGATIVE)
            }
            Self::Steps { points } | Self::Ramps { points } => {
                require(!points.is_empty(), "points", "at least one is needed")?;
                let all = points.iter().all(|(t, y)| t.is_finite() && y.is_finite());
                require(all, "points", "must be finite numbers")?;
                let in_order = points.windows(2).all(|pair| pair[0].0 <= pair[1].0);
                require(in_order, "points", "must be in the order of their times")
            }
            Self::Csv { .. } => require(
                false,
                "file",
                "has not been read; `Scenario::parse` does so, or give its points as ramps",
            ),
        }
    }
}

const NOT_NEGATIVE: &str = "must be zero or above";

fn positive(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}

fn from_zero(value: f64) -> bool {
    value >= 0.0 && value.is_finite()
}

fn require(fine: bool, field: &str, problem: &str) -> Result<()> {
    match fine {
        true => Ok(()),
        false => refuse(field, problem),
    }
}

fn refuse<T>(field: &str, problem: &str) -> Result<T> {
    Err(Error::Scenario {
        field: field.into(),
        problem: problem.into(),
    })
}

//! Checks a scenario.

use super::{LoopOptions, Reference, Scenario};
use hysteron::{Delay, Error, Model, Operator, Result, Sign};

/// Most levels of a model that is identified anew for each run.
const MOST_LEVELS: usize = 100;
/// Larger than any output; its square is finite.
const LARGEST: f64 = 1e100;

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
        let fine = (10.0..=1e6).contains(&samples);
        require(
            fine,
            "duration_s",
            "from 10 to a million samples of interval_s are needed",
        )?;
        let fine = self.settle_s >= 0.0 && self.settle_s <= self.duration_s - 4.0 * self.interval_s;
        require(
            fine,
            "settle_s",
            "must lie between 0 and the duration, with four samples left at least",
        )?;
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
        let references = self.references();
        if let Some(n) = references
            .iter()
            .position(|r| r.is_nan() || r.abs() >= LARGEST)
        {
            let time = n as f64 * self.interval_s;
            return refuse(
                "reference",
                &format!("at {time} s it is {:e}, which is no output", references[n]),
            );
        }
        let some = !self.controllers.is_empty();
        require(some, "controllers", "at least one is needed")?;
        let mut seen = Vec::new();
        for kind in &self.controllers {
            let name = kind.name();
            require(
                !seen.contains(kind),
                "controllers",
                &format!("`{name}` stands there twice"),
            )?;
            seen.push(*kind);
        }
        for (n, (time_s, drive)) in self.before.iter().enumerate() {
            let fine = (0.0..=1e5).contains(time_s) && drive.is_finite();
            let needed = "a time from 0 to 100000 s and a finite drive are needed";
            require(fine, &format!("before[{n}]"), needed)?;
        }
        self.check_model()?;
        let LoopOptions {
            filter_s,
            tolerance,
            preview_s,
            delay,
            tuning: _,
            speed,
        } = self.shared;
        require(from_zero(filter_s), "loop.filter_s", NOT_NEGATIVE)?;
        require(from_zero(tolerance), "loop.tolerance", NOT_NEGATIVE)?;
        require(from_zero(preview_s), "loop.preview_s", NOT_NEGATIVE)?;
        let few = delay.is_none_or(|samples| samples <= Delay::MOST + 1);
        require(few, "loop.delay", "must be at most 1001 samples")?;
        let fine = speed.is_none_or(positive);
        require(fine, "loop.speed", "must be above zero")?;
        self.check_adaptation()
            .or_else(|error| refuse("adaptation", &error.to_string()))?;
        self.check_events()
    }

    /// Defaults follow from the model, which is not identified yet. A model of the same plane
    /// stands in for it.
    fn check_adaptation(&self) -> Result<()> {
        let plane = self.model.plane()?;
        let weights = vec![1.0; plane.operators()];
        let model = Model::new(Operator::Mkp, plane, weights, 0.0, Sign::Positive)?;
        super::options::compensator(&self.adaptation, &model).map(|_| ())
    }

    fn check_model(&self) -> Result<()> {
        let options = &self.model;
        options
            .plane()
            .or_else(|error| refuse("model", &error.to_string()))?;
        let fine = options.levels <= MOST_LEVELS;
        require(
            fine,
            "model.levels",
            &format!("more than {MOST_LEVELS} take minutes for each run"),
        )?;
        self.check_file()?;
        let (heating, cooling) = options.rates;
        let fine = positive(heating) && positive(cooling);
        require(fine, "model.rates", "both must be above zero")?;
        require(from_zero(options.smooth), "model.smooth", NOT_NEGATIVE)
    }

    fn check_file(&self) -> Result<()> {
        let options = &self.model;
        let Some(file) = &options.file else {
            return Ok(());
        };
        let model = Model::read(file)?;
        let refuse =
            |problem: &str| refuse("model.file", &format!("{}: {problem}", file.display()));
        if let Err(error) = model.inverse() {
            return refuse(&error.to_string());
        }
        let plane = model.plane();
        if (plane.min(), plane.max()) != options.range || plane.levels() != options.levels {
            return refuse(&format!(
                "its plane has {} levels from {} to {}: say so in model.levels and model.range",
                plane.levels(),
                plane.min(),
                plane.max()
            ));
        }
        Ok(())
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
            // At the same time, or with two samples between.
            let apart = 2.0 * self.interval_s;
            let fine = (event.at_s == last || event.at_s >= last + apart)
                && event.at_s <= self.duration_s - apart;
            require(
                fine,
                &format!("{field}.at_s"),
                "must be in order, the same as before or two samples later at least, and two \
                 samples before the end",
            )?;
            last = event.at_s;
            let whats = event.disturbances();
            require(
                !whats.is_empty() || event.window.is_some(),
                &field,
                "load_n, room_degc, predeformation_mm, gain, stuck, lost or window is needed",
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
        path: None,
        line: None,
        field: field.into(),
        problem: problem.into(),
    })
}

//! The stages of a model, in the form that the core runs.

use crate::error::{Error, Result};
use crate::model::{CreepTerm, FirstOrder, Model, Registration, StageConstants};
use hysteron_core::{Axis, Direction, Error as CoreError, Latent, Load, Stages};

impl Model {
    /// The constants of the stages around the operators, as the core takes them. The offset is that
    /// of the operators; where weights depend on a load, that of the middle of its range.
    #[must_use]
    pub fn stages(&self) -> Stages<'_, f64> {
        let curves = self.load.as_ref().and_then(|load| load.curves.as_ref());
        Stages {
            body: self.thermal.map(|body| body.core()),
            latent: Latent { heat: self.latent },
            axis: Axis {
                load: curves.map_or(Load::NONE, |curves| curves.core()),
                registration: self.registration.core(),
                spacing: &self.spacing,
            },
            behind: self.behind.stages().behind,
            offset: self.offset(),
            falling: self.sign().factor() < 0.0,
        }
    }

    /// The numbers of each constant, where the model has them, in the order of
    /// [`Stages::declared`](hysteron_core::Stages::declared).
    pub fn stage_lists(&self) -> impl Iterator<Item = &[f64]> {
        let of_body = |constant: fn(&FirstOrder) -> &f64| match &self.thermal {
            Some(body) => std::slice::from_ref(constant(body)),
            None => &[],
        };
        let curves = self.load.as_ref().and_then(|load| load.curves.as_ref());
        let load = curves.map_or(Load::NONE, |curves| curves.core());
        let in_front = [
            of_body(|body| &body.ambient),
            of_body(|body| &body.gain),
            of_body(|body| &body.tau_heating),
            of_body(|body| &body.tau_cooling),
            match self.latent == 0.0 {
                true => &[],
                false => std::slice::from_ref(&self.latent),
            },
            load.loads,
            load.shifts,
            load.scales,
            load.gains,
            load.offsets,
            &self.registration.knots,
            &self.registration.rising,
            &self.registration.falling,
            &self.spacing,
        ];
        let behind = self.behind.iter().skip(in_front.len());
        let behind = behind.map(|(_, numbers)| numbers);
        in_front.into_iter().chain(behind)
    }

    /// Checks the constants of all stages.
    pub(crate) fn check_stages(&self) -> Result<()> {
        let negative = self.load.as_ref().is_some_and(|load| load.is_negative());
        if self.latent != 0.0 && negative {
            // At one load or another, as the core refuses it for weights that are always the same.
            return Err(CoreError::Stage { stage: "latent" }.into());
        }
        Ok(self.stages().check(&self.operators().core)?)
    }

    /// Whether the model has no stage: its output depends on the input alone.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        self.load.is_none()
            && self.thermal.is_none()
            && self.registration.is_none()
            && self.spacing.is_empty()
            && self.behind.is_none()
    }

    /// Whether a stage depends on time: each sample then needs the time since the one before.
    #[must_use]
    pub fn is_timed(&self) -> bool {
        self.stages().is_timed()
    }

    /// The inputs at the `K + 1` corners of the grid, ascending: level 0, which is the bottom of
    /// the plane, to level `K`. Empty for levels with equal distances.
    #[must_use]
    pub fn spacing(&self) -> &[f64] {
        &self.spacing
    }

    /// The same model with its levels at these inputs. The plane then numbers the levels; the
    /// weights stay.
    ///
    /// # Errors
    /// [`Error::Core`] if there are not `K + 1` ascending corners; empty for equal distances.
    pub fn with_spacing(mut self, corners: Vec<f64>) -> Result<Self> {
        self.spacing = corners;
        self.check_stages()?;
        Ok(self)
    }

    /// The heat that the operators bind: how much warmer the body would be, in degrees, if a whole
    /// stroke bound none. 0 for none.
    #[must_use]
    pub fn latent(&self) -> f64 {
        self.latent
    }

    /// The same model with heat that the operators bind.
    ///
    /// ```
    /// use hysteron::{FirstOrder, Model, Operator, Plane, Sample, Sign};
    /// let plane = Plane::new(1.0, 2.0, 2)?;
    /// let mut model = Model::new(Operator::Mkp, plane, vec![1.0; 3], 0.0, Sign::Positive)?;
    /// model.thermal = Some(FirstOrder { gain: 2.0, ..FirstOrder::default() });
    /// let model = model.with_latent(3.0)?;
    /// let mut state = model.start();
    /// model.step(&mut state, 0.0)?;
    /// let heated = model.step(&mut state, Sample { dt: Some(50.0), ..1.0.into() })?;
    /// let bound = 3.0 * heated.output / 3.0; // of a whole stroke of 3
    /// assert!((state.temperature() + bound - 2.0).abs() < 1e-12);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Core`] for a number below zero or not finite, a model without a body, relays, and
    /// weights below zero.
    pub fn with_latent(mut self, degrees: f64) -> Result<Self> {
        self.latent = degrees;
        self.check_stages()?;
        Ok(self)
    }

    /// At which inputs rising and falling input pass each threshold, where these inputs are not the
    /// positions on the axis of the operators.
    #[must_use]
    pub fn registration(&self) -> &Registration {
        &self.registration
    }

    /// The terms of the creep after the operators.
    #[must_use]
    pub fn creep(&self) -> Vec<CreepTerm> {
        self.behind.terms()
    }

    /// Time constant of the lag after the operators, in seconds; 0 for none.
    #[must_use]
    pub fn lag(&self) -> f64 {
        self.behind.lag()
    }

    /// The output of the stages behind the operators that do not depend on time, for an output of
    /// the operators.
    pub(crate) fn untimed(&self, output: f64) -> f64 {
        if self.behind.is_none() {
            return output;
        }
        let sign = self.sign().factor();
        let sum = sign * (output - self.offset());
        self.offset() + sign * self.stages().behind.untimed(sum)
    }

    /// The same model with other constants of the stages behind the operators, by their names.
    ///
    /// ```
    /// # use hysteron::{Model, Operator, Plane, Sign};
    /// # let plane = Plane::new(1.0, 2.0, 2)?;
    /// # let model = Model::new(Operator::Mkp, plane, vec![1.0; 3], 0.0, Sign::Positive)?;
    /// let knots = [("curve_sums", vec![0.0, 1.0, 3.0]), ("curve_outputs", vec![0.0, 4.0, 5.0])];
    /// let model = model.with_behind(knots)?;
    /// assert_eq!(model.step(&mut model.start(), 2.0)?.output, 5.0); // of a sum of 3
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Core`] as [`StageConstants::new`], and for a constant out of its range.
    pub fn with_behind<N: AsRef<str>>(
        mut self,
        named: impl IntoIterator<Item = (N, Vec<f64>)>,
    ) -> Result<Self> {
        let constants = self.behind.with(named)?;
        // What stands in front of the operators has fields of its own.
        let behind = constants.stages().behind;
        self.behind = StageConstants::from_stages(&Stages {
            behind,
            ..Stages::NONE
        });
        self.check_stages()?;
        Ok(self)
    }

    /// The same model with creep and lag after the operators.
    ///
    /// # Errors
    /// [`Error::Core`] for more than [`hysteron_core::MAX_CREEP`] terms, a negative coefficient, a
    /// time constant that is not above zero, and a negative lag.
    pub fn with_after(mut self, creep: &[CreepTerm], lag: f64) -> Result<Self> {
        self.behind = StageConstants::after(creep, lag)?;
        self.check_stages()?;
        Ok(self)
    }

    /// The constants of all stages, by the names that the stages declare
    /// ([`Stages::declared`](hysteron_core::Stages::declared)).
    #[must_use]
    pub fn constants(&self) -> StageConstants<f64> {
        StageConstants::from_stages(&self.stages())
    }

    /// The input where the operators are at their lowest and at their highest: the temperature
    /// with a body, at the middle load with a load.
    #[must_use]
    pub fn active_range(&self) -> (f64, f64) {
        let plane = self.plane();
        let (low, high) = match self.spacing.as_slice() {
            [low, .., high] => (*low, *high),
            _ => (plane.bottom(), plane.max()),
        };
        let axis = self.stages().axis;
        let middle = self.load.as_ref().map(|load| {
            let (from, to) = load.range();
            0.5 * (from + to)
        });
        // A corner of the spacing is level 0 and level K, which stand for the ends of the plane.
        let axis = Axis {
            spacing: &[],
            ..axis
        };
        match axis.load.at(middle) {
            Ok(at) => {
                let input = |way, x| axis.backward(plane, at, way, x);
                (
                    input(Direction::Falling, low),
                    input(Direction::Rising, high),
                )
            }
            Err(_) => (low, high),
        }
    }

    /// The range of the drive if none is given: that of the drives fitted. Without a record of
    /// them it ends at the drives that hold the lowest and the highest level. A model without a
    /// thermal body has no limits.
    #[must_use]
    pub fn drive_range(&self) -> (f64, f64) {
        let Some(body) = self.thermal else {
            return (f64::NEG_INFINITY, f64::INFINITY);
        };
        let (low, high) = self.active_range();
        let body = body.core();
        self.drive
            .unwrap_or_else(|| (body.hold(low), body.hold(high)))
    }

    /// The error of the core in words that name the model's stage.
    pub(crate) fn worded(&self, error: hysteron_core::Error) -> Error {
        match error {
            hysteron_core::Error::TimeStep => crate::model::needs_time(),
            hysteron_core::Error::Load => match &self.load {
                Some(load) => load.one_is_needed(),
                None => error.into(),
            },
            other => other.into(),
        }
    }
}

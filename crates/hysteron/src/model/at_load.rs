//! The model at one load, and the model whose axis is shifted.

use crate::error::Result;
use crate::model::load::{LoadCurves, LoadPart, no_load};
use crate::model::{FittedStart, Model, Operators, Plane};
use hysteron_core::Operator;

impl Model {
    /// As [`Model::output_range`] of [`Model::at_load`], without that model.
    pub(crate) fn output_range_at(&self, load: f64) -> Result<(f64, f64)> {
        let Some(dependence) = &self.load else {
            return Err(no_load());
        };
        let LoadPart { offset, weights } = dependence.at(load)?;
        let curves = dependence.curves.as_ref();
        let loaded = curves
            .map_or(hysteron_core::Load::NONE, LoadCurves::core)
            .at(Some(load))?;
        let sum = loaded.gain * weights.iter().sum::<f64>();
        let (offset, behind) = (offset + loaded.offset, self.stages().behind);
        let output = |sum| offset + self.sign().factor() * behind.untimed(sum);
        Ok(match self.operator() {
            Operator::Mkp => (output(0.0), output(sum)),
            Operator::Kp | Operator::Relay => (output(-sum), output(sum)),
        })
    }

    /// The model of which the axis is shifted by `shift` more, in the input's unit, from the load
    /// `given`. It does not depend on a load.
    ///
    /// If the model's curve of shifts tells a load there, it is the model at that load. What lies
    /// beyond the curve is a shift alone.
    ///
    /// ```
    /// # use hysteron::{Model, Operator, Plane, Sign};
    /// let plane = Plane::new(20.0, 80.0, 3)?;
    /// let model = Model::new(Operator::Mkp, plane, vec![1.0; 6], 0.0, Sign::Positive)?;
    /// assert_eq!(model.shifted(None, 8.0)?.plane().min(), 28.0);
    /// # Ok::<(), hysteron::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Model::at_load`].
    pub fn shifted(&self, given: Option<f64>, shift: f64) -> Result<Self> {
        let (Some(dependence), Some(given)) = (&self.load, given) else {
            return self.moved(shift);
        };
        let Some(curves) = &dependence.curves else {
            return self.at_load(given)?.moved(shift);
        };
        let wanted = curves.at(given)?.shift + shift;
        let load = curves.core().of_shift(wanted).unwrap_or(given);
        let there = curves.at(load)?;
        self.at_load(load)?
            .moved((wanted - there.shift) / there.scale)
    }

    /// The model with its levels moved by `shift`, for a model that depends on no load.
    fn moved(&self, shift: f64) -> Result<Self> {
        let mut model = self.clone();
        model.registration = self.registration.moved(|x| x + shift);
        if self.spacing.is_empty() {
            let plane = self.plane();
            let plane = Plane::new(plane.min() + shift, plane.max() + shift, plane.levels())?;
            let weights = self.weights().to_vec();
            let (operator, sign) = (self.operator(), self.sign());
            model.operators = Operators::new(operator, plane, weights, self.offset(), sign)?;
            if let Some(start) = &mut model.start {
                start.input += shift;
            }
        } else {
            // The corners move; the plane behind them stays.
            for corner in &mut model.spacing {
                *corner += shift;
            }
        }
        Ok(model)
    }

    /// The model at one load. The result does not depend on a load.
    ///
    /// # Errors
    /// [`crate::Error::Fit`] if the model does not depend on a load, or for a load outside its range.
    pub fn at_load(&self, load: f64) -> Result<Self> {
        let Some(dependence) = &self.load else {
            return Err(no_load());
        };
        let LoadPart { offset, weights } = dependence.at(load)?;
        let curves = dependence.curves.clone().unwrap_or_default();
        let loaded = curves.at(load)?;
        let moved = |x: f64| (x + loaded.shift) / loaded.scale;
        let plane = self.plane();
        let plane = match self.spacing.is_empty() {
            true => Plane::new(moved(plane.min()), moved(plane.max()), plane.levels())?,
            // The corners move; the plane behind them stays.
            false => *plane,
        };
        let weights = weights.iter().map(|mu| loaded.gain * mu).collect();
        let offset = offset + loaded.offset;
        let operators = Operators::new(self.operator(), plane, weights, offset, self.sign())?;
        let start = self.start.as_ref().map(|start| {
            let spaced = !self.spacing.is_empty();
            let input = if spaced {
                start.input
            } else {
                moved(start.input)
            };
            FittedStart {
                input,
                ..start.clone()
            }
        });
        Ok(Self {
            operators,
            load: None,
            registration: self.registration.at(loaded, moved),
            spacing: self.spacing.iter().map(|corner| moved(*corner)).collect(),
            start,
            ..self.clone()
        })
    }
}

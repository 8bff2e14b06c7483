//! The linear problem of a fit: checked options, regressor, target, and the choice of the sign.

use crate::error::{Error, Result};
use crate::identify::options::FitOptions;
use crate::identify::weights::experiment::Experiment;
use crate::identify::weights::free::FreeColumns;
use crate::identify::weights::regressor::Regressor;
use crate::identify::weights::room::{check_columns, check_dense};
use crate::identify::weights::solve::{NormalEquations, Penalised, STEPS, Solution};
use crate::model::{LoadPart, Sign};
use crate::model::{Solver, Start};
use crate::progress::Progress;
use crate::recording::Recording;
use hysteron_core::Operator;
use std::sync::Arc;

/// One sign is better than the other if it explains this share of the squares more. Rounding of the
/// sums is far below it.
const CLEAR: f64 = 1e-6;

pub(crate) struct Problem<'a> {
    pub(crate) experiment: Experiment<'a>,
    pub(crate) regressor: Regressor,
    pub(crate) options: FitOptions,
}

/// The best weights, and the sign that belongs to them.
pub(crate) struct Fitted {
    pub(crate) solution: Solution,
    pub(crate) sign: Sign,
}

impl<'a> Problem<'a> {
    pub(crate) fn new(recordings: &'a [Recording], options: &FitOptions) -> Result<Self> {
        check_options(options)?;
        let experiment = Experiment::new(recordings, options)?;
        if options.offset.is_some() && experiment.load_range.is_some() {
            return Err(Error::Fit(
                "a fixed offset cannot depend on the load: leave one of them out".into(),
            ));
        }
        let plane = experiment.plane(recordings, options)?;
        let sides = if options.start == Start::Unknown {
            2
        } else {
            1
        };
        let columns = plane.operators() * experiment.parts.len() * sides;
        check_columns(columns)?;
        if options.bootstrap > 0 {
            // It needs all eigenvalues of the matrix.
            check_dense(columns)?;
        }
        let regressor = Regressor::new(plane, options, &experiment)?;
        Ok(Self {
            experiment,
            regressor,
            options: options.clone(),
        })
    }

    /// The right-hand side of the fit at a sample: the output minus a known offset, with the sign
    /// turned so that non-negative weights fit it.
    pub(crate) fn target(&self, sign: Sign, sample: usize) -> f64 {
        self.turned(sign)(&self.experiment.output[sample])
    }

    /// The targets of all samples.
    pub(crate) fn targets(&self, sign: Sign) -> impl Iterator<Item = f64> + Clone {
        self.experiment.output.iter().map(self.turned(sign))
    }

    fn turned(&self, sign: Sign) -> impl Fn(&f64) -> f64 + Clone + use<> {
        let offset = self.options.offset.unwrap_or(0.0);
        move |output| sign.factor() * (output - offset)
    }

    pub(crate) fn free(&self, kept: Option<&[f64]>) -> Result<FreeColumns> {
        match self.options.offset {
            Some(_) => Ok(FreeColumns::none()),
            None => FreeColumns::new(&self.experiment.offsets, kept),
        }
    }

    /// `A x` plus the free columns at every sample, whether it was kept or not.
    pub(crate) fn predict(&self, solution: &Solution) -> Result<Vec<f64>> {
        self.predict_over(&self.experiment, solution)
    }

    /// As [`Problem::predict`], over the same recordings with more samples.
    pub(crate) fn predict_over(
        &self,
        experiment: &Experiment<'_>,
        solution: &Solution,
    ) -> Result<Vec<f64>> {
        let mut output = self.regressor.forward(experiment, &solution.x)?;
        for (part, value) in experiment.offsets.iter().zip(&solution.free) {
            output
                .iter_mut()
                .zip(part.iter())
                .for_each(|(y, z)| *y += value * z);
        }
        Ok(output)
    }

    /// The outputs at every sample, in their unit and with their sign, whether it was kept or not.
    /// A known offset is among them.
    pub(crate) fn outputs(&self, fitted: &Fitted) -> Result<Vec<f64>> {
        self.outputs_over(&self.experiment, fitted)
    }

    /// As [`Problem::outputs`], as they are measured: with what known curves over the load add.
    pub(crate) fn measured_outputs(&self, fitted: &Fitted) -> Result<Vec<f64>> {
        Ok(self.experiment.as_measured(self.outputs(fitted)?))
    }

    /// As [`Problem::outputs`], over the same recordings with more samples.
    pub(crate) fn outputs_over(
        &self,
        experiment: &Experiment<'_>,
        fitted: &Fitted,
    ) -> Result<Vec<f64>> {
        let mut outputs = self.predict_over(experiment, &fitted.solution)?;
        let (offset, sign) = (self.options.offset.unwrap_or(0.0), fitted.sign.factor());
        outputs.iter_mut().for_each(|h| *h = offset + sign * *h);
        Ok(outputs)
    }

    /// Offset and weights for each function of the load, converted from states in `[0, 1]` to the
    /// operator's own outputs.
    pub(crate) fn load_parts(&self, x: &[f64], free: &[f64], sign: Sign) -> Vec<LoadPart> {
        let mut weights = self.regressor.weights(x);
        // Weights that do not depend on the load are the same in each part of the offset.
        if let [constant] = weights.as_slice() {
            weights = vec![constant.clone(); self.experiment.offsets.len()];
        }
        let weights = weights.into_iter().enumerate();
        let part = |(part, mut weights): (usize, Vec<f64>)| {
            let identified = sign.factor() * free.get(part).copied().unwrap_or(0.0);
            let mut offset = self.options.offset.unwrap_or(identified);
            if self.options.operator != Operator::Mkp {
                // μ γ = (μ/2) (2γ − 1) + μ/2
                weights.iter_mut().for_each(|mu| *mu *= 0.5);
                offset += sign.factor() * weights.iter().sum::<f64>();
            }
            LoadPart { offset, weights }
        };
        weights.map(part).collect()
    }

    /// Offset and weights; with a load, those at the middle of its range.
    pub(crate) fn at_middle(&self, x: &[f64], free: &[f64], sign: Sign) -> LoadPart {
        LoadPart::at_middle(&self.load_parts(x, free, sign))
    }

    /// The best weights over the samples kept (all if `None`).
    pub(crate) fn solve(&mut self, kept: Option<&[f64]>, progress: Progress<'_>) -> Result<Fitted> {
        Ok(self.solve_keeping(kept, progress)?.0)
    }

    /// As [`Problem::solve`], with the matrix that was solved.
    pub(super) fn solve_keeping(
        &mut self,
        kept: Option<&[f64]>,
        progress: Progress<'_>,
    ) -> Result<(Fitted, Arc<Penalised>)> {
        let free = self.free(kept)?;
        loop {
            check_columns(self.regressor.columns().len())?;
            let (fitted, slopes, penalised) = {
                let levels = self.regressor.plane().levels();
                let start = self.coarse(levels, &free, kept, progress)?;
                let equations = NormalEquations::new(
                    &self.regressor,
                    &self.experiment,
                    &free,
                    kept,
                    self.options.prior(),
                    progress,
                )?;
                let fitted = self.best_sign(&equations, start, STEPS, progress)?;
                let slopes = equations.slopes(&fitted.solution.x);
                (fitted, slopes, equations.penalised)
            };
            // Rounding of a gradient: the solver takes smaller values for zero.
            let residual = &fitted.solution.residual;
            let rounding = 1e-9 * residual.iter().map(|r| r * r).sum::<f64>().sqrt();
            if self.options.solver == Solver::Ols
                || !self
                    .regressor
                    .take_missing(&self.experiment, residual, &slopes, rounding)?
            {
                return Ok((fitted, penalised));
            }
        }
    }

    /// The signs that may be the better one, each with weights to start from. The targets of the
    /// two signs differ in their sign only, so one pass over the samples rates both. Only where
    /// rounding could hide which is better are both kept.
    fn promising(
        &self,
        equations: &NormalEquations<'_>,
        progress: Progress<'_>,
    ) -> Result<Vec<(Sign, Option<Vec<f64>>)>> {
        let (right, squares) = equations.right(self.targets(Sign::Positive))?;
        let mut rated = Vec::new();
        for sign in [Sign::Positive, Sign::Negative] {
            let right: Vec<f64> = right.iter().map(|b| sign.factor() * b).collect();
            let (x, gain) = equations.penalised.nonnegative(&right, progress)?;
            rated.push((sign, x, gain));
        }
        let clear = CLEAR * squares;
        let most = rated[0].2.max(rated[1].2);
        let near = rated.into_iter().filter(|(.., gain)| *gain >= most - clear);
        Ok(near.map(|(sign, x, _)| (sign, Some(x))).collect())
    }

    /// The best weights, of the better sign, after at most so many proximal steps. A `start` has a
    /// sign and weights to begin with.
    pub(super) fn best_sign(
        &self,
        equations: &NormalEquations<'_>,
        start: Option<(Sign, Vec<f64>)>,
        steps: usize,
        progress: Progress<'_>,
    ) -> Result<Fitted> {
        let signs = match (self.options.sign, start) {
            (_, Some((sign, start))) => vec![(sign, Some(start))],
            (Some(sign), None) => vec![(sign, None)],
            // Without the constraint both signs give the same output.
            (None, None) if self.options.solver == Solver::Ols => vec![(Sign::Positive, None)],
            (None, None) => self.promising(equations, progress)?,
        };
        let mut best: Option<Fitted> = None;
        for (sign, start) in signs {
            let solution = equations.solve(
                self.targets(sign),
                self.options.solver,
                start.as_deref(),
                steps,
                progress,
            )?;
            if best
                .as_ref()
                .is_none_or(|best| solution.objective < best.solution.objective)
            {
                best = Some(Fitted { solution, sign });
            }
        }
        let mut fitted = best.ok_or_else(|| Error::Fit("no sign to try".into()))?;
        // If the weights are mostly negative, the output falls: turn sign and weights.
        if self.options.sign.is_none() && fitted.solution.x.iter().sum::<f64>() < 0.0 {
            let Solution {
                x, free, residual, ..
            } = &mut fitted.solution;
            for values in [x, free, residual] {
                values.iter_mut().for_each(|v| *v = -*v);
            }
            fitted.sign = Sign::Negative;
        }
        Ok(fitted)
    }
}

/// Checks what the data do not decide.
pub(crate) fn check_options(options: &FitOptions) -> Result<()> {
    let FitOptions {
        offset,
        smooth,
        ridge,
        load_degree,
        bootstrap,
        ..
    } = options;
    if let Some(offset) = offset.filter(|offset| offset.is_nan() || offset.abs() > 1e140) {
        return Err(Error::Fit(format!(
            "the offset {offset} is not a number, or is too large to be squared"
        )));
    }
    for strength in [smooth.along, smooth.across] {
        if !(0.0..=1e6).contains(&strength) {
            return Err(Error::Fit(format!(
                "the smoothness {strength} is not between 0 and 1e6"
            )));
        }
    }
    if !(0.0..=1.0).contains(ridge) {
        return Err(Error::Fit(format!(
            "the ridge {ridge} is not between 0 and 1"
        )));
    }
    if options.start == Start::Fitted {
        return Err(Error::Fit(
            "a fit finds the start, and cannot begin from a fitted one: take off, on, rest or unknown"
                .into(),
        ));
    }
    if options.start == Start::Rest
        && options
            .rest
            .is_none_or(|rest| !rest.iter().all(|x| x.is_finite()))
    {
        return Err(Error::Fit(
            "a start at rest needs the inputs of the rest: they are found for a model without \
             thermal body and load, so take off, on or unknown"
                .into(),
        ));
    }
    if let Some(degree) = load_degree.filter(|degree| *degree > 5) {
        return Err(Error::Fit(format!(
            "weights of order {degree} in the load: take 5 at most"
        )));
    }
    if *bootstrap > 10_000 {
        return Err(Error::Fit(format!(
            "{bootstrap} replicates: take 10000 at most"
        )));
    }
    Ok(())
}

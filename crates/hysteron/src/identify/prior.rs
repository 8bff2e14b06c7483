//! A prior of offset and weights with a full covariance, from other actuators of the same kind, and
//! the fit under it.

use crate::error::{Error, Result};
use crate::identify::fixed::described;
use crate::identify::options::FitOptions;
use crate::identify::pivoting;
use crate::identify::weights::corner_system::eliminate;
use crate::identify::weights::gram::dot;
use crate::identify::weights::not_definite::not_definite;
use crate::identify::weights::problem::{Fitted, Problem};
use crate::identify::weights::solve::{Solution, dense_factor};
use crate::model::{Model, Smooth, Solver, Start, Surroundings};
use crate::progress::Progress;
use crate::recording::Recording;
use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use hysteron_core::Operator;
use serde_json::json;

/// Fewer models than this do not show how actuators differ.
const ENOUGH: usize = 10;

/// Of more models than this, so many are taken, evenly spread. More would not change the
/// covariance by what can be seen.
const MOST: usize = 1000;

/// Least standard deviation of a weight, relative to the mean one: what no other actuator has is
/// unlikely, and not impossible.
const LEAST: f64 = 0.01;

/// Ridge relative to the mean diagonal element. It is far above rounding, and far below what a
/// sample determines.
const TINY: f64 = 1e-11;

/// What is known of an actuator before its recording: mean and covariance of offset and weights of
/// others of its kind.
///
/// The fit under this prior minimises `|A x − y|² / σ² + (x − m)ᵀ S⁻¹ (x − m)` over weights from 0
/// on (empirical Bayes, Efron 2010). `m` is the mean, `S` the covariance, shrunk towards its
/// diagonal by as much as the number of models asks for (Schäfer and Strimmer 2005). `σ` is the
/// median error of the models. So a short recording decides what it determines. Of the rest it
/// decides what goes together with that in the other actuators.
///
/// ```
/// use hysteron::{Fit, Recording, WeightPrior};
/// // Actuators that differ in one number: their stroke.
/// let record = |stroke: f64, samples: u32| {
///     let input = |n: u32| (1.0 - (f64::from(n) * 0.05).cos()) * 30.0;
///     let input: Vec<f64> = (0..samples).map(input).collect();
///     let mut play = 0.0_f64;
///     let output = input.iter().map(|x| {
///         play = play.clamp(x - 20.0, *x);
///         stroke * play
///     });
///     let output = output.collect();
///     Recording::new(input, output)
/// };
/// let fit = Fit::new().levels(12).range(0.0, 60.0).spacing(hysteron::Spacing::Uniform);
/// let fit = fit.bootstrap(0);
/// let models = (0..12).map(|n| fit.run(&record(1.0 + 0.1 * f64::from(n), 300)?));
/// let models = models.collect::<hysteron::Result<Vec<_>>>()?;
///
/// // Two thirds of a rise are enough for the next one.
/// let prior = WeightPrior::from_models(&models)?;
/// let (part, whole) = (record(1.55, 40)?, record(1.55, 300)?);
/// let error = |model: &_| Ok::<_, hysteron::Error>(hysteron::evaluate(model, &whole)?.forward.rmse);
/// let known = error(&fit.run(&whole)?)?;
/// assert!(error(&fit.clone().prior(prior).run(&part)?)? < 1.01 * known);
/// assert!(error(&fit.run(&part)?)? > 2.0 * known);
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct WeightPrior {
    /// Plane, spacing, operator, sign, and what input and output are.
    model: Model,
    count: usize,
    /// Mean of offset and weights, in terms of states from 0 to 1; the offset comes first.
    mean: Vec<f64>,
    /// Inverse of their covariance, row by row.
    precision: Vec<f64>,
    /// Variance of the output around the model.
    noise: f64,
    /// How the recordings of the models began.
    start: Start,
}

impl WeightPrior {
    /// The prior of `models`, which have the same plane, spacing, operator and sign, and neither a
    /// load nor stages that depend on time or stand behind the operators.
    ///
    /// # Errors
    /// [`Error::Fit`] for fewer than 10 models, for models that differ in more than weights and
    /// offset, and for models that were not fitted.
    pub fn from_models(models: &[Model]) -> Result<Self> {
        let Some(first) = models.first().filter(|_| models.len() >= ENOUGH) else {
            let count = models.len();
            let problem = format!("{count} models make no prior: {ENOUGH} or more are needed");
            return Err(Error::Fit(problem));
        };
        if let Some(n) = models.iter().position(|model| !same_kind(first, model)) {
            return Err(Error::Fit(format!(
                "model {} of the prior has another plane, spacing, operator or sign than the \
                 first: fit all with the same range, levels and spacing",
                n + 1
            )));
        }
        if !is_static(first) {
            let problem = "a prior is of weights alone, and these models have a load or stages that \
                           depend on time: fit them without (dynamics off)";
            return Err(Error::Fit(problem.into()));
        }
        let errors = models.iter().map(|model| Some(model.fit.as_ref()?.rmse));
        let Some(mut errors) = errors.collect::<Option<Vec<f64>>>() else {
            let problem = "a prior needs models that were fitted, because it needs their errors";
            return Err(Error::Fit(problem.into()));
        };
        errors.sort_by(f64::total_cmp);
        let start = |model: &Model| model.fit.as_ref().map(|fit| fit.start);
        let alike = models.iter().all(|model| start(model) == start(first));
        let start = start(first).filter(|start| alike && matches!(start, Start::Off | Start::On));
        let step = models.len().div_ceil(MOST);
        let rows: Vec<Vec<f64>> = models.iter().step_by(step).map(in_states).collect();
        let (mean, covariance) = moments(&rows);
        let factor = covariance
            .llt(Side::Lower)
            .map_err(|_| not_definite())?
            .solve(&Mat::<f64>::identity(mean.len(), mean.len()));
        let size = mean.len();
        Ok(Self {
            model: first.clone(),
            count: models.len(),
            precision: (0..size * size)
                .map(|n| factor[(n / size, n % size)])
                .collect(),
            mean,
            noise: errors[errors.len() / 2].powi(2).max(f64::MIN_POSITIVE),
            start: start.unwrap_or(Start::Unknown),
        })
    }

    /// Number of models.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// How the recordings of the models began: off or on if all did, and otherwise unknown.
    #[must_use]
    pub fn start(&self) -> Start {
        self.start
    }

    /// Fits the weights. Of the `options`, solver and start count; plane and operator are those of
    /// the prior.
    pub(crate) fn fit(
        &self,
        recordings: &[Recording],
        options: &FitOptions,
        progress: Progress<'_>,
    ) -> Result<Model> {
        let plane = self.model.plane();
        let options = FitOptions {
            operator: self.model.operator(),
            levels: plane.levels(),
            range: Some((plane.min(), plane.max())),
            sign: Some(self.model.sign()),
            smooth: Smooth::NONE,
            ridge: 0.0,
            offset: None,
            bootstrap: 0,
            ..options.clone()
        };
        let mut seen = recordings.to_vec();
        for recording in &mut seen {
            if recording.load.is_some() {
                let problem = "a prior of weights knows no load: leave the load out";
                return Err(Error::Fit(problem.into()));
            }
            let input = self.model.seen(&recording.input, Surroundings::default())?;
            recording.input = input.into_owned();
        }
        let problem = Problem::new(&seen, &options)?;
        let solution = self.minimum(&problem, progress)?;
        let sign = self.model.sign();
        let model = described(&problem, &Fitted { solution, sign }, recordings)?;
        let mut model = model.with_spacing(self.model.spacing().to_vec())?;
        let record = json!({ "models": self.count, "noise": self.noise.sqrt() });
        if let Some(fit) = &mut model.fit {
            fit.other.insert("prior".to_owned(), record);
        }
        Ok(model)
    }

    /// The most probable offset and weights.
    fn minimum(&self, problem: &Problem, progress: Progress<'_>) -> Result<Solution> {
        let (regressor, experiment) = (&problem.regressor, &problem.experiment);
        let sign = self.model.sign();
        let samples = experiment.output.len();
        let mut grams = regressor.grams(experiment, 1, |_| Some(0), progress)?;
        let mut matrix = grams.pop().unwrap_or_default();
        // `σ²` times the objective. Several columns may belong to one weight, which is their sum.
        let size = self.mean.len();
        let precision = |i: usize, j: usize| self.noise * self.precision[i * size + j];
        let pull =
            |i: usize| self.noise * dot(&self.precision[i * size..(i + 1) * size], &self.mean);
        let place = regressor.columns().iter().map(|column| column.operator + 1);
        let place: Vec<usize> = place.collect();
        let count = place.len();
        for (i, row) in matrix.chunks_exact_mut(count).enumerate() {
            let own = place.iter().map(|j| precision(place[i], *j));
            row.iter_mut().zip(own).for_each(|(m, p)| *m += p);
        }
        // The data may not tell the columns of one weight apart.
        let diagonal = (0..count).map(|n| matrix[n * (count + 1)]);
        let tiny = TINY * diagonal.sum::<f64>() / count as f64;
        (0..count).for_each(|n| matrix[n * (count + 1)] += tiny);
        // The offset may have any sign, so it is eliminated.
        let mut mixed = regressor.adjoint(experiment, |_| 1.0)?;
        let own = mixed.iter_mut().zip(&place);
        own.for_each(|(m, n)| *m += precision(*n, 0));
        let inverse = 1.0 / (samples as f64 + precision(0, 0));
        let middle = inverse * (problem.targets(sign).sum::<f64>() + pull(0));
        eliminate(&mut matrix, std::slice::from_ref(&mixed), &[vec![inverse]]);
        let mut right = regressor.adjoint(experiment, |n| problem.target(sign, n))?;
        for ((b, m), n) in right.iter_mut().zip(&mixed).zip(&place) {
            *b += pull(*n) - middle * m;
        }
        let x = match problem.options.solver {
            Solver::Nnls => {
                let start: Vec<f64> = place.iter().map(|n| self.mean[*n].max(0.0)).collect();
                pivoting::nonnegative(&matrix, &right, &start, progress)?
            }
            Solver::Ols => dense_factor(&matrix)?.solve(&right),
        };
        let offset = middle - inverse * dot(&mixed, &x);
        let mut residual = regressor.forward(experiment, &x)?;
        let all = residual.iter_mut().zip(problem.targets(sign));
        all.for_each(|(h, y)| *h = y - *h - offset);
        Ok(Solution {
            objective: dot(&residual, &residual),
            residual,
            free: vec![offset],
            x,
        })
    }
}

/// Whether two models differ in weights and offset alone.
fn same_kind(a: &Model, b: &Model) -> bool {
    a.plane() == b.plane()
        && a.spacing() == b.spacing()
        && a.operator() == b.operator()
        && a.sign() == b.sign()
        && is_static(a) == is_static(b)
}

/// Whether the model has no stage besides the spacing of its levels.
fn is_static(model: &Model) -> bool {
    let behind = model.stages().behind.there().any(|(_, there)| there);
    !model.is_timed() && !behind && model.load.is_none() && model.registration().is_none()
}

/// Offset and weights for states from 0 to 1 and a rising output: see `Problem::load_parts`.
fn in_states(model: &Model) -> Vec<f64> {
    let (scale, below) = match model.operator() {
        Operator::Mkp => (1.0, 0.0),
        _ => (2.0, model.weights().iter().sum()),
    };
    let offset = model.sign().factor() * model.offset() - below;
    let weights = model.weights().iter().map(|weight| scale * weight);
    std::iter::once(offset).chain(weights).collect()
}

/// Mean and covariance of the rows. The covariance is shrunk towards its diagonal.
fn moments(rows: &[Vec<f64>]) -> (Vec<f64>, Mat<f64>) {
    let (count, size) = (rows.len() as f64, rows[0].len());
    let mean = |n: usize| rows.iter().map(|row| row[n]).sum::<f64>() / count;
    let mean: Vec<f64> = (0..size).map(mean).collect();
    let centred: Vec<Vec<f64>> = (0..size)
        .map(|n| rows.iter().map(|row| row[n] - mean[n]).collect())
        .collect();
    let mut covariance = Mat::zeros(size, size);
    let (mut doubt, mut squares) = (0.0, 0.0);
    for i in 0..size {
        for j in 0..=i {
            let product = dot(&centred[i], &centred[j]);
            covariance[(i, j)] = product / (count - 1.0);
            covariance[(j, i)] = covariance[(i, j)];
            if i != j {
                let of_each = centred[i].iter().zip(&centred[j]).map(|(a, b)| a * b);
                let spread = of_each.map(|p| (p - product / count).powi(2)).sum::<f64>();
                doubt += count / (count - 1.0).powi(3) * spread;
                squares += covariance[(i, j)].powi(2);
            }
        }
    }
    let keep = match squares > 0.0 {
        true => 1.0 - (doubt / squares).min(1.0),
        false => 0.0,
    };
    let weight = mean[1..].iter().map(|m| m.abs()).sum::<f64>() / (size - 1) as f64;
    let least = (LEAST * weight).powi(2).max(f64::MIN_POSITIVE);
    for i in 0..size {
        for j in 0..size {
            match i == j {
                true => covariance[(i, i)] += least,
                false => covariance[(i, j)] *= keep,
            }
        }
    }
    (mean, covariance)
}

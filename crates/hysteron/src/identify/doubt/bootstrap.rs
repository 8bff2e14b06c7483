//! The bootstrap over branches: how much the weights would differ with other errors in the data.

use crate::error::Result;
use crate::identify::weights::free::FreeColumns;
use crate::identify::weights::gram::dot;
use crate::identify::weights::problem::{Fitted, Problem};
use crate::identify::weights::solve::NormalEquations;
use crate::identify::weights::sums::{Coefficients, Sums, centred};
use crate::identify::weights::unit_sums::UnitSums;
use crate::identify::weights::units::{Folds, Units};
use crate::model::LoadPart;
use crate::parallel;
use crate::progress::Progress;
use faer::Mat;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use std::sync::atomic::{AtomicUsize, Ordering};

/// With fewer branches than this, parts of branches are the units instead.
pub(crate) const ENOUGH_BRANCHES: usize = 16;

/// Largest number of fits that leave something out. With more units than this, several are left out
/// together.
const GROUPS: usize = 40;

/// Share of the variance that the factors keep, and the largest number of factors.
const KEPT: f64 = 0.99;
const FACTORS: usize = 12;

/// Offsets and weights of fits to replicates of the data.
///
/// A wild bootstrap over branches (Wu 1986; Cameron, Gelbach and Miller 2008). The residuals of a
/// fit that left a branch out are added to the fitted output, with a random sign for each whole
/// branch. Then the model is fitted again. Errors of a model are similar along a branch, and a
/// common sign for the branch preserves that.
///
/// The prior counts as data with noise of standard deviation `noise`: its pull on the weights is
/// drawn anew as well (randomise, then optimise: Bardsley et al. 2014). So weights that only the
/// prior determines differ between replicates as much as the prior allows.
pub(crate) fn replicates(
    problem: &Problem,
    fitted: &Fitted,
    equations: &NormalEquations<'_>,
    free: &FreeColumns,
    (left_out, noise): (&LeftOutErrors, f64),
    progress: Progress<'_>,
) -> Result<Vec<LoadPart>> {
    let (options, experiment) = (&problem.options, &problem.experiment);
    let regressor = &problem.regressor;
    let solution = &fitted.solution;
    let factor = equations.penalised.factor(options.solver)?;
    let LeftOutErrors { units, errors } = left_out;
    let sums = UnitSums::new(regressor, experiment, errors, units)?;
    let of_free = free.unit_products(errors, units);
    let mixed = free.mixed(regressor, experiment)?;
    // The penalty shrinks the solution again. Subtract that effect, so that the replicates stay
    // around the fit.
    let middle = equations.penalised.times(&solution.x);
    let done = AtomicUsize::new(0);
    parallel::map(options.bootstrap, |seed| {
        let count = done.fetch_add(1, Ordering::Relaxed);
        progress.tell("confidence", count as f64 / options.bootstrap as f64)?;
        let mut rng = ChaCha8Rng::seed_from_u64(seed as u64);
        let signs: Vec<f64> = (0..units.count)
            .map(|_| if rng.next_u32() & 1 == 1 { 1.0 } else { -1.0 })
            .collect();
        let pull = equations.penalised.draw(regressor, || {
            let normal: f64 = StandardNormal.sample(&mut rng);
            noise * normal
        });
        // The added errors, with the free columns removed.
        let products: Vec<f64> = of_free.iter().map(|sums| dot(sums, &signs)).collect();
        let moved = free.values(&products);
        let mut right = sums.with_signs(regressor, &signs);
        for (column, value) in mixed.columns.iter().zip(&moved) {
            let column = column.iter();
            right
                .iter_mut()
                .zip(column)
                .for_each(|(b, z)| *b -= value * z);
        }
        right.iter_mut().zip(&middle).for_each(|(b, m)| *b += m);
        right.iter_mut().zip(&pull).for_each(|(b, p)| *b += p);
        let x =
            equations
                .penalised
                .minimum(&right, &solution.x, factor.as_ref(), Progress::NONE)?;
        // The free columns have two parts: those of the noise, and the change caused by the new
        // weights.
        let difference: Vec<f64> = x.iter().zip(&solution.x).map(|(a, b)| a - b).collect();
        let products: Vec<f64> = mixed.columns.iter().map(|z| dot(z, &difference)).collect();
        let taken = free.values(&products);
        let free_values: Vec<f64> = (0..moved.len())
            .map(|n| solution.free[n] + moved[n] - taken[n])
            .collect();
        Ok(problem.at_middle(&x, &free_values, fitted.sign))
    })
}

/// For each sample, the error of a fit without its unit. A fit bends towards each branch, more so
/// if few other branches determine the same weights. These residuals are free of that (MacKinnon,
/// Nielsen and Webb 2023).
pub(crate) fn left_out_errors(
    problem: &Problem,
    fitted: &Fitted,
    enough_branches: usize,
    progress: Progress<'_>,
) -> Result<LeftOutErrors> {
    let (regressor, experiment) = (&problem.regressor, &problem.experiment);
    let folds = Folds::new(Units::new(experiment, None, enough_branches), GROUPS);
    let target = centred(problem, fitted.sign);
    let report = |_: &'static str, _: f64| progress.tell("confidence", 0.0);
    let progress = Progress::new(&report);
    // The sums over all samples less those of a group are the sums of the others. Where the groups
    // take several passes, all samples are one group of a pass before.
    let passes = Sums::passes(problem, folds.count);
    let mut all = match passes.len() {
        0 | 1 => Vec::new(),
        _ => Sums::of_groups(problem, &target, |_| Some(0), 1, progress)?,
    };
    let mut solved: Vec<Coefficients> = Vec::new();
    for groups in passes {
        let own = Sums::of_some(problem, &target, |n| folds.fold(n), groups, progress)?;
        if all.is_empty() {
            all.extend(Sums::total(&own));
        }
        solved.extend(parallel::map(own.len(), |n| {
            progress.tell("confidence", 0.0)?;
            let rest = all[0].without(&own[n]).reduced()?;
            let penalised = rest.penalised(problem.options.prior(), problem);
            let (solver, near) = (problem.options.solver, &fitted.solution.x);
            rest.solve_near(&penalised, solver, near, Progress::NONE)
        })?);
    }
    let (x, free): (Vec<_>, Vec<_>) = solved.into_iter().map(|at| (at.x, at.free)).unzip();
    let mut errors = regressor.forwards(experiment, &x, |n| folds.fold(n))?;
    for (n, error) in errors.iter_mut().enumerate() {
        let Some(fold) = folds.fold(n) else {
            continue;
        };
        let level = experiment.offsets.iter().zip(&free[fold]);
        let level: f64 = level.map(|(z, value)| value * z[n]).sum();
        *error = target(n) - *error - level;
    }
    let units = folds.units;
    Ok(LeftOutErrors { units, errors })
}

/// Errors of fits that left the sample's unit out, and the units.
pub(crate) struct LeftOutErrors {
    units: Units,
    errors: Vec<f64>,
}

impl LeftOutErrors {
    /// Numbers and errors of the samples that show what the model errs by on a new branch, and the
    /// number of their units. The first branch of a recording is not among them, because no other
    /// comes from where it comes, unless there are only first branches.
    pub(crate) fn of_new_branches(
        &self,
        problem: &Problem,
    ) -> (impl Iterator<Item = (usize, f64)>, usize) {
        let units = &self.units;
        let begins = problem.experiment.recordings.iter().map(|own| own.start);
        let first: Vec<Option<usize>> = begins.map(|n| units.unit(n)).collect();
        let all = !units.whole_branches || first.len() == units.count;
        let count = units.count - if all { 0 } else { first.len() };
        let errors = self.errors.iter().copied().enumerate();
        let counts = move |n: usize| all || !first.contains(&units.unit(n));
        (errors.filter(move |(n, _)| counts(*n)), count)
    }
}

/// Root mean squared deviations of the replicates from the fit, and their principal components.
///
/// The deviations are from the fit, not from the mean of the replicates: where a weight is zero,
/// all replicates are on one side of it.
pub(crate) fn spread(replicates: &[LoadPart], fit: &LoadPart) -> (LoadPart, Vec<LoadPart>) {
    let count = fit.weights.len() + 1;
    let value = |part: &LoadPart, n: usize| match n {
        0 => part.offset,
        n => part.weights[n - 1],
    };
    let scale = 1.0 / (replicates.len() as f64).sqrt();
    let deviation = |r: usize, n: usize| scale * (value(&replicates[r], n) - value(fit, n));
    let part = |values: &dyn Fn(usize) -> f64| LoadPart {
        offset: values(0),
        weights: (1..count).map(values).collect(),
    };
    let variance =
        |n: usize| -> f64 { (0..replicates.len()).map(|r| deviation(r, n).powi(2)).sum() };
    let standard = part(&|n| variance(n).sqrt());
    let matrix = Mat::from_fn(count, replicates.len(), |n, r| deviation(r, n));
    let Ok(svd) = matrix.thin_svd() else {
        return (standard, Vec::new());
    };
    let sizes: Vec<f64> = (0..svd.S().column_vector().nrows())
        .map(|k| svd.S().column_vector()[k])
        .collect();
    let total: f64 = sizes.iter().map(|s| s * s).sum();
    let mut kept = 0.0;
    let mut factors = Vec::new();
    for (k, size) in sizes.iter().enumerate().take(FACTORS) {
        if total == 0.0 || kept >= KEPT * total {
            break;
        }
        kept += size * size;
        factors.push(part(&|n| size * svd.U()[(n, k)]));
    }
    // The variance of the omitted factors is spread over the factors kept, so that the band is not
    // too narrow.
    let stretch = if kept > 0.0 {
        (total / kept).sqrt()
    } else {
        1.0
    };
    for factor in &mut factors {
        factor.offset *= stretch;
        factor.weights.iter_mut().for_each(|mu| *mu *= stretch);
    }
    (standard, factors)
}

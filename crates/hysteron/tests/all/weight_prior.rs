//! A fit under the prior of other actuators.

use hysteron::{
    Fit, FitSummary, Model, Operator, Plane, Recording, Sign, Solver, WeightPrior, evaluate,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const LEVELS: usize = 6;
const COUNT: usize = 21;

/// Models whose weights vary together in a few ways, with an error of 0.1.
fn fleet(rng: &mut ChaCha8Rng, operator: Operator, sign: Sign, count: usize) -> Vec<Model> {
    let ways: Vec<Vec<f64>> = (0..3)
        .map(|_| (0..COUNT).map(|_| rng.random_range(0.0..1.0)).collect())
        .collect();
    (0..count)
        .map(|_| {
            let shares: Vec<f64> = ways.iter().map(|_| rng.random_range(0.0..2.0)).collect();
            let weight = |n: usize| {
                let sum: f64 = ways.iter().zip(&shares).map(|(way, s)| s * way[n]).sum();
                sum + rng.random_range(0.0..0.01)
            };
            let weights: Vec<f64> = (0..COUNT).map(weight).collect();
            let offset = rng.random_range(-1.0..1.0);
            let plane = Plane::new(0.0, 10.0, LEVELS).unwrap();
            let mut model = Model::new(operator, plane, weights, offset, sign).unwrap();
            model.fit = Some(FitSummary {
                rmse: 0.1,
                ..FitSummary::default()
            });
            model
        })
        .collect()
}

fn walk(rng: &mut ChaCha8Rng, samples: usize) -> Vec<f64> {
    let mut input = vec![0.0];
    while input.len() < samples {
        let (from, to) = (input[input.len() - 1], rng.random_range(-1.0..11.0));
        input.extend((1..=8).map(|n| from + (to - from) * f64::from(n) / 8.0));
    }
    input.truncate(samples);
    input
}

fn rms(model: &Model, recording: &Recording) -> f64 {
    evaluate(model, recording).unwrap().forward.rmse
}

/// From a few samples to all of a recording: the fit is better than the mean model, and a long
/// recording is fitted as without a prior.
#[test]
fn a_prior_helps_and_does_not_stand_in_the_way() {
    for seed in 0..60 {
        let rng = &mut ChaCha8Rng::seed_from_u64(seed);
        let operator = [Operator::Mkp, Operator::Kp, Operator::Relay][rng.random_range(0..3)];
        let sign = [Sign::Positive, Sign::Negative][rng.random_range(0..2)];
        let solver = [Solver::Nnls, Solver::Ols][rng.random_range(0..2)];
        let mut models = fleet(rng, operator, sign, 41);
        let truth = models.pop().unwrap();
        let input = walk(rng, 3000);
        let mut output = truth.simulate(&input).unwrap();
        let noise = |y: &mut f64| *y += rng.random_range(-0.17..0.17);
        output.iter_mut().for_each(noise);
        let whole = Recording::new(input, output).unwrap();
        let prior = WeightPrior::from_models(&models).unwrap();
        let fit = Fit::new()
            .levels(LEVELS)
            .range(0.0, 10.0)
            .bootstrap(0)
            .robust(false);
        let fit = fit.solver(solver).sign(sign).operator(operator);
        let under = fit.clone().prior(prior);
        let known = rng.random_range(9..200);
        let part = whole.only(|n| n < known).unwrap();
        let short = under.run(&part).unwrap();
        assert_eq!((short.operator(), short.sign()), (operator, sign));
        if solver == Solver::Nnls {
            assert!(short.weights().iter().all(|weight| *weight >= 0.0));
        }
        let others = models.iter().map(|other| rms(other, &whole)).sum::<f64>() / 40.0;
        let found = rms(&short, &whole);
        assert!(
            found < others,
            "{seed}: {found}, {others} of another actuator, {known} known"
        );
        // 3000 samples against a prior that counts as about one sample for each weight.
        let (long, alone) = (under.run(&whole).unwrap(), fit.run(&whole).unwrap());
        assert!(rms(&long, &whole) < 1.02 * rms(&alone, &whole), "{seed}");
    }
}

/// Over all weights and the offset, nothing near the fit is more probable.
#[test]
fn the_fit_is_the_minimum_of_what_it_says() {
    for seed in 0..20 {
        let rng = &mut ChaCha8Rng::seed_from_u64(seed);
        // With independent weights the shrunk covariance is known up to rounding: it is diagonal.
        let count = 10_usize;
        let mut models = fleet(rng, Operator::Mkp, Sign::Positive, count);
        for (n, model) in models.iter_mut().enumerate() {
            let mut weights = vec![1.0; COUNT];
            weights[n] = 2.0;
            let fit = model.fit.clone();
            *model =
                Model::new(Operator::Mkp, *model.plane(), weights, 0.0, Sign::Positive).unwrap();
            model.fit = fit;
        }
        let prior = WeightPrior::from_models(&models).unwrap();
        let input = walk(rng, 30);
        let output: Vec<f64> = input.iter().map(|_| rng.random_range(0.0..20.0)).collect();
        let recording = Recording::new(input, output).unwrap();
        let model = Fit::new()
            .robust(false)
            .prior(prior)
            .run(&recording)
            .unwrap();
        let (mean, variance) = (1.1, 0.1);
        let least = (0.01 * (10.0 * mean + 11.0) / 21.0_f64).powi(2);
        let objective = |weights: &[f64], offset: f64| {
            let plane = *model.plane();
            let other = Model::new(
                Operator::Mkp,
                plane,
                weights.to_vec(),
                offset,
                Sign::Positive,
            )
            .unwrap();
            let errors = other.simulate(&recording.input).unwrap();
            let errors = errors.iter().zip(&recording.output);
            let misfit: f64 = errors.map(|(h, y)| (h - y).powi(2)).sum();
            let pulls = weights.iter().enumerate().map(|(n, w)| match n < count {
                true => (w - mean).powi(2) / (variance + least),
                false => (w - 1.0).powi(2) / least,
            });
            misfit / 0.01 + pulls.sum::<f64>() + offset * offset / least
        };
        let best = objective(model.weights(), model.offset());
        for _ in 0..200 {
            let size = 10.0_f64.powf(rng.random_range(-4.0..0.0));
            let mut weights = model.weights().to_vec();
            let n = rng.random_range(0..COUNT);
            weights[n] = (weights[n] + size * rng.random_range(-1.0..1.0)).max(0.0);
            let offset = model.offset() + 0.1 * size * rng.random_range(-1.0..1.0);
            // Rounding of the sums.
            assert!(objective(&weights, offset) >= best * (1.0 - 1e-9), "{seed}");
        }
    }
}

#[test]
fn what_makes_no_prior_is_refused() {
    let rng = &mut ChaCha8Rng::seed_from_u64(1);
    let models = fleet(rng, Operator::Mkp, Sign::Positive, 12);
    let refused = |models: &[Model]| WeightPrior::from_models(models).unwrap_err().to_string();
    assert!(refused(&[]).contains("0 models"));
    assert!(refused(&models[..9]).contains("9 models"));
    let mut other = models.clone();
    let plane = Plane::new(0.0, 11.0, LEVELS).unwrap();
    other[4] = Model::new(Operator::Mkp, plane, vec![1.0; COUNT], 0.0, Sign::Positive).unwrap();
    assert!(refused(&other).contains("model 5"));
    let mut other = models.clone();
    other[3].fit = None;
    assert!(refused(&other).contains("fitted"));
    let same = vec![models[0].clone(); 12];
    // Without any difference the prior is narrow, and still a prior.
    let input = walk(rng, 40);
    let recording = Recording::new(input.clone(), models[0].simulate(&input).unwrap()).unwrap();
    let model = Fit::new()
        .prior(WeightPrior::from_models(&same).unwrap())
        .run(&recording)
        .unwrap();
    for (a, b) in model.weights().iter().zip(models[0].weights()) {
        // The recording is that of this model: nothing pulls away but rounding.
        assert!((a - b).abs() < 1e-6, "{a} {b}");
    }
    let loaded = Recording {
        load: Some(vec![1.0; recording.len()]),
        ..recording
    };
    let fit = Fit::new()
        .robust(false)
        .prior(WeightPrior::from_models(&models).unwrap());
    assert!(fit.run(&loaded).unwrap_err().to_string().contains("load"));
}

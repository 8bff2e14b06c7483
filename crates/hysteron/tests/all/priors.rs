//! What a fit assumes before any data, and what it does with readings that do not belong.

use hysteron::{Fit, FitOptions, Model, Operator, Plane, Recording, Sign, Smooth, operators};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A material whose density depends mostly on the width of an operator.
fn material() -> Model {
    let plane = Plane::new(0.05, 1.0, 40).unwrap();
    let weights = operators(40).map(|(i, j)| {
        let (width, place) = ((j - i) as f64 / 40.0, (i + j) as f64 / 80.0);
        (-width / 0.2).exp() * (1.0 + 0.5 * place) / 100.0
    });
    Model::new(Operator::Mkp, plane, weights.collect(), 2.0, Sign::Positive).unwrap()
}

/// Reversals at random places, each branch with `samples`; the first goes to the top.
fn recording(branches: usize, samples: usize, seed: u64) -> Recording {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut input = vec![0.0];
    for branch in 0..branches {
        let from = *input.last().unwrap();
        let to = match branch {
            0 => 1.0,
            1 => 0.0,
            _ if branch % 2 == 0 => rng.random_range(from..1.0),
            _ => rng.random_range(0.0..from),
        };
        let step = (to - from) / samples as f64;
        input.extend((1..=samples).map(|n| from + step * n as f64));
    }
    let output = material().simulate(&input).unwrap();
    Recording::new(input, output).unwrap()
}

fn rmse(model: &Model, on: &Recording) -> f64 {
    let modelled = model.simulate(&on.input).unwrap();
    let squares = modelled
        .iter()
        .zip(&on.output)
        .map(|(a, b)| (a - b).powi(2));
    (squares.sum::<f64>() / on.len() as f64).sqrt()
}

fn span(recording: &Recording) -> f64 {
    let (_, (low, high)) = recording.ranges();
    high - low
}

/// In the limit of a large strength along, weights depend on the width alone.
#[test]
fn the_limit_along_the_diagonal_is_a_prandtl_ishlinskii_model() {
    let recording = recording(12, 20, 1);
    for levels in [5, 12] {
        let options = FitOptions {
            levels,
            smooth: 1e6.into(),
            ridge: 0.0,
            ..FitOptions::plain()
        };
        let model = Fit::from(options).run(&recording).unwrap();
        let weight = |i: usize, j: usize| model.weights()[hysteron::operator_index(i, j)];
        let largest = model.weights().iter().copied().fold(0.0, f64::max);
        for (i, j) in operators(levels).filter(|(i, _)| *i > 1) {
            let first = weight(1, j - i + 1);
            // The strength is 1e6 times the squared error, of which the solution is known to 1e-12.
            assert!(
                (weight(i, j) - first).abs() < 1e-4 * largest,
                "{levels}: {i}, {j}"
            );
        }
        // The truth does depend on the place, but little.
        assert!(rmse(&model, &recording) < 0.1 * span(&recording));
    }
}

#[test]
fn strengths_do_not_depend_on_the_unit_of_the_output() {
    let recording = recording(8, 15, 2);
    let other = Recording::new(
        recording.input.clone(),
        recording.output.iter().map(|y| 1e4 * y - 7.0).collect(),
    )
    .unwrap();
    let options = FitOptions {
        levels: 12,
        smooth: (1e-6, 1e-8).into(),
        ..FitOptions::plain()
    };
    let fit = Fit::from(options);
    let (one, two) = (fit.run(&recording).unwrap(), fit.run(&other).unwrap());
    for (a, b) in one.weights().iter().zip(two.weights()) {
        // The solver's accuracy on weights of 0.01.
        assert!((a - b / 1e4).abs() < 1e-7, "{a} {b}");
    }
}

/// However few the data, and whatever is asked for, the weights do not run away.
#[test]
fn weights_add_up_to_hardly_more_than_the_measured_range() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    for round in 0..60 {
        let mut few = recording(rng.random_range(1..5), rng.random_range(3..12), round);
        // The recording may begin anywhere, and have noise.
        let skip = rng.random_range(0..few.len() / 2);
        few = Recording::new(few.input[skip..].to_vec(), few.output[skip..].to_vec()).unwrap();
        let noise = span(&few) * [0.0, 0.01, 0.1][round as usize % 3];
        for y in &mut few.output {
            *y += noise * rng.random_range(-1.0..1.0);
        }
        let mut fit = Fit::new().bootstrap(0);
        if round % 2 == 1 {
            fit = fit.levels(rng.random_range(2..40));
        }
        if round % 4 > 1 {
            fit = fit.smooth(Smooth::NONE);
        }
        let model = fit.run(&few).unwrap();
        let sum: f64 = model.weights().iter().map(|mu| mu.abs()).sum();
        assert!(
            sum <= 1.5 * span(&few),
            "round {round}: {}",
            sum / span(&few)
        );
    }
}

/// One bad reading anywhere is named, and the model is as good as without it.
#[test]
fn one_bad_reading_is_named_and_has_no_weight() {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let mut clean = recording(20, 25, 4);
    let noise = 0.002 * span(&clean);
    for y in &mut clean.output {
        *y += noise * rng.random_range(-1.0..1.0);
    }
    let test = recording(15, 25, 5);
    let fit = Fit::new().levels(15).smooth(1e-8).bootstrap(0);
    let good = fit.run(&clean).unwrap();
    assert!(good.fit.as_ref().unwrap().outliers.is_empty());
    let last = clean.len() - 1;
    let places = [0, 1, last - 1, last];
    let mut sum = 0.0;
    for round in 0..24 {
        let place = *places
            .get(round)
            .unwrap_or(&rng.random_range(0..clean.len()));
        let size = span(&clean) * [0.1, -0.3, 2.0, 4095.0][round % 4];
        let mut bad = clean.clone();
        bad.output[place] += size;
        let found = fit.run(&bad).unwrap();
        let named = &found.fit.as_ref().unwrap().outliers;
        assert_eq!(named.len(), 1, "round {round}: {named:?}");
        assert_eq!(named[0].sample, place, "round {round}");
        // It is put back to where the model and its neighbours say: the misfit of a smooth model is
        // part of that.
        let off = (named[0].by - size).abs() / span(&clean);
        assert!(off < 0.02, "round {round}, sample {place}: {off}");
        // What the reading itself would have told is lost: near a turning point that is most.
        let worse = rmse(&found, &test) / rmse(&good, &test);
        assert!(worse < 1.15, "round {round}: {worse}");
        sum += worse;
    }
    assert!(sum / 24.0 < 1.02, "on average {}", sum / 24.0);
}

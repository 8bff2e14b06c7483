//! Readings that agree with their neighbours are data, however steep the branch; a reading that
//! stands alone is an outlier, and is named as in the file.

use hysteron::{Fit, HoldOut, Model, Operator, Plane, Recording, Sign, fit_holding_out, operators};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A material whose operators switch close together: each branch has one steep part.
fn steep(rng: &mut ChaCha8Rng) -> Model {
    let (up, down) = (rng.random_range(0.5..0.9), rng.random_range(0.1..0.4));
    let width = rng.random_range(0.01..0.1);
    let bell = |at: usize, middle: f64| (-((at as f64 / 30.0 - middle) / width).powi(2)).exp();
    let weights = operators(30).map(|(i, j)| bell(j, up) * bell(i, down) + 1e-3);
    let weights: Vec<f64> = weights.collect();
    let total: f64 = weights.iter().sum();
    let weights = weights.iter().map(|mu| 10.0 * mu / total).collect();
    let plane = Plane::new(1.0 / 30.0, 1.0, 30).unwrap();
    Model::new(Operator::Mkp, plane, weights, 1.0, Sign::Positive).unwrap()
}

/// Branches on a grid of inputs, so that points are measured again, some of them at once.
fn recorded(rng: &mut ChaCha8Rng, noise: f64) -> Recording {
    let grid = rng.random_range(15..60);
    let mut place = 0_i32;
    let mut input = vec![0.0];
    for branch in 0..rng.random_range(4..14) {
        let to = match branch {
            0 => grid,
            1 => 0,
            _ if branch % 2 == 0 => rng.random_range(place..=grid),
            _ => rng.random_range(0..=place),
        };
        while place != to {
            place += (to - place).signum();
            let times = if rng.random_bool(0.05) { 3 } else { 1 };
            input.extend(std::iter::repeat_n(
                f64::from(place) / f64::from(grid),
                times,
            ));
        }
    }
    let mut output = steep(rng).simulate(&input).unwrap();
    output
        .iter_mut()
        .for_each(|y| *y += 10.0 * noise * rng.random_range(-1.0..1.0));
    Recording::new(input, output).unwrap()
}

fn fit(rng: &mut ChaCha8Rng) -> Fit<'static> {
    Fit::new()
        .levels(rng.random_range(8..20))
        .smooth(1e-6)
        .bootstrap(0)
}

/// Whether a reading was measured again at the same input in the same direction, or lies between
/// those before and after it while the input goes one way.
fn has_company(recording: &Recording, n: usize) -> bool {
    let Recording { input, output, .. } = recording;
    if n == 0 || n + 1 == input.len() {
        return false;
    }
    let one_way = (input[n] - input[n - 1]) * (input[n + 1] - input[n]) >= 0.0;
    let (low, high) = (
        output[n - 1].min(output[n + 1]),
        output[n - 1].max(output[n + 1]),
    );
    one_way && (low..=high).contains(&output[n])
}

#[test]
fn readings_that_agree_are_data() {
    for seed in 0..120 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let noise = [0.0, 1e-3, 1e-2][seed as usize % 3];
        let recording = recorded(&mut rng, noise);
        let model = fit(&mut rng).run(&recording).unwrap();
        for outlier in &model.fit.unwrap().outliers {
            let n = outlier.sample;
            assert!(!has_company(&recording, n), "seed {seed}: {outlier:?}");
        }
    }
}

/// The outliers that a fit named.
fn named(model: Model) -> Vec<usize> {
    let fit = model.fit.unwrap();
    fit.outliers.iter().map(|outlier| outlier.sample).collect()
}

/// One to six samples, each at least three from the next: of nine in a row, three are wrong at most.
fn apart(rng: &mut ChaCha8Rng, len: usize) -> Vec<usize> {
    let mut found: Vec<usize> = Vec::new();
    for _ in 0..rng.random_range(1..=6) {
        let n = rng.random_range(2..len - 2);
        if found.iter().all(|other| other.abs_diff(n) >= 3) {
            found.push(n);
        }
    }
    found
}

/// Gross errors beyond the range, several in one recording, on flat and on steep branches and at
/// turning points, are named by their rows in the file, with branches held out too.
#[test]
fn readings_that_stand_alone_are_outliers() {
    for seed in 0..60 {
        let mut rng = ChaCha8Rng::seed_from_u64(1000 + seed);
        let mut recording = recorded(&mut rng, 1e-3);
        if recording.len() < 100 {
            continue;
        }
        let wrong = apart(&mut rng, recording.len());
        for n in &wrong {
            let off = rng.random_range(10.0..100.0);
            recording.output[*n] += if rng.random_bool(0.5) { off } else { -off };
        }
        let fit = fit(&mut rng);
        let found = named(fit.run(&recording).unwrap());
        assert!(
            wrong.iter().all(|n| found.contains(n)),
            "seed {seed}: {wrong:?} {found:?}"
        );
        let what = HoldOut::Branches(0.3);
        let Ok(split) = recording.split(&what) else {
            continue;
        };
        let (model, _) = fit_holding_out(&fit, &recording, &what).unwrap();
        let found = named(model);
        assert!(found.iter().all(|n| !split.held_out[*n]), "seed {seed}");
        let mut seen = wrong.iter().filter(|n| !split.held_out[**n]);
        assert!(
            seen.all(|n| found.contains(n)),
            "seed {seed}: {wrong:?} {found:?}"
        );
    }
}

/// Dropouts to one value at one input agree with each other. They are outliers all the same, as long
/// as they are the fewer visits to that input.
#[test]
fn dropouts_to_one_value_at_one_input_are_outliers() {
    let mut tried = 0;
    for seed in 0..120 {
        let mut rng = ChaCha8Rng::seed_from_u64(2000 + seed);
        let mut recording = recorded(&mut rng, 1e-3);
        let x = &recording.input;
        let at = x[rng.random_range(0..x.len())];
        // The visits to this input in one direction, each of one reading or of three.
        let rising = |rows: &Vec<usize>| rows[0] > 0 && x[rows[0] - 1] < at;
        let inside = |rows: &Vec<usize>| rows[0] > 1 && rows[rows.len() - 1] + 2 < x.len();
        let same: Vec<usize> = (0..x.len()).filter(|n| x[*n] == at).collect();
        let visits = same.chunk_by(|a, b| a + 1 == *b).map(<[usize]>::to_vec);
        let visits: Vec<Vec<usize>> = visits.filter(inside).filter(rising).collect();
        let fewer = visits.len().saturating_sub(1) / 2;
        if fewer == 0 {
            continue;
        }
        tried += 1;
        let wrong: Vec<usize> = visits[..rng.random_range(1..=fewer)].concat();
        let value = rng.random_range(-100.0..-20.0);
        wrong.iter().for_each(|n| recording.output[*n] = value);
        let found = named(fit(&mut rng).run(&recording).unwrap());
        let missed: Vec<&usize> = wrong.iter().filter(|n| !found.contains(n)).collect();
        assert!(missed.is_empty(), "seed {seed}: {wrong:?} {found:?}");
    }
    assert!(tried > 20, "{tried}");
}

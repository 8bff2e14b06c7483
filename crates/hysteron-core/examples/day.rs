//! A day at 100 Hz: `cargo run --release -p hysteron-core --example day`.
//!
//! Each method learns a known plant for 24 hours, 8.64 million samples. The input makes strokes of
//! seconds to minutes, with rests in between. Input and output have noise.
//!
//! The table shows whether anything drifts. It has the errors of the output and of the weights in
//! the first and in the last hour, the smallest weight of all, and the error of the inverse, tested
//! every ten seconds. The memory is that given at the start, because the core does not allocate.

use hysteron_core::{
    Adaptation, Error, Estimator, Method, Model, Operator, Outcome, Plane, Target, Turn,
    estimator_len, operator_count, table_len, turn_capacity,
};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

const HOUR: usize = 3600 * 100;
const HOURS: usize = 24;
/// Noise of the output as a fraction of its range, as of a cheap sensor.
const NOISE: f64 = 0.005;

/// An input, in levels, that moves to random positions in 2 to 60 seconds and then rests for up to
/// a minute.
struct Input {
    rng: StdRng,
    levels: f64,
    from: f64,
    to: f64,
    /// Samples of the stroke, and of the rest after it.
    stroke: usize,
    rest: usize,
    at: usize,
}

impl Input {
    fn next(&mut self) -> f64 {
        if self.at >= self.stroke + self.rest {
            (self.from, self.to) = (self.to, self.rng.random_range(0.0..self.levels));
            self.stroke = self.rng.random_range(200..6000);
            self.rest = self.rng.random_range(0..6000);
            self.at = 0;
        }
        self.at += 1;
        let share = self.at.min(self.stroke) as f64 / self.stroke as f64;
        self.from + share * (self.to - self.from) + self.rng.random_range(-0.02..0.02)
    }
}

/// The results of an hour.
#[derive(Default, Clone, Copy)]
struct Hour {
    squares: f64,
    learned: usize,
    rolled_back: usize,
    /// Root mean square difference of the weights from the plant's, at its end.
    weights: f64,
}

fn day(name: &str, method: Method<f64>, levels: usize, learns: bool) -> Result<(), Error> {
    let mut rng = StdRng::seed_from_u64(1);
    let plane = Plane::new(20.0, 80.0, levels)?;
    let n = operator_count(levels);
    let known: Vec<f64> = (0..n).map(|_| rng.random()).collect();
    let plant = Model::new(plane, Operator::Mkp, &known, vec![0.0; table_len(levels)])?;
    let mut there = plant.state(vec![Turn::default(); turn_capacity(levels)])?;
    let range = plant.output_range().1;

    let offline = vec![0.5; n];
    let tables = 2 * table_len(levels);
    let mut model = Model::new(plane, Operator::Mkp, &offline, vec![0.0; tables])?;
    let mut state = model.state(vec![Turn::default(); turn_capacity(levels)])?;
    let memory = vec![0.0; estimator_len(levels, method)];
    let bytes = size_of_val(&memory[..]) + size_of::<f64>() * (tables + 2 * turn_capacity(levels));
    let options = Adaptation {
        method,
        ..Adaptation::default()
    };
    let mut estimator = Estimator::new(options, &mut model, &offline, 0.0, memory)?;
    estimator.freeze(!learns);
    let mut input = Input {
        rng: StdRng::seed_from_u64(2),
        levels: levels as f64,
        from: 0.0,
        to: 0.0,
        stroke: 0,
        rest: 0,
        at: 0,
    };
    let (mut smallest, mut inverse, mut offset) = (f64::INFINITY, 0.0_f64, 0.0_f64);
    let mut hours = [Hour::default(); HOURS];
    for hour in &mut hours {
        for sample in 0..HOUR {
            let position = input.next();
            let read = position + rng.random_range(-0.02..0.02);
            let output = plant.step(&mut there, plane.denormalise(position))?.output;
            let measured = output + NOISE * range * rng.random_range(-1.0..1.0);
            let temperature = plane.denormalise(read);
            let learning = estimator.step(&mut model, &mut state, temperature, measured)?;
            hour.squares += (learning.output - output).powi(2);
            hour.learned += usize::from(learning.outcome == Outcome::Learned);
            hour.rolled_back += usize::from(learning.outcome == Outcome::RolledBack);
            if sample % 1000 == 0 {
                let weights = estimator.parameters();
                smallest = weights.iter().fold(smallest, |least, &w| least.min(w));
                offset = offset.max(estimator.offset().abs());
                let (low, high) = model.output_range();
                let target = low + (high - low) * rng.random::<f64>();
                let mut apart = state.clone();
                let solution = model.inverse()?.solve(&apart, Target::new(target))?;
                let reached = model.step(&mut apart, solution.input)?.output;
                inverse = inverse.max((reached - target).abs() / (high - low));
            }
        }
        let differences = estimator.parameters().iter().zip(&known);
        let squares: f64 = differences.map(|(a, b)| (a - b).powi(2)).sum();
        hour.weights = (squares / n as f64).sqrt();
    }
    let error = |hour: &Hour| 100.0 * (hour.squares / HOUR as f64).sqrt() / range;
    let [first, middle, last] = [&hours[0], &hours[HOURS / 2 - 1], &hours[HOURS - 1]];
    let learned: usize = hours.iter().map(|hour| hour.learned).sum();
    let rolled_back: usize = hours.iter().map(|hour| hour.rolled_back).sum();
    println!(
        "| {name} | {levels} | {:.2} / {:.2} / {:.2} | {:.3} / {:.3} / {:.3} | {smallest:.3} | {:.2} | {inverse:.0e} | {learned} | {rolled_back} | {bytes} |",
        error(first),
        error(middle),
        error(last),
        first.weights,
        middle.weights,
        last.weights,
        100.0 * offset / range,
    );
    Ok(())
}

fn main() -> Result<(), Error> {
    println!(
        "| method | K | error, hour 1 / 12 / 24, % of range | error of weights (mean 0.5; 0.29 off-line) | smallest weight | largest offset, % | worst return of the inverse | learned from | rolled back | bytes |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    let increments = Method::Increments {
        gain: 0.1,
        span: 1.0,
    };
    day("none: off-line", increments, 20, false)?;
    day("increments", increments, 20, true)?;
    let least_squares = |forgetting| Method::LeastSquares {
        forgetting,
        noise: 0.2,
        spread: 0.3,
        correlation: 0.0,
    };
    day("none: off-line", least_squares(1.0), 10, false)?;
    day("least squares, λ = 0.999", least_squares(0.999), 10, true)?;
    day("least squares, λ = 1", least_squares(1.0), 10, true)
}

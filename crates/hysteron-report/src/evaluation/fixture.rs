//! A shape-memory actuator as the tests see it: K = 20 over 20…80 °C, a major loop, then minor
//! loops.
#![allow(clippy::unwrap_used)]

use hysteron::{
    Candidates, Evaluation, Fit, FitOptions, Model, Operator, Plane, Progress, Quantity, Recording,
    Sign, Verdict, cross_validate, evaluate, operators,
};

/// The parts of a report.
pub(crate) struct Fixture {
    pub(crate) model: Model,
    pub(crate) recording: Recording,
    pub(crate) evaluation: Evaluation,
    pub(crate) verdict: Verdict,
}

/// A recording of `samples` samples, and a model that is slightly wrong about it.
pub(crate) fn sma(samples: usize) -> Fixture {
    let plant = model(20, |alpha, beta| {
        1.04 * bump(alpha, 37.3, 6.4) * bump(beta, 57.4, 6.6)
    });
    let model = self::model(20, density);
    let time: Vec<f64> = (0..samples)
        .map(|k| k as f64 * 1000.0 / samples.max(2) as f64)
        .collect();
    let input: Vec<f64> = time.iter().map(|&t| temperature(t)).collect();
    let noise = |k: usize| 0.03 * (k as f64 * 0.9).sin() * (k as f64 * 0.37).cos();
    let clean = plant.simulate(&input).unwrap();
    let output = clean
        .iter()
        .enumerate()
        .map(|(k, y)| y + noise(k))
        .collect();
    let mut recording = Recording::new(input, output).unwrap();
    recording.time = Some(time);
    recording.input_quantity = model.input.clone();
    recording.output_quantity = model.output.clone();
    let evaluation = evaluate(&model, &recording).unwrap();
    Fixture {
        verdict: Verdict::of_evaluation(&model, &recording, &evaluation).unwrap(),
        evaluation,
        model,
        recording,
    }
}

impl Fixture {
    /// Gives the model a plane of `levels` levels.
    pub(crate) fn refine(&mut self, levels: usize) {
        self.model = model(levels, density);
    }

    /// Gives a model that says how it was chosen and how certain it is: identified from the
    /// recording.
    pub(crate) fn identify(&mut self) {
        let recordings = std::slice::from_ref(&self.recording);
        let candidates = Candidates::new(Some(8), None);
        let options = FitOptions::plain();
        let (mut options, validation) =
            cross_validate(recordings, &options, &candidates, Progress::NONE).unwrap();
        options.bootstrap = 20;
        self.model = Fit::from(&options).run(recordings).unwrap();
        if let Some(fit) = &mut self.model.fit {
            fit.validation = Some(validation);
        }
        self.evaluate();
    }

    /// Evaluates again, after a change.
    pub(crate) fn evaluate(&mut self) {
        self.evaluation = evaluate(&self.model, &self.recording).unwrap();
        self.verdict =
            Verdict::of_evaluation(&self.model, &self.recording, &self.evaluation).unwrap();
    }
}

fn density(alpha: f64, beta: f64) -> f64 {
    bump(alpha, 38.0, 6.0) * bump(beta, 57.0, 7.0)
}

fn bump(x: f64, middle: f64, width: f64) -> f64 {
    (-((x - middle) / width).powi(2)).exp()
}

fn model(levels: usize, density: impl Fn(f64, f64) -> f64) -> Model {
    let plane = Plane::new(20.0, 80.0, levels).unwrap();
    let mut weights: Vec<f64> = operators(levels)
        .map(|(i, j)| density(plane.level(i), plane.level(j)))
        // Solvers with weights ≥ 0 leave many at zero, some among large ones.
        .enumerate()
        .map(|(k, mu)| {
            if mu < 0.01 || k % 7 == 0 {
                0.0
            } else {
                mu * (1.0 + 0.5 * (k as f64 * 2.3).sin())
            }
        })
        .collect();
    let sum: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|mu| *mu *= 14.0 / sum);
    let mut model = Model::new(Operator::Mkp, plane, weights, 0.0, Sign::Positive).unwrap();
    model.input = Quantity::with_unit("temperature", "degC");
    model.output = Quantity::with_unit("displacement", "mm");
    model
}

/// Heating and cooling, each slowing down towards its end.
fn temperature(t: f64) -> f64 {
    const TURNS: [f64; 13] = [
        21.0, 80.0, 22.0, 79.0, 34.0, 66.0, 38.0, 79.0, 41.0, 62.0, 30.0, 74.0, 22.0,
    ];
    let branch = ((t / 1000.0 * 12.0) as usize).min(11);
    let share = (t / 1000.0 * 12.0 - branch as f64).min(1.0);
    let slowing = (1.0 - (-2.2 * share).exp()) / (1.0 - (-2.2f64).exp());
    TURNS[branch] + (TURNS[branch + 1] - TURNS[branch]) * slowing
}

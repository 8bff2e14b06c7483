//! A target that the C reports as reached is reached within the rounding that it states, also by the
//! model itself; and a model whose digits do not keep a thousandth of its range is refused.

use crate::common::reference::Number;
use crate::common::staged::{Case, Reference, case};
use crate::common::walks;
use hysteron::{FirstOrder, Model, Operator, Plane, Sample, Sign, State, Target};
use hysteron_export::{CExport, COptions, CReal, CSampling, c_texts};
use rand::RngExt;
use rand::rngs::StdRng;

fn export(case: &Case, real: CReal) -> hysteron::Result<(CExport, Vec<String>)> {
    let options = COptions {
        real,
        name: Some("m"),
        source: "m.json".as_ref(),
        adaptation: false,
    };
    c_texts(&case.model, &options, &case.sampling)
}

/// The model beside its C: what both output, and where the C has a target reached.
struct Beside<'m, T> {
    model: &'m Model,
    state: State,
    c: Reference<T>,
    dt: Option<f64>,
}

impl<'m, T: Number> Beside<'m, T> {
    fn new(case: &'m Case) -> Self {
        Self {
            model: &case.model,
            state: case.model.start(),
            c: Reference::new(case),
            dt: case.sampling.dt,
        }
    }

    /// Asks for a target: by how much the model misses it where the C says that it is reached.
    fn miss(&mut self, target: f64, load: f64) -> Option<f64> {
        let target = T::of(target);
        let (drive, status) = self.c.invert(Target::new(target), T::of(load)).unwrap();
        assert!(drive.is_finite());
        let sample = Sample {
            input: drive.wide(),
            dt: self.dt,
            load: self.model.load.as_ref().map(|_| load),
        };
        let output = self.model.step(&mut self.state, sample).unwrap().output;
        assert!(output.is_finite());
        (status == 0).then(|| (output - target.wide()).abs())
    }
}

/// Targets that creep, jump and rest, over a range and a little beyond it.
fn targets(rng: &mut StdRng, (low, high): (f64, f64), count: usize) -> Vec<f64> {
    let mut target = low;
    let mut targets = Vec::new();
    while targets.len() < count {
        let to = low + (high - low) * rng.random_range(-0.1..1.1);
        let steps = [1, 3, 30, 200][rng.random_range(0..4)];
        let from = target;
        targets.extend((1..=steps).map(|n| from + (to - from) * f64::from(n) / f64::from(steps)));
        target = to;
    }
    targets
}

/// How far reached targets are missed, in parts of what the C states, and how many were reached.
fn worst<T: Number>(case: &Case, stated: f64, seed: u64) -> (f64, usize) {
    let mut rng = walks::rng(seed);
    let ends = case.model.output_range();
    let ends = (ends.0.min(ends.1), ends.0.max(ends.1));
    let mut beside = Beside::<T>::new(case);
    let (mut worst, mut reached) = (0.0_f64, 0);
    let mut load = case.loads.0;
    for target in targets(&mut rng, ends, 4000) {
        if rng.random_bool(0.01) {
            load = rng.random_range(case.loads.0..=case.loads.1);
        }
        if let Some(miss) = beside.miss(target, f64::from(load as f32)) {
            worst = worst.max(miss / stated);
            reached += 1;
        }
    }
    (worst, reached)
}

#[test]
fn reached_targets_are_reached_by_the_model_within_the_stated_rounding() {
    let (mut kept, mut refused, mut reached) = ([0; 2], [0; 2], 0);
    let mut farthest = 0.0_f64;
    for seed in 0..400 {
        let mut rng = walks::rng(seed);
        let operator = [Operator::Mkp, Operator::Kp][seed as usize % 2];
        let levels = [2, 3, 5, 8, 13, 20, 33][seed as usize % 7];
        let mut case = case(&mut rng, operator, levels, seed % 3 == 0);
        // From slow loops to a drive of 10 kHz, and bodies that take 10⁻¹ to 10⁶ of its samples.
        if seed % 2 == 0 {
            case.fast(&mut rng);
        }
        let range = case.widest();
        if range == 0.0 {
            continue; // there is one output
        }
        for (n, real) in [CReal::Float, CReal::Double].into_iter().enumerate() {
            let made = match export(&case, real) {
                Ok((made, _)) if made.inverse => made,
                Ok(_) => continue,
                Err(error) => {
                    let text = error.to_string();
                    assert!(text.contains("precision"), "{text}");
                    refused[n] += 1;
                    continue;
                }
            };
            kept[n] += 1;
            assert!(made.rounding <= 1.001e-3 * range, "seed {seed}");
            let (miss, count) = match real {
                CReal::Float => worst::<f32>(&case, made.rounding, seed),
                CReal::Double => worst::<f64>(&case, made.rounding, seed),
            };
            reached += count;
            farthest = farthest.max(miss);
            assert!(
                miss <= 1.0,
                "seed {seed}, {}: {miss} of {}",
                real.name(),
                made.rounding
            );
        }
    }
    println!(
        "kept {kept:?}, refused {refused:?}; {reached} reached, up to {farthest:.2} of what is stated"
    );
    assert!(
        kept[0] > 50 && refused[0] > 20 && refused[1] == 0,
        "{kept:?} {refused:?}"
    );
    assert!(reached > 100_000, "{reached}");
}

#[test]
fn a_body_that_float_does_not_follow_is_refused_and_double_is_advised() {
    let plane = Plane::new(20.0, 80.0, 20).unwrap();
    let mut model = Model::new(Operator::Mkp, plane, vec![1.0; 210], 0.0, Sign::Positive).unwrap();
    let case = |model: &Model, tau, dt| {
        let mut model = model.clone();
        model.thermal = Some(FirstOrder {
            tau_heating: tau,
            tau_cooling: tau,
            ..FirstOrder::default()
        });
        Case::of(
            model,
            CSampling {
                dt: Some(dt),
                drive: None,
                ..CSampling::default()
            },
        )
    };
    // A usual wire at 100 Hz; one at 10 kHz, whose temperature moves by less than a digit a sample.
    let (made, texts) = export(&case(&model, 2.0, 0.01), CReal::Float).unwrap();
    let said = format!("met up to its tolerance and {:.1e}", made.rounding);
    assert!(texts.iter().any(|text| text.contains(&said)), "{said}");
    assert!(made.rounding > 0.0 && made.rounding <= 0.21);
    let fast = case(&model, 20.0, 1e-4);
    let text = export(&fast, CReal::Float).unwrap_err().to_string();
    assert!(
        text.contains("thousandth") && text.contains("single precision"),
        "{text}"
    );
    assert!(export(&fast, CReal::Double).is_ok());
    // A stroke that is small beside its offset.
    model = Model::new(Operator::Mkp, plane, vec![1e-6; 210], 1e3, Sign::Positive).unwrap();
    let far = Case::of(model, CSampling::default());
    assert!(
        export(&far, CReal::Float)
            .unwrap_err()
            .to_string()
            .contains("thousandth")
    );
    assert!(export(&far, CReal::Double).is_ok());
}

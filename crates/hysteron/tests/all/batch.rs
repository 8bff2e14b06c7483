//! Batches: every lane against its model alone, to the last bit, with models of all kinds.

use hysteron::{
    BatchModel, ClippedCount, CoreError, CreepTerm, Error, FirstOrder, Model, Operator, Plane,
    Sign, State, Surroundings,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng as Rng;
use std::sync::Arc;

/// A model file whose weights depend on a load from 50 to 200.
const LOADED: &str = r#"{"format": "hysteron-model", "version": 2, "operator": "mkp",
  "plane": {"min": 30.0, "max": 60.0, "levels": 3},
  "input": {"name": "duty"}, "output": {"name": "lift", "offset": 2.0, "sign": -1},
  "weights": [1.0, 0.5, 1.25, 0.25, 0.5, 1.5],
  "load": {"name": "stress", "min": 50.0, "max": 200.0,
    "parts": [{"offset": 2.0, "weights": [1.0, 0.5, 1.0, 0.25, 0.5, 1.0]},
      {"offset": 2.0, "weights": [1.0, 0.5, 1.5, 0.25, 0.5, 2.0]}]}}"#;

#[derive(Clone, Copy)]
enum Kind {
    Plain,
    Mixed,
}

fn model(rng: &mut Rng, kind: Kind) -> Model {
    let levels = rng.random_range(2..25);
    let min = rng.random_range(-50.0..20.0);
    let plane = Plane::new(min, min + rng.random_range(5.0..90.0), levels).unwrap();
    let weights = (0..plane.operators()).map(|_| rng.random()).collect();
    let operator = [Operator::Mkp, Operator::Kp, Operator::Relay][rng.random_range(0..3)];
    let sign = [Sign::Positive, Sign::Negative][rng.random_range(0..2)];
    let mut model = Model::new(operator, plane, weights, rng.random(), sign).unwrap();
    match kind {
        Kind::Mixed => match rng.random_range(0..5) {
            0 => model.thermal = Some(FirstOrder::default()),
            1 => {
                let term = CreepTerm {
                    coefficient: 0.05,
                    tau: 3.0,
                };
                model = model.with_after(&[term], 0.2).unwrap();
            }
            2 => {
                let corners = (0..=levels).map(|n| min + (n * n) as f64 / 4.0).collect();
                model = model.with_spacing(corners).unwrap();
            }
            3 => model = Model::from_json(LOADED).unwrap(),
            _ => {}
        },
        Kind::Plain => {}
    }
    model
}

/// Models of their own, or one for all.
fn models(rng: &mut Rng, count: usize, kind: Kind) -> Vec<Arc<Model>> {
    match rng.random_bool(0.3) {
        true => std::iter::repeat_n(Arc::new(model(rng, kind)), count).collect(),
        false => (0..count).map(|_| Arc::new(model(rng, kind))).collect(),
    }
}

/// A walk over more than the plane, which sometimes stays.
fn walk(rng: &mut Rng, count: usize) -> Vec<f64> {
    let mut at: f64 = 0.0;
    let next = |_| {
        if rng.random_bool(0.9) {
            at = (at + rng.random_range(-20.0..20.0)).clamp(-120.0, 160.0);
        }
        at
    };
    (0..count).map(next).collect()
}

struct Series {
    inputs: Vec<f64>,
    time: Vec<f64>,
    loads: Option<Vec<f64>>,
}

fn series(rng: &mut Rng, models: &[Arc<Model>], samples: usize) -> Series {
    let inputs = models.iter().flat_map(|_| walk(rng, samples)).collect();
    let mut now = 0.0;
    let time = (0..samples).map(|_| {
        now += rng.random::<f64>();
        now
    });
    let time = time.collect();
    let loaded = models.iter().any(|model| model.load.is_some());
    let total = models.len() * samples;
    let loads = loaded.then(|| (0..total).map(|_| rng.random_range(50.0..200.0)).collect());
    Series {
        inputs,
        time,
        loads,
    }
}

impl Series {
    fn around(&self) -> Surroundings<'_> {
        Surroundings {
            time: Some(&self.time),
            load: self.loads.as_deref(),
            rest: None,
        }
    }
}

/// The states, to compare: a state that has not seen a load has a NaN, which equals nothing.
fn shown<'a>(states: impl IntoIterator<Item = &'a State>) -> Vec<String> {
    states
        .into_iter()
        .map(|state| format!("{state:?}"))
        .collect()
}

fn states(batch: &BatchModel) -> Vec<String> {
    shown(batch.states())
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|y| y.to_bits()).collect()
}

/// Runs a batch twice, so that the second run begins within a history, and each model alone.
fn equals_each_alone(rng: &mut Rng, models: &[Arc<Model>], samples: [usize; 2]) {
    let mut batch: BatchModel = models.iter().cloned().collect();
    let mut alone: Vec<State> = models.iter().map(|model| model.start()).collect();
    assert_eq!(states(&batch), shown(&alone));
    for samples in samples {
        let series = series(rng, models, samples);
        let mut outputs = vec![f64::NAN; series.inputs.len()];
        let found = batch
            .run_in(&series.inputs, series.around(), &mut outputs)
            .unwrap();
        let mut count = ClippedCount::default();
        for (n, model) in models.iter().enumerate() {
            let rows = n * samples..(n + 1) * samples;
            let load = series.loads.as_ref().map(|loads| &loads[rows.clone()]);
            let around = Surroundings {
                load: load.filter(|_| model.load.is_some()),
                ..series.around()
            };
            let mut expected = vec![0.0; samples];
            let input = &series.inputs[rows.clone()];
            let one = model.run_in(&mut alone[n], input, around, &mut expected);
            let one = one.unwrap();
            count.low += one.low;
            count.high += one.high;
            assert_eq!(bits(&outputs[rows]), bits(&expected), "lane {n}");
        }
        assert_eq!(found, count);
        assert_eq!(states(&batch), shown(&alone));
    }
    batch.reset();
    let starts: Vec<State> = models.iter().map(|model| model.start()).collect();
    assert_eq!(states(&batch), shown(&starts));
}

#[test]
fn every_lane_is_its_model_alone_to_the_last_bit() {
    for seed in 0..300 {
        let mut rng = Rng::seed_from_u64(seed);
        let kind = [Kind::Plain, Kind::Mixed][seed as usize % 2];
        let models = models(&mut rng, seed as usize % 21, kind);
        let samples = [rng.random_range(0..200), rng.random_range(0..3)];
        equals_each_alone(&mut rng, &models, samples);
    }
}

/// Enough samples that every thread gets some.
#[test]
fn many_threads_change_no_bit() {
    for kind in [Kind::Plain, Kind::Mixed] {
        let mut rng = Rng::seed_from_u64(7);
        let models = models(&mut rng, 300, kind);
        equals_each_alone(&mut rng, &models, [400, 1]);
    }
}

#[test]
fn steps_are_a_run() {
    for seed in 0..60 {
        let mut rng = Rng::seed_from_u64(1000 + seed);
        let models = models(&mut rng, seed as usize % 12, Kind::Mixed);
        let (lanes, samples) = (models.len(), 30);
        let series = series(&mut rng, &models, samples);
        let mut run: BatchModel = models.iter().cloned().collect();
        let mut expected = vec![0.0; series.inputs.len()];
        run.run_in(&series.inputs, series.around(), &mut expected)
            .unwrap();
        let mut batch: BatchModel = models.into_iter().collect();
        for n in 0..samples {
            let column = |all: &[f64]| -> Vec<f64> {
                (0..lanes).map(|lane| all[lane * samples + n]).collect()
            };
            let dt = series.time[n] - series.time[n.saturating_sub(1)];
            let loads = series.loads.as_deref().map(column);
            let mut outputs = vec![0.0; lanes];
            batch
                .step_in(
                    &column(&series.inputs),
                    Some(dt),
                    loads.as_deref(),
                    &mut outputs,
                )
                .unwrap();
            assert_eq!(bits(&outputs), bits(&column(&expected)), "seed {seed}");
        }
        assert_eq!(states(&batch), states(&run), "seed {seed}");
    }
}

#[test]
fn an_error_names_its_lane_and_no_state_has_moved() {
    let mut seen = [0; 3];
    for seed in 0..300 {
        let mut rng = Rng::seed_from_u64(2000 + seed);
        let mut models = models(&mut rng, 1 + seed as usize % 15, Kind::Mixed);
        let bad = rng.random_range(0..models.len());
        models[bad] = Arc::new(Model::from_json(LOADED).unwrap());
        let mut batch: BatchModel = models.iter().cloned().collect();
        let samples = rng.random_range(1..40);
        let Series {
            mut inputs,
            mut time,
            loads,
        } = series(&mut rng, &models, samples);
        let mut loads = loads.unwrap();
        let index = rng.random_range(0..samples);
        let (kind, expected) = match rng.random_range(0..3) {
            0 => {
                inputs[bad * samples + index] = [f64::NAN, f64::INFINITY][index % 2];
                (0, (Some(bad), 7))
            }
            1 => {
                loads[bad * samples + index] = 300.0;
                (1, (Some(bad), 23))
            }
            _ if samples > 1 && models.iter().any(|model| model.is_timed()) => {
                time[samples - 1] = time[0] - 1.0;
                let first = models.iter().position(|model| model.is_timed());
                (2, (first, 28))
            }
            _ => continue,
        };
        let before = states(&batch);
        let mut outputs = vec![0.0; inputs.len()];
        let around = Surroundings {
            time: Some(&time),
            load: Some(&loads),
            rest: None,
        };
        let error = batch.run_in(&inputs, around, &mut outputs).unwrap_err();
        let (Error::Lane { lane, error }, _) = error.parts() else {
            unreachable!("{error}")
        };
        assert_eq!(
            (Some(*lane), error.code()),
            expected,
            "seed {seed}: {error}"
        );
        if let Error::Core(CoreError::InputNotFinite { index: found }) = **error {
            assert_eq!(found, index);
        }
        assert_eq!(states(&batch), before, "seed {seed}");
        seen[kind] += 1;
    }
    assert!(seen.iter().all(|count| *count > 20), "{seen:?}");
}

#[test]
fn what_does_not_fit_is_refused() {
    let mut rng = Rng::seed_from_u64(1);
    let plain = model(&mut rng, Kind::Plain);
    let mut batch = BatchModel::new(plain.clone(), 3).unwrap();
    let many = BatchModel::new(plain, usize::MAX).map_err(|error| error.code());
    assert_eq!(many.map(|_| ()), Err(23));
    assert_eq!((batch.lanes(), batch.models().len()), (3, 3));
    let around = |load| Surroundings {
        time: None,
        load: Some(load),
        rest: None,
    };
    let refused = [
        batch.run(&[0.0; 7], &mut [0.0; 7]),
        batch.run(&[0.0; 6], &mut [0.0; 5]),
        batch.run(&[0.0; 6], &mut [0.0; 7]),
        batch.run_in(&[0.0; 6], around(&[0.0; 5]), &mut [0.0; 6]),
        batch.run_in(&[0.0; 6], around(&[0.0; 6]), &mut [0.0; 6]), // no lane has a load
        batch.step(&[0.0; 6], &mut [0.0; 6]),
        batch.step(&[0.0; 2], &mut [0.0; 2]),
        batch.step(&[], &mut []),
    ];
    for (n, refused) in refused.into_iter().enumerate() {
        assert_eq!(refused.map_err(|error| error.code()), Err(23), "{n}");
    }
    let mut none = BatchModel::from_iter(Vec::<Model>::new());
    assert_eq!(none.run(&[], &mut []).unwrap(), ClippedCount::default());
    assert!(none.run(&[1.0], &mut [0.0]).is_err());
}

/// The remedy stays apart from what is wrong, for surfaces that spell options in their own way.
#[test]
fn a_lane_without_its_load_says_what_is_needed() {
    let loaded = Model::from_json(LOADED).unwrap();
    let mut batch = BatchModel::new(loaded, 2).unwrap();
    let error = batch.step(&[40.0; 2], &mut [0.0; 2]).unwrap_err();
    assert!(
        error.to_string().starts_with("lane number 0 (from 0): "),
        "{error}"
    );
    assert!(error.to_string().contains("load"), "{error}");
    assert_eq!(error.code(), 23);
}

//! The properties of Preisach hysteresis, on random models.

use crate::common::{OPERATORS, Owned, build, inputs, levels, plane, rng, weights};
use hysteron_core::Operator;
use rand::RngExt;
use rand::rngs::StdRng;

struct Case {
    rng: StdRng,
    model: Owned<f64>,
    history: Vec<f64>,
    /// Two inputs in order, within the plane.
    low: f64,
    high: f64,
    /// Rounding error of the outputs, far below the effect of a wrong turning point.
    close: f64,
}

fn cases(count: u64) -> impl Iterator<Item = Case> {
    (0..count).map(|seed| {
        let mut rng = rng(seed);
        let k = levels(&mut rng, 60);
        let plane = plane(&mut rng, k);
        let operator = OPERATORS[rng.random_range(0..3)];
        let weights = weights(&mut rng, k);
        let history = inputs(&mut rng, &plane, 150);
        let span = plane.max() - plane.bottom();
        let low = plane.bottom() + span * rng.random_range(0.0..0.9);
        let high = low + (plane.max() - low) * rng.random_range(0.1..1.0);
        let close = 1e-12 * weights.iter().sum::<f64>();
        let model = build(plane, operator, &weights);
        Case {
            rng,
            model,
            history,
            low,
            high,
            close,
        }
    })
}

impl Case {
    fn go(&mut self, inputs: impl IntoIterator<Item = f64>) -> f64 {
        let (model, state) = &mut self.model;
        inputs
            .into_iter()
            .map(|t| model.step(state, t).unwrap().output)
            .last()
            .unwrap()
    }

    fn after_history(mut self) -> Self {
        let history = std::mem::take(&mut self.history);
        self.go(history);
        self
    }
}

#[test]
fn wiping_out() {
    for mut case in cases(300) {
        let top = case.model.0.plane().max();
        let history = std::mem::take(&mut case.history);
        case.go(history);
        // A larger maximum wipes out all extremes inside it; a saturating one wipes out everything.
        let after = case.go([top, case.low, case.high]);
        let left: Vec<f64> = case.model.1.turning_points().collect();
        let (model, fresh) = (&case.model.0, &mut case.model.1);
        model.reset_on(fresh).unwrap();
        let direct = case.go([case.low, case.high]);
        assert!((after - direct).abs() <= case.close);
        assert_eq!(left, case.model.1.turning_points().collect::<Vec<_>>());
        assert!(case.model.1.corners() <= 1);
    }
}

#[test]
fn return_point_memory_and_closed_minor_loops() {
    for case in cases(300) {
        let mut case = case.after_history();
        let (low, high) = (case.low, case.high);
        case.go([low]);
        let first = case.go([high]);
        let inner: Vec<f64> = (0..50).map(|_| case.rng.random_range(low..high)).collect();
        case.go(inner);
        // Back at the turning point, the loop is closed, whatever happened inside.
        assert!((case.go([high]) - first).abs() <= case.close);
        assert!((case.go([low, high]) - first).abs() <= case.close);
        assert!(case.model.1.corners() <= 2 * case.model.0.plane().levels());
    }
}

#[test]
fn congruency() {
    // Loops between the same two inputs have the same shape, whatever went before.
    for case in cases(300) {
        let (low, high) = (case.low, case.high);
        let path: Vec<f64> = (0..=20)
            .map(|n| low + (high - low) * f64::from(n) / 20.0)
            .collect();
        let mut shapes = Vec::new();
        let mut case = case;
        for _ in 0..2 {
            case = case.after_history();
            let start = case.go([high, low]);
            shapes.push(
                path.iter()
                    .map(|&t| case.go([t]) - start)
                    .collect::<Vec<_>>(),
            );
            case.history = vec![case.model.0.plane().max(), high];
        }
        for (one, other) in shapes[0].iter().zip(&shapes[1]) {
            assert!((one - other).abs() <= case.close);
        }
    }
}

#[test]
fn rate_independence() {
    // Samples in between and repeated samples change nothing.
    for mut case in cases(200) {
        let history = std::mem::take(&mut case.history);
        let coarse: Vec<f64> = history.iter().map(|&t| case.go([t])).collect();
        let (model, state) = (&case.model.0, &mut case.model.1);
        model.reset_off(state).unwrap();
        let mut last = model.plane().bottom();
        for (&t, &expected) in history.iter().zip(&coarse) {
            let between: Vec<f64> = (1..5)
                .map(|n| last + (t - last) * f64::from(n) / 5.0)
                .collect();
            case.go(between);
            let fine = case.go([t, t]);
            assert!((fine - expected).abs() <= case.close);
            last = t;
        }
    }
}

#[test]
fn monotonicity() {
    for case in cases(300) {
        let mut case = case.after_history();
        let plane = *case.model.0.plane();
        let mut last = case.go([case.low]);
        // The end of the range itself, because the computed one may fall short by rounding.
        let low = case.low;
        let way = |n| low + (plane.max() - low) * f64::from(n) / 100.0;
        for t in (0..100).map(way).chain([plane.max()]) {
            let now = case.go([t]);
            assert!(now >= last - case.close);
            last = now;
        }
        let (low, high) = case.model.0.output_range();
        assert!((last - high).abs() <= case.close && low <= high);
        assert!((case.go([plane.bottom()]) - low).abs() <= case.close);
    }
}

#[test]
fn kp_is_twice_mkp_less_one() {
    for case in cases(100) {
        let plane = *case.model.0.plane();
        let mut rng = rng(1);
        let mu = weights(&mut rng, plane.levels());
        let (mkp, mut mkp_state) = build(plane, Operator::Mkp, &mu);
        let (kp, mut kp_state) = build(plane, Operator::Kp, &mu);
        let sum: f64 = mu.iter().sum();
        for &t in &case.history {
            let half = mkp.step(&mut mkp_state, t).unwrap().output;
            let whole = kp.step(&mut kp_state, t).unwrap().output;
            assert!((2.0 * half - sum - whole).abs() <= 1e-12 * sum);
        }
    }
}

#[test]
fn the_staircase_separates_what_is_on_from_what_is_off() {
    for case in cases(100) {
        if case.model.0.operator() == Operator::Relay {
            continue; // its ridges have no width to lie on
        }
        let case = case.after_history();
        let (model, state) = &case.model;
        let plane = model.plane();
        let vertices: Vec<(f64, f64)> = state.staircase(plane).collect();
        for pair in vertices.windows(2) {
            assert!(
                pair[0].0 <= pair[1].0 && pair[0].1 >= pair[1].1,
                "{vertices:?}"
            );
        }
        let end = vertices[vertices.len() - 1];
        assert_eq!(end.0, end.1);
        for j in 1..=plane.levels() {
            for i in 1..=j {
                let gamma = state.gamma(i, j).unwrap();
                // Fully on: some vertex lies above and right of the operator's whole cell edge.
                let (alpha, beta) = (plane.level(i), plane.level(j));
                let rounding = 1e-9 * plane.step();
                let inside = vertices
                    .iter()
                    .any(|v| v.0 >= alpha - rounding && v.1 >= beta - rounding);
                let outside = vertices.iter().all(|v| {
                    v.0 <= alpha - plane.step() + rounding || v.1 <= beta - plane.step() + rounding
                });
                assert!(
                    !inside || gamma > 1.0 - 1e-8,
                    "({i}, {j}) {gamma} {vertices:?}"
                );
                assert!(!outside || gamma < 1e-8, "({i}, {j}) {gamma} {vertices:?}");
            }
        }
    }
}

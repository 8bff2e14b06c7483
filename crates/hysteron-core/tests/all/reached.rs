//! The status of the inverse is true for every state, target, heading, tolerance and operator.

use crate::common::{OPERATORS, Owned, build, build_f32, inputs, levels, plane, rng, weights};
use hysteron_core::{Direction, Operator, Real, Solution, Status, Target, operator_count};
use rand::rngs::StdRng;
use rand::{Rng, RngExt};

/// Conversion of the number type under test to and from `f64`.
struct Numbers<T> {
    of: fn(f64) -> T,
    to: fn(T) -> f64,
}

const DOUBLE: Numbers<f64> = Numbers {
    of: |x| x,
    to: |x| x,
};
const SINGLE: Numbers<f32> = Numbers {
    of: |x| x as f32,
    to: f64::from,
};

/// A model whose inverse is tested, and a separate copy that gives the true output.
struct Attack<T: Real> {
    model: Owned<T>,
    apart: Owned<T>,
    numbers: Numbers<T>,
    /// Past outputs. The targets at which a branch began are among them.
    outputs: Vec<f64>,
}

#[derive(Debug, Default)]
struct Seen {
    reached: usize,
    headed: usize,
    passed: usize,
    out_of_reach: usize,
}

impl<T: Real> Attack<T> {
    fn range(&self) -> (f64, f64) {
        let (low, high) = self.model.0.output_range();
        ((self.numbers.to)(low), (self.numbers.to)(high))
    }

    /// Rounding error of an output: that of the sums, and that of the input on the steepest
    /// possible slope, with all weights in one cell.
    fn rounding(&self) -> f64 {
        let (plane, to) = (self.model.0.plane(), self.numbers.to);
        let (low, high) = self.range();
        let input = to(plane.bottom()).abs().max(to(plane.max()).abs()) / to(plane.step());
        to(T::EPSILON) * (high - low) * (16.0 + 4.0 * input)
    }

    fn target(&self, rng: &mut impl Rng, tolerance: f64) -> f64 {
        let (low, high) = self.range();
        let now = (self.numbers.to)(self.model.0.output(&self.model.1));
        let base = match rng.random_range(0..6) {
            0 => now,
            1 => low,
            2 => high,
            3 | 4 => self.outputs[rng.random_range(0..self.outputs.len())],
            _ => low + rng.random_range(-0.2..1.2) * (high - low),
        };
        let tolerance = if tolerance.is_finite() {
            tolerance
        } else {
            0.0
        };
        let shares = [0.0, 0.0, 0.5, -0.5, 1.0, -1.0, 1.5, -1.5];
        // Also within the rounding error of an output.
        let rounding = (self.numbers.to)(T::EPSILON) * (high - low) * rng.random_range(-4.0..4.0);
        let close = [0.0, rounding][rng.random_range(0..2)];
        base + shares[rng.random_range(0..shares.len())] * tolerance + close
    }

    fn step(&mut self, rng: &mut impl Rng, seen: &mut Seen) {
        let (low, high) = self.range();
        let widths = [
            0.0,
            0.0,
            -1.0,
            1e-9,
            0.01,
            0.1,
            3.0,
            1e17, // the output is lost in it
            f64::NAN,
            f64::INFINITY,
        ];
        let given = (high - low) * widths[rng.random_range(0..widths.len())];
        let tolerance = (self.numbers.of)(given);
        let target = (self.numbers.of)(self.target(rng, given));
        let headings = [None, Some(Direction::Rising), Some(Direction::Falling)];
        let heading = headings[rng.random_range(0..3)];
        let wanted = Target::new(target).heading(heading).tolerance(tolerance);
        let before = (self.numbers.to)(self.apart.0.output(&self.apart.1));
        let inverse = self.model.0.inverse().unwrap();
        let solution = inverse.step(&mut self.model.1, wanted).unwrap();
        let reached = self.apart.0.step(&mut self.apart.1, solution.input);
        let reached = (self.numbers.to)(reached.unwrap().output);
        self.outputs.push(reached);
        let allowed = (self.numbers.to)(tolerance).max(0.0) + self.rounding(); // NaN counts as 0
        let target = (self.numbers.to)(target);
        let what = format!("{wanted:?} from {before}: {solution:?}, output {reached}");
        self.judge(&solution, (before, target, reached), allowed, &what);
        match solution.status {
            Status::Ok if heading.is_none() => seen.reached += 1,
            Status::Ok => seen.headed += 1,
            Status::Passed => seen.passed += 1,
            Status::Low | Status::High => seen.out_of_reach += 1,
            Status::Limited => unreachable!("nothing limits the operators alone: {what}"),
        }
    }

    fn judge(
        &self,
        solution: &Solution<T>,
        (before, target, reached): (f64, f64, f64),
        allowed: f64,
        what: &str,
    ) {
        let (low, high) = self.range();
        let near = (reached - target).abs() <= allowed;
        match solution.status {
            Status::Ok => assert!(near, "{what}"),
            Status::Passed => {
                assert_eq!(self.model.0.operator(), Operator::Relay, "{what}");
                let rounding = self.rounding();
                let beyond = before <= target + rounding && target <= reached + rounding
                    || before >= target - rounding && target >= reached - rounding;
                assert!(beyond, "{what}");
            }
            Status::Low => assert!(target < low && (reached - low).abs() <= allowed, "{what}"),
            Status::High => assert!(target > high && (reached - high).abs() <= allowed, "{what}"),
            Status::Limited => unreachable!("nothing limits the operators alone: {what}"),
        }
    }

    fn run(&mut self, rng: &mut StdRng, seen: &mut Seen) {
        let plane = *self.model.0.plane();
        let [min, max] = [plane.min(), plane.max()].map(self.numbers.to);
        let walk = hysteron_core::Plane::new(min, max, plane.levels()).unwrap();
        for _ in 0..20 {
            // Forward model and inverse move the same state in turn.
            let count = rng.random_range(1..20);
            for input in inputs(rng, &walk, count) {
                let input = (self.numbers.of)(input);
                let output = self.model.0.step(&mut self.model.1, input).unwrap().output;
                self.apart.0.step(&mut self.apart.1, input).unwrap();
                self.outputs.push((self.numbers.to)(output));
            }
            for _ in 0..rng.random_range(1..20) {
                self.step(rng, seen);
            }
        }
    }
}

#[test]
fn a_target_that_is_said_to_be_reached_is_reached() {
    let mut seen = Seen::default();
    for seed in 0..900 {
        let mut rng = rng(31_000 + seed);
        let k = levels(&mut rng, 40);
        let (plane, mu) = (plane(&mut rng, k), weights(&mut rng, k));
        let operator = OPERATORS[seed as usize % 3];
        let mut double = Attack {
            model: build(plane, operator, &mu),
            apart: build(plane, operator, &mu),
            numbers: DOUBLE,
            outputs: vec![0.0],
        };
        double.run(&mut rng, &mut seen);
        let mut single = Attack {
            model: build_f32(&plane, operator, &mu),
            apart: build_f32(&plane, operator, &mu),
            numbers: SINGLE,
            outputs: vec![0.0],
        };
        single.run(&mut rng, &mut seen);
    }
    println!("{seen:?}");
    let Seen {
        reached,
        headed,
        passed,
        out_of_reach,
    } = seen;
    assert!(reached.min(headed).min(passed).min(out_of_reach) > 1000);
}

#[test]
fn a_target_that_jumps_back_to_where_the_branch_began_is_followed() {
    let plane = hysteron_core::Plane::new(0.0, 10.0, 5).unwrap();
    let (model, mut state) = build(plane, Operator::Mkp, &[1.0; 15]);
    let inverse = model.inverse().unwrap();
    let targets = [
        (0.0, Direction::Rising, -2.5),
        (15.0, Direction::Falling, 10.0),
        (0.0, Direction::Rising, -2.5),
    ];
    for (target, heading, input) in targets {
        let wanted = Target::new(target).heading(Some(heading));
        let solution = inverse.step(&mut state, wanted).unwrap();
        assert_eq!((solution.input, solution.status), (input, Status::Ok));
        assert_eq!(model.output(&state), target);
    }
}

/// A target that turns gives the input at the far edge of the dead band. One step further the
/// output moves.
#[test]
fn a_target_that_turns_is_met_at_the_edge_of_the_dead_band() {
    let mut edges = 0;
    for seed in 0..600 {
        let mut rng = rng(52_000 + seed);
        let k = levels(&mut rng, 30);
        // Inputs equal positions, so that rounding puts no state just beside a grid line.
        let plane = hysteron_core::Plane::new(1.0, k as f64, k).unwrap();
        // Weights are zero or large enough to tell a move from rounding. Where most are zero, the
        // dead band often goes on beyond the extreme at which the branch ends.
        let zeros = [0.3, 0.9][seed as usize / 3 % 2];
        let mu: Vec<f64> = (0..operator_count(k))
            .map(|_| match rng.random_bool(zeros) {
                true => 0.0,
                false => f64::from(rng.random_range(1..3_u8)),
            })
            .collect();
        let operator = OPERATORS[seed as usize % 3];
        let (model, mut state) = build(plane, operator, &mu);
        let inverse = model.inverse().unwrap();
        for input in inputs(&mut rng, &plane, 40) {
            model.step(&mut state, input).unwrap();
            let target = model.output(&state);
            let rising = !state.is_rising();
            let heading = if rising {
                Direction::Rising
            } else {
                Direction::Falling
            };
            let wanted = Target::new(target).heading(Some(heading));
            let edge = inverse.step(&mut state, wanted).unwrap();
            // Relays are at a level. The next one is a step away, and a little more for rounding.
            let further = plane.step()
                * if operator == Operator::Relay {
                    1.001
                } else {
                    1e-3
                };
            let next = edge.input + if rising { further } else { -further };
            if next > plane.max() || next < plane.bottom() {
                continue;
            }
            let moved = model.step(&mut state.clone(), next).unwrap().output - target;
            assert!(
                if rising { moved > 1e-9 } else { moved < -1e-9 },
                "seed {seed}: {edge:?}, then {moved}"
            );
            edges += 1;
        }
    }
    assert!(edges > 5000, "{edges}");
}

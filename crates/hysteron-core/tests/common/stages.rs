//! Random stages around the operators.
#![allow(clippy::panic)]

use hysteron_core::{Operator, Plane, Real, Stages};
use rand::RngExt;
use rand::rngs::StdRng;

/// Random constants of all stages. Each is there in half of the cases.
#[derive(Debug, Clone)]
pub struct Constants {
    pub body: Option<[f64; 4]>,
    pub latent: f64,
    pub loads: Vec<f64>,
    pub shifts: Vec<f64>,
    pub scales: Vec<f64>,
    pub gains: Vec<f64>,
    pub offsets: Vec<f64>,
    pub knots: Vec<f64>,
    pub up: Vec<f64>,
    pub down: Vec<f64>,
    pub spacing: Vec<f64>,
    pub sums: Vec<f64>,
    pub outputs: Vec<f64>,
    pub coefficients: Vec<f64>,
    pub taus: Vec<f64>,
    pub lag: f64,
    /// Frequency and damping of a ring.
    pub ring: Option<[f64; 2]>,
    pub offset: f64,
    pub falling: bool,
}

pub fn ascending(rng: &mut StdRng, count: usize, from: f64, span: f64) -> Vec<f64> {
    let steps: Vec<f64> = (0..count).map(|_| rng.random_range(0.2..1.0)).collect();
    let total: f64 = steps.iter().sum();
    let mut at = from;
    let knot = |step: &f64| {
        at += span * step / total;
        at
    };
    steps.iter().map(knot).collect()
}

/// Knots over an axis from `low` on, and rows of temperatures for rising and falling input: none, the
/// same ones, or two that never cross.
pub fn registration(rng: &mut StdRng, (low, span): (f64, f64), loads: usize) -> [Vec<f64>; 3] {
    let kind = rng.random_range(0..4);
    if kind < 2 {
        return [const { Vec::new() }; 3];
    }
    let count = rng.random_range(2..7);
    let (mut rising, mut falling) = (Vec::new(), Vec::new());
    for _ in 0..loads.max(1) {
        let [a, b] = [0, 1].map(|_| {
            let from = low + span * rng.random_range(-0.3..0.2);
            let width = span * rng.random_range(0.6..1.2);
            ascending(rng, count, from, width)
        });
        rising.extend(a.iter().zip(&b).map(|(a, b)| f64::max(*a, *b)));
        falling.extend(a.iter().zip(&b).map(|(a, b)| f64::min(*a, *b)));
    }
    if kind == 2 {
        falling.clear();
    }
    [ascending(rng, count, low, span), rising, falling]
}

impl Constants {
    pub fn random(rng: &mut StdRng, plane: &Plane<f64>) -> Self {
        let span = plane.max() - plane.bottom();
        let count = if rng.random() {
            rng.random_range(1..5)
        } else {
            0
        };
        let creeps = if rng.random() {
            rng.random_range(1..=4)
        } else {
            0
        };
        let knots = if rng.random() {
            rng.random_range(2..8)
        } else {
            0
        };
        let mut numbers = |count: usize, low: f64, high: f64| -> Vec<f64> {
            (0..count).map(|_| rng.random_range(low..high)).collect()
        };
        let shifts = numbers(count, -0.2 * span, 0.2 * span);
        let scales = numbers(count, 0.7, 1.4);
        let gains = numbers(count, 0.3, 3.0);
        let offsets = numbers(count, -4.0, 4.0);
        let coefficients = numbers(creeps, 0.0, 0.2);
        let taus = numbers(creeps, 0.05, 20.0);
        let body = numbers(4, 0.3, 3.0);
        let offset = numbers(1, -5.0, 5.0)[0];
        let lag = numbers(1, 0.01, 1.0)[0];
        // Seldom, so that the other stages are met as often as missed.
        let ring = rng.random_range(0..4) == 0;
        let ring = ring.then(|| {
            let damping = 10_f64.powf(rng.random_range(-4.0..0.2)).min(1.0);
            [10_f64.powf(rng.random_range(-2.0..1.0)), damping]
        });
        // Up to many times the range of the levels: then a stroke is an affair of heat alone.
        let latent = span * 10_f64.powf(rng.random_range(-3.0..1.5));
        let binds = rng.random();
        let (spaced, scaled, gained) = (rng.random(), rng.random(), rng.random());
        let corners = plane.levels() + 1;
        let loads = ascending(rng, count, -3.0, 10.0);
        let spacing = match spaced {
            true => ascending(rng, corners, plane.bottom(), span),
            false => Vec::new(),
        };
        let (sums, outputs) = (
            ascending(rng, knots, -2.0, 12.0),
            ascending(rng, knots, -1.0, 8.0),
        );
        let [knots, up, down] = registration(rng, (plane.bottom(), span), count);
        let body = rng
            .random::<bool>()
            .then(|| [plane.bottom(), span * body[1], body[2], body[3]]);
        Self {
            body,
            latent: match body.is_some() && binds {
                true => latent,
                false => 0.0,
            },
            loads,
            shifts,
            scales: if scaled { scales } else { Vec::new() },
            gains: if gained { gains } else { Vec::new() },
            offsets: if gained { offsets } else { Vec::new() },
            knots,
            up,
            down,
            spacing,
            sums,
            outputs,
            coefficients,
            taus,
            lag: if rng.random() { lag } else { 0.0 },
            ring,
            offset,
            falling: rng.random(),
        }
    }

    /// Those that a model of this operator can have: relays bind no heat.
    pub fn of(mut self, operator: Operator) -> Self {
        if operator == Operator::Relay {
            self.latent = 0.0;
        }
        self
    }

    /// The numbers of the constant with this name.
    fn list(&self, name: &str) -> &[f64] {
        let of_body = |k: usize| self.body.as_ref().map_or(&[][..], |body| &body[k..=k]);
        match name {
            "ambient" => of_body(0),
            "gain" => of_body(1),
            "tau_heating" => of_body(2),
            "tau_cooling" => of_body(3),
            "latent" => std::slice::from_ref(&self.latent),
            "loads" => &self.loads,
            "shifts" => &self.shifts,
            "scales" => &self.scales,
            "gains" => &self.gains,
            "offsets" => &self.offsets,
            "knots" => &self.knots,
            "rising" => &self.up,
            "falling" => &self.down,
            "spacing" => &self.spacing,
            "curve_sums" => &self.sums,
            "curve_outputs" => &self.outputs,
            "creep" => &self.coefficients,
            "creep_taus" => &self.taus,
            "lag" => std::slice::from_ref(&self.lag),
            "ring_frequency" => self.ring.as_ref().map_or(&[], |ring| &ring[..1]),
            "ring_damping" => self.ring.as_ref().map_or(&[], |ring| &ring[1..]),
            other => panic!("no such constant: {other}"),
        }
    }

    pub fn map<T: Real>(&self, number: impl Fn(f64) -> T) -> Owned<T> {
        let constants = Stages::<T>::declared().flat_map(|stage| stage.constants);
        let lists = constants.map(|constant| {
            let numbers = self.list(constant.name).iter().map(|v| number(*v));
            (constant.name, numbers.collect())
        });
        Owned {
            lists: lists.collect(),
            offset: number(self.offset),
            falling: self.falling,
        }
    }
}

pub struct Owned<T> {
    pub lists: Vec<(&'static str, Vec<T>)>,
    pub offset: T,
    pub falling: bool,
}

impl<T: Real> Owned<T> {
    pub fn body(&self) -> Option<hysteron_core::Body<T>> {
        self.stages().body
    }

    pub fn stages(&self) -> Stages<'_, T> {
        let list = |name| self.lists.iter().find(|list| list.0 == name);
        let numbers = |name| list(name).map_or(&[][..], |list| &list.1);
        let stages = Stages::with_constants(|constant| numbers(constant.name));
        Stages {
            offset: self.offset,
            falling: self.falling,
            ..stages.unwrap()
        }
    }
}

//! Models with every stage, and series to drive them.
#![allow(dead_code, reason = "not every test takes them all")]

use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// Every stage: body, load curves, spacing, creep, lag, and a start that was found.
pub const WHOLE: &str = r#"{"format": "hysteron-model", "version": 2, "operator": "mkp",
  "plane": {"min": 30.0, "max": 60.0, "levels": 3},
  "input": {"name": "duty"}, "output": {"name": "lift", "unit": "mm", "offset": 2.0, "sign": -1},
  "weights": [1.0, 0.5, 1.0, 0.25, 0.5, 1.0],
  "load": {"name": "stress", "unit": "MPa", "min": 50.0, "max": 200.0,
    "parts": [{"offset": 2.0, "weights": [1.0, 0.5, 1.0, 0.25, 0.5, 1.0]}],
    "curves": {"loads": [50.0, 100.0, 200.0], "shifts": [0.0, 5.0, 20.0],
      "scales": [1.0, 1.1, 1.0], "gains": [1.0, 1.2, 1.3], "offsets": [0.0, 0.5, 0.7]}},
  "thermal": {"kind": "first-order", "ambient": 20.0, "gain": 100.0, "tau_heating": 2.0,
    "tau_cooling": 5.0},
  "drive": {"min": 0.0, "max": 1.0},
  "spacing": [15.0, 35.0, 40.0, 60.0],
  "creep": [{"coefficient": 0.02, "tau": 1.0}, {"coefficient": 0.01, "tau": 30.0}],
  "lag": 0.05,
  "start": {"turning_points": [2.5, 0.5], "input": 20.0}}"#;

/// Weights that depend on the load, behind a body.
pub const BY_LOAD: &str = r#"{"format": "hysteron-model", "version": 2, "operator": "kp",
  "plane": {"min": 30.0, "max": 60.0, "levels": 3},
  "output": {"offset": 1.5, "sign": 1},
  "weights": [1.0, 1.0, 1.0, 0.5, 0.75, 1.5],
  "load": {"min": 50.0, "max": 200.0, "parts": [
    {"offset": 1.0, "weights": [1.0, 0.5, 1.0, 0.0, 0.5, 1.0]},
    {"offset": 2.0, "weights": [1.0, 1.5, 1.0, 1.0, 1.0, 2.0]}]},
  "thermal": {"kind": "first-order", "gain": 80.0, "tau_heating": 1.0, "tau_cooling": 3.0},
  "lag": 0.1}"#;

/// Series that go with each other; `step` is the time since the sample before.
pub struct Series {
    pub input: Vec<f64>,
    pub target: Vec<f64>,
    pub load: Vec<f64>,
    pub step: Vec<f64>,
    pub time: Vec<f64>,
}

pub fn series(seed: u64, count: usize) -> Series {
    let mut random = StdRng::seed_from_u64(seed);
    let mut draw = |low: f64, high: f64| -> Vec<f64> {
        (0..count).map(|_| random.random_range(low..high)).collect()
    };
    let (input, target) = (draw(0.0, 1.0), draw(-3.0, 6.0));
    let (load, steps) = (draw(50.0, 200.0), draw(0.0, 1.0));
    let mut now = 0.0;
    let time: Vec<f64> = steps
        .iter()
        .map(|step| {
            now += step;
            now
        })
        .collect();
    let step = (0..count)
        .map(|n| time[n] - time[n.saturating_sub(1)])
        .collect();
    Series {
        input,
        target,
        load,
        step,
        time,
    }
}

//! Loops on the simulated plants, for the tests of control, faults and comparisons.
#![allow(clippy::unwrap_used)]

use hysteron::control::{Gains, InnerLoop, Scheme, SimulatedPlant};
use hysteron::{Model, Policy, Progress};
use hysteron_sim::track::{Scenario, track};
use std::path::Path;
use std::sync::OnceLock;

/// A scenario on the spring, without a reference and controllers.
pub const SPRING: &str = r#"
title = "spring"
duration_s = 2400
interval_s = 0.2
settle_s = 120
seeds = 1
plant = { kind = "spring", load_n = 6.0 }
model = { levels = 20, range = [24, 92], smooth = 1e-8, rates = [2.0, 0.5] }
loop = { filter_s = 0.6, tolerance = 0.1 }
adaptation.method = "least-squares"
adaptation.forgetting = 0.9995
adaptation.noise = 0.3
adaptation.spread = 0.05
adaptation.correlation = 3.0
adaptation.offset_share = 10.0
adaptation.movement = 0.02
"#;

/// A slow sine within the spring's stroke.
pub const SPRING_SINE: &str = r#"
[[reference]]
kind = "constant"
value = 4.0
[[reference]]
kind = "sine"
amplitude = 2.5
period_s = 300
phase_deg = -90
"#;

/// The same for the cloud of relays.
pub const RELAYS: &str = r#"
title = "relays"
duration_s = 60
interval_s = 0.01
settle_s = 5
seeds = 1
plant = { kind = "preisach", load_n = 6.0 }
model = { levels = 14, range = [8, 150], smooth = 1e-8, rates = [100, 100] }
loop = { filter_s = 0.01, tolerance = 0.5 }
adaptation.method = "least-squares"
adaptation.forgetting = 0.9995
adaptation.noise = 0.3
adaptation.spread = 0.2
adaptation.correlation = 3.0
adaptation.offset_share = 10.0
adaptation.movement = 0.02
"#;

/// A sine within the cloud's stroke.
pub const RELAYS_SINE: &str = r#"
[[reference]]
kind = "constant"
value = 36.0
[[reference]]
kind = "sine"
amplitude = 24
period_s = 2
phase_deg = -90
"#;

/// The scenario of some TOML, with other lines in place of its own for the same keys.
pub fn scenario(parts: &[&str]) -> Scenario {
    Scenario::parse(&text(parts), Path::new("")).unwrap()
}

/// The parts one after the other; a line `key = …` at the top level replaces the one before it.
pub fn text(parts: &[&str]) -> String {
    let (mut top, mut tables): (Vec<&str>, Vec<&str>) = (Vec::new(), Vec::new());
    for part in parts {
        let mut inside = false;
        for line in part.lines() {
            inside |= line.starts_with('[');
            if inside {
                tables.push(line);
            } else {
                let key = |line: &str| line.split('=').next().map(str::trim).map(str::to_owned);
                top.retain(|other| key(other) != key(line));
                top.push(line);
            }
        }
    }
    [top, tables].concat().join("\n")
}

/// A plant with its model and its tuned gains.
pub struct Known {
    pub scenario: Scenario,
    pub model: Model,
    pub gains: Gains,
    pub inner: Option<InnerLoop>,
}

impl Known {
    fn of(parts: &[&str]) -> Self {
        let scenario = scenario(&[parts, &["controllers = [\"pid\"]"]].concat());
        let found = track(&scenario, Progress::NONE).unwrap();
        Self {
            model: found.model,
            gains: found.gains.unwrap(),
            inner: found.inner_gains.map(|gains| InnerLoop {
                gains,
                square_root: true,
            }),
            scenario,
        }
    }

    pub fn spring() -> &'static Self {
        static KNOWN: OnceLock<Known> = OnceLock::new();
        KNOWN.get_or_init(|| Self::of(&[SPRING, "duration_s = 300", SPRING_SINE]))
    }

    pub fn relays() -> &'static Self {
        static KNOWN: OnceLock<Known> = OnceLock::new();
        KNOWN.get_or_init(|| Self::of(&[RELAYS, "duration_s = 10", RELAYS_SINE]))
    }

    /// PID without a model.
    pub fn scheme(&self) -> Scheme {
        let drives = self.scenario.plant.drives();
        let plane = self.model.plane();
        Scheme {
            interval_s: self.scenario.interval_s,
            compensator: None,
            policy: Policy::Hold,
            tolerance: self.scenario.shared.tolerance,
            pid: Some(self.gains),
            bias: plane.bottom(),
            commands: match self.inner {
                Some(_) => (plane.bottom(), plane.max()),
                None => drives,
            },
            drives,
            inner: self.inner,
            filter_s: self.scenario.shared.filter_s,
            stuck_s: Some(15.0 * self.scenario.interval_s),
            ..Scheme::new(self.scenario.interval_s, drives)
        }
    }

    pub fn plant(&self, seed: u64) -> Box<dyn SimulatedPlant> {
        self.scenario.plant.build(seed).unwrap()
    }
}

pub fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, n), e| (sum + e * e, n + 1));
    (sum / f64::from(count)).sqrt()
}

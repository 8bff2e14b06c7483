//! Made-up runs: a reference of sweeps and steps, controllers that follow it late and with errors
//! of their own.
#![allow(clippy::unwrap_used)]

use super::{NamedTrace, TrackTable, Tracking};
use crate::made::Made;
use crate::report::{Report, Shown};
use hysteron::control::{LoopStatus, Snapshot, Trace};
use hysteron::{Plane, Quantity, operators};

/// How a made-up controller does.
#[derive(Clone, Copy)]
pub(super) struct Controller {
    pub(super) name: &'static str,
    /// s.
    pub(super) lag: f64,
    /// Error after the event, mm.
    pub(super) error: f64,
    pub(super) model: bool,
    pub(super) adapts: bool,
}

pub(super) const FOUR: [Controller; 4] = [
    controller("PID", 9.0, 0.5, false, false),
    controller("inverse", 2.0, 1.6, true, false),
    controller("inverse and PID, hold", 3.5, 0.8, true, false),
    controller(
        "adaptive inverse and PID, anticipate",
        1.2,
        0.15,
        true,
        true,
    ),
];

const fn controller(
    name: &'static str,
    lag: f64,
    error: f64,
    model: bool,
    adapts: bool,
) -> Controller {
    Controller {
        name,
        lag,
        error,
        model,
        adapts,
    }
}

/// The parts of a report.
pub(super) struct Fixture {
    pub(super) names: Vec<&'static str>,
    pub(super) traces: Vec<Trace>,
    pub(super) events: Vec<(f64, String)>,
    pub(super) table: TrackTable,
    pub(super) plane: Plane,
}

impl Fixture {
    /// Runs of `samples` samples over 900 s; the load steps after 450 s.
    pub(super) fn new(controllers: &[Controller], samples: usize) -> Self {
        let plane = Plane::new(20.0, 80.0, 20).unwrap();
        Self {
            names: controllers.iter().map(|c| c.name).collect(),
            traces: controllers
                .iter()
                .map(|c| trace(c, samples, &plane))
                .collect(),
            events: vec![(450.0, "load 10 N".into()), (700.0, "room 30 °C".into())],
            table: TrackTable {
                headers: vec!["RMSE before [mm]".into(), "RMSE after [mm]".into()],
                rows: controllers
                    .iter()
                    .map(|c| (c.name.into(), vec![Some(0.1 * c.lag), None]))
                    .collect(),
                ratio_headers: vec!["tracking RMSE".into()],
                ratios: vec![("before: inverse / PID".into(), vec![Some(0.25)])],
                notes: vec!["Medians over 20 seeds.".into()],
            },
            plane,
        }
    }

    /// Calls `show` with the parts.
    pub(super) fn tracking<R>(&self, simulated: bool, show: impl Fn(&Tracking<'_>) -> R) -> R {
        let named = self.names.iter().zip(&self.traces);
        let runs: Vec<NamedTrace<'_>> = named
            .map(|(name, trace)| NamedTrace { name, trace })
            .collect();
        show(&Tracking {
            simulated,
            input: Quantity::with_unit("temperature", "degC"),
            output: Quantity::with_unit("displacement", "mm"),
            drive: Quantity::with_unit("current", "A"),
            runs: &runs,
            events: &self.events,
            table: &self.table,
            plane: &self.plane,
        })
    }

    /// Calls `show` with the report of them.
    pub(super) fn report<R>(&self, simulated: bool, show: impl Fn(&Report<'_>) -> R) -> R {
        self.tracking(simulated, |tracking| show(&report(tracking)))
    }
}

pub(super) fn report<'a>(tracking: &'a Tracking<'a>) -> Report<'a> {
    Report {
        title: "load-step: simulated NiTi spring, 6 N to 10 N",
        shown: Shown::Tracking(tracking),
        made: Made::default(),
    }
}

/// Sweeps over and over, each to other ends.
fn reference(t: f64) -> f64 {
    7.0 + 4.0 * triangle(t / 110.0) + 0.8 * triangle(t / 47.0)
}

fn triangle(phase: f64) -> f64 {
    4.0 * (phase - (phase + 0.5).floor()).abs() - 1.0
}

fn trace(controller: &Controller, samples: usize, plane: &Plane) -> Trace {
    let time: Vec<f64> = (0..samples)
        .map(|n| 900.0 * n as f64 / samples.max(2) as f64)
        .collect();
    let noise = |t: f64, k: f64| (91.7 * t * k).sin() * (37.3 * t).cos();
    // A step that an adaptive controller learns.
    let wrong = |t: f64| match (t > 450.0, controller.adapts) {
        (false, _) => 0.03,
        (true, false) => controller.error,
        (true, true) => 0.03 + 1.5 * (-(t - 450.0) / 40.0).exp(),
    };
    let output = |t: f64| {
        let start = 6.0 * (-t / 4.0).exp();
        reference(t - controller.lag) - wrong(t) * (1.0 + 0.3 * (t / 31.0).sin()) - start
            + 0.02 * noise(t, 1.0)
    };
    let asked = |t: f64| 25.0 + 4.0 * reference(t) + 0.4 * noise(t, 2.0);
    let drive =
        |t: f64| (0.3 * (asked(t) - 20.0).max(0.0).sqrt() + 0.2 * noise(t, 3.0)).clamp(0.0, 2.0);
    let each =
        |value: &dyn Fn(f64) -> f64| -> Vec<f64> { time.iter().map(|t| value(*t)).collect() };
    let status = |t: f64| LoopStatus {
        saturated: drive(t) >= 2.0,
        out_of_reach: reference(t) > 11.2,
        sensor_fault: (610.0..625.0).contains(&t),
        adapted: controller.adapts,
        rejected: controller.adapts && (500.0..504.0).contains(&t),
        stuck: false,
        safe: false,
    };
    Trace {
        reference: each(&reference),
        output: each(&output),
        measured: each(&|t| {
            if status(t).sensor_fault {
                f64::NAN
            } else {
                output(t)
            }
        }),
        input: each(&|t| asked(t - 3.0)),
        command: each(&|t| if controller.model { asked(t) } else { f64::NAN }),
        drive: each(&drive),
        prediction: each(&|t| {
            let expected = output(t) + wrong(t) * (t / 13.0).sin();
            if controller.model { expected } else { f64::NAN }
        }),
        status: time.iter().map(|t| status(*t)).collect(),
        snapshots: if controller.adapts {
            (0..=90)
                .map(|n| snapshot(10.0 * f64::from(n), plane))
                .collect()
        } else {
            Vec::new()
        },
        time,
    }
}

/// The bump of weights moves up and grows after the load's step.
fn snapshot(time: f64, plane: &Plane) -> Snapshot {
    let learned = 1.0 - (-(time - 450.0).max(0.0) / 40.0).exp();
    let bump = |x: f64, middle: f64| (-((x - middle) / 7.0).powi(2)).exp();
    let weights = operators(plane.levels()).map(|(i, j)| {
        let shifted =
            bump(plane.level(i), 38.0 + 6.0 * learned) * bump(plane.level(j), 57.0 + 6.0 * learned);
        0.3 * (1.0 + 0.2 * learned) * shifted
    });
    Snapshot {
        time,
        offset: 1.0 - 0.4 * learned,
        weights: weights.collect(),
    }
}

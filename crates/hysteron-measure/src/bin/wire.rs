//! A simulated wire without a thermometer under control, and prints `docs/wire.md`:
//! `cargo run --release -p hysteron-measure --bin wire`

use hysteron::control::{
    Compensator, Controller, Course, Device, Disturbance, Gains, Reading, RelayTest, Scheme,
    SimulatedPlant, run,
};
use hysteron::{
    Error, Fit, FitOptions, Model, Operator, Plane, Policy, Progress, Recording, Sign, State,
    headings, operators,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Time between samples of the loop, s, and steps of the simulation in between.
const INTERVAL: f64 = 0.05;
const STEPS: usize = 10;

/// Noise of the displacement, mm.
const NOISE: f64 = 0.01;

/// A wire: duty from 0 to 1 heats it, its displacement is measured. Cooling is faster when it is hot,
/// which a first-order body does not know.
struct Wire {
    operators: Model,
    state: State,
    /// Temperature above the room of the first test, in K, and that of the room against it.
    temperature: f64,
    room: f64,
    /// The load against that of the first test, N.
    load: f64,
    duty: f64,
    rng: ChaCha8Rng,
}

impl Wire {
    fn new(seed: u64) -> Result<Self> {
        // A band of hysteresis that is wider for hotter operators, on 60 levels.
        let weight = |(i, j): (usize, usize)| {
            let width = 14.0 + 0.1 * i as f64;
            let off = ((j - i) as f64 - width) / 3.0;
            let centre = (0.5 * (i + j) as f64 - 32.0) / 12.0;
            (-off * off - centre * centre).exp()
        };
        let raw: Vec<f64> = operators(60).map(weight).collect();
        let sum: f64 = raw.iter().sum();
        let weights = raw.into_iter().map(|mu| 4.0 * mu / sum).collect();
        let plane = Plane::new(0.0, 100.0, 60)?;
        let operators = Model::new(Operator::Mkp, plane, weights, 0.0, Sign::Positive)?;
        Ok(Self {
            state: operators.off(),
            operators,
            temperature: 0.0,
            room: 0.0,
            load: 0.0,
            duty: 0.0,
            rng: ChaCha8Rng::seed_from_u64(seed),
        })
    }

    fn displacement(&mut self) -> f64 {
        // A load shifts the transformation by 4 K/N and stretches the spring by 0.1 mm/N.
        let seen = self.temperature + self.room - 4.0 * self.load;
        let step = self.operators.step(&mut self.state, seen);
        step.map_or(f64::NAN, |step| step.output - 0.1 * self.load)
    }
}

impl Device for Wire {
    fn read(&mut self) -> Reading {
        let noise = NOISE * (self.rng.random::<f64>() + self.rng.random::<f64>() - 1.0) * 2.4;
        Reading {
            output: self.displacement() + noise,
            input: None,
        }
    }

    fn write(&mut self, drive: f64) {
        self.duty = drive.clamp(0.0, 1.0);
    }
}

impl SimulatedPlant for Wire {
    fn advance(&mut self, dt_s: f64) {
        let dt = dt_s / STEPS as f64;
        for _ in 0..STEPS {
            let loss = self.temperature * (1.0 + 0.004 * self.temperature) / 3.0;
            self.temperature += dt * (60.0 * self.duty - loss);
            self.displacement();
        }
    }

    fn truth(&self) -> Reading {
        let output = self
            .operators
            .clone()
            .step(&mut self.state.clone(), self.state.input());
        let output = output.map_or(f64::NAN, |step| step.output - 0.1 * self.load);
        Reading {
            output,
            input: None,
        }
    }

    fn disturb(&mut self, disturbance: Disturbance) -> hysteron::Result<()> {
        match disturbance {
            Disturbance::Room(room) => self.room = room,
            Disturbance::Load(load) => self.load = load,
            other => return Err(Error::Plant(format!("no {other:?} here").into())),
        }
        Ok(())
    }
}

/// A recording of the wire under this duty.
fn record(duty: impl Fn(f64) -> f64, seconds: f64, seed: u64) -> Result<Recording> {
    let mut wire = Wire::new(seed)?;
    let count = (seconds / INTERVAL) as usize;
    let (mut time, mut input, mut output) = (Vec::new(), Vec::new(), Vec::new());
    for n in 0..count {
        let now = n as f64 * INTERVAL;
        // The drive of a sample was held since the one before.
        let held = duty(now - INTERVAL).clamp(0.0, 1.0);
        if n > 0 {
            wire.write(held);
            wire.advance(INTERVAL);
        }
        time.push(now);
        input.push(if n > 0 { held } else { 0.0 });
        output.push(wire.read().output);
    }
    let mut recording = Recording::new(input, output)?;
    recording.time = Some(time);
    Ok(recording)
}

fn fitted() -> Result<Model> {
    let steps = [0.9, 0.0, 0.6, 0.2, 0.75, 0.35, 0.5, 0.0];
    let stepped = |t: f64| steps[((t.max(0.0) / 15.0) as usize).min(7)];
    // Triangles that shrink.
    let ramp = |t: f64| {
        let part = (t.max(0.0) / 60.0).rem_euclid(1.0);
        (0.9 - 0.15 * (t.max(0.0) / 60.0).floor()) * (1.0 - (2.0 * part - 1.0).abs())
    };
    let recordings = [record(ramp, 300.0, 1)?, record(stepped, 120.0, 2)?];
    let options = FitOptions::default();
    Ok(Fit::from(&options).thermal(true).run(&recordings)?)
}

/// Gains by a relay test and by a step test.
fn tuned() -> Result<[(&'static str, Gains); 2]> {
    let mut wire = Wire::new(3)?;
    let mut relay = RelayTest::new((0.15, 0.55), 2.0, 4.0 * NOISE)?;
    for _ in 0..100_000 {
        wire.write(relay.command());
        wire.advance(INTERVAL);
        relay.push(wire.read().output);
        if relay.is_done() {
            break;
        }
    }
    let (gain, period) = relay
        .oscillation()
        .ok_or("the relay test did not oscillate")?;
    let mut wire = Wire::new(4)?;
    let mut output = Vec::new();
    for n in 0..2000 {
        wire.write(if n < 1000 { 0.3 } else { 0.4 });
        wire.advance(INTERVAL);
        output.push(wire.read().output);
    }
    let by_step = Gains::from_step(&output, 1000, 0.1, INTERVAL).ok_or("no step response")?;
    Ok([
        (
            "relay test",
            Gains::from_oscillation(gain, period * INTERVAL),
        ),
        ("step test", by_step),
    ])
}

fn main() -> Result<()> {
    let model = fitted()?;
    let gains = tuned()?;
    let body = model.thermal.ok_or("a body was asked for")?;
    let error = model.fit.as_ref().map_or(f64::NAN, |fit| fit.nrmse_percent);
    println!(
        "# A wire without a thermometer, under control (simulated)\n\n\
         This page is printed by `cargo run --release -p hysteron-measure --bin wire`. The wire is \
         simulated:\nduty in, displacement out, nothing else measured. Its cooling is not that of a \
         first-order body,\nand its operators lie on another plane than the model's. The model is \
         fitted to ramps and steps:\n{error:.1} % of the range, time constants {:.2} s and {:.2} s.\n\n\
         Tracking error, RMS in mm, of a stroke of 4 mm, in three thirds of the run: as fitted, in a \
         room\nthat is 8 K warmer, and with a load of 1.5 N more. Noise of the sensor {NOISE} mm.\n",
        body.tau_heating, body.tau_cooling
    );
    println!("| controller | as fitted | warmer room | more load |");
    println!("| --- | ---: | ---: | ---: |");
    let third = 1600;
    let wave = |n: usize| {
        let t = n as f64 * INTERVAL;
        2.0 + 1.3 * (0.21 * t).sin() * (0.9 + 0.1 * (0.05 * t).cos())
    };
    let reference: Vec<f64> = (0..3 * third).map(wave).collect();
    let events = [
        (third, Disturbance::Room(8.0)),
        (2 * third, Disturbance::Load(1.5)),
    ];
    let tolerance = 4.0 * NOISE;
    let ahead = headings(&reference, tolerance);
    let mut rows = vec![("drive from the model".to_owned(), true, None)];
    for (name, gains) in gains {
        rows.push((format!("PID, {name}"), false, Some(gains)));
        rows.push((format!("both, PID by {name}"), true, Some(gains)));
    }
    for (name, feedforward, pid) in rows {
        let compensator = match feedforward {
            true => Some(Compensator::fixed(&model)?),
            false => None,
        };
        let mut controller = Controller::new(Scheme {
            compensator,
            pid,
            tolerance,
            policy: Policy::Anticipate,
            ..Scheme::new(INTERVAL, (0.0, 1.0))
        })?;
        let course = Course {
            reference: &reference,
            headings: &ahead,
            events: &events,
        };
        let trace = run(&mut Wire::new(5)?, &mut controller, &course, Progress::NONE)?;
        let rms = |from: usize| {
            // Without the first quarter of each third, in which the loop settles.
            let part = from + third / 4..from + third;
            let count = part.len() as f64;
            let squares: f64 = part.map(|n| (trace.output[n] - reference[n]).powi(2)).sum();
            (squares / count).sqrt()
        };
        println!(
            "| {name} | {:.3} | {:.3} | {:.3} |",
            rms(0),
            rms(third),
            rms(2 * third)
        );
    }
    Ok(())
}

//! A control loop on a device of your own: PID, with the inverse of a model in front of it.
//!
//! The device here is *simulated*, a piezo-like actuator. In place of it, talk to your driver.
//!
//! `cargo run --release --example control -p hysteron`

use hysteron::control::{
    Compensator, Controller, Device, Gains, Reading, Reference, Scheme, SimulatedPlant,
};
use hysteron::{Fit, Recording, Result};
use hysteron_sim::plant::{PreisachPlant, PreisachPlantOptions};

/// Time between samples, s.
const INTERVAL_S: f64 = 0.01;

/// Your device: what the controller needs is one function to read it and one to write to it.
struct Stage(PreisachPlant);

impl Device for Stage {
    fn read(&mut self) -> Reading {
        // µm. No sensor measures the input: the loop takes the voltage that it wrote.
        self.0.read()
    }

    fn write(&mut self, volts: f64) {
        self.0.write(volts);
        self.0.advance(INTERVAL_S); // simulated time; a real loop waits for its next sample
    }
}

fn main() -> Result<()> {
    let new = || PreisachPlant::new(&PreisachPlantOptions::default()).map(Stage);

    // Record the device: swings that grow smaller, so that it is seen on many branches.
    let (mut stage, mut input, mut output) = (new()?, Vec::new(), Vec::new());
    for n in 0..6000 {
        let swing = 75.0 - 0.0125 * f64::from(n);
        let volts = 75.0 - swing * (0.03 * f64::from(n)).cos();
        stage.write(volts);
        input.push(volts);
        output.push(stage.read().output);
    }
    let model = Fit::new().run(&Recording::new(input, output)?)?;

    // The same loop without and with the inverse of the model.
    let gains = Gains {
        gain: 0.2,
        integral_s: 0.05,
        derivative_s: 0.0,
    };
    let pid = Scheme {
        pid: Some(gains),
        ..Scheme::new(INTERVAL_S, (0.0, 150.0)) // volts that may be written
    };
    let both = Scheme {
        compensator: Some(Compensator::fixed(&model)?),
        tolerance: 0.5, // µm: smaller reversals of the reference do not cross the dead band
        ..pid.clone()
    };
    println!("tracking error (RMSE) on a simulated actuator with 100 µm stroke:");
    for (name, scheme) in [("PID alone", pid), ("PID + inverse", both)] {
        let (mut stage, mut controller) = (new()?, Controller::new(scheme)?);
        let (mut reading, mut sum, mut count) = (stage.read(), 0.0, 0.0);
        for n in 0..2000 {
            let output = 36.0 - 24.0 * (0.03 * f64::from(n)).cos(); // where the stage should be
            let reference = Reference {
                output,
                heading: None, // where it goes next; only the policy `Anticipate` needs it
            };
            let action = controller.step(reference, reading)?;
            stage.write(action.drive);
            reading = stage.read();
            // The first 2 s belong to the start.
            if n >= 200 {
                sum += (reading.output - output).powi(2);
                count += 1.0;
            }
        }
        println!("  {name:14} {:.3} µm", f64::sqrt(sum / count));
    }
    Ok(())
}

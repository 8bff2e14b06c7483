//! The block of a controller: its settings, and what they are among the variables.

use hysteron::control::{Controller, Gains, Scheme};
use hysteron::{Error, Model, Remedy, Result, Setting};
use std::fmt::Write;

/// Refuses what the block does not have.
pub(super) fn check(model: &Model, scheme: &Scheme) -> Result<()> {
    let refused = |what: &str| Err(Error::Export(what.into()));
    if model.load.is_some() {
        let remedy = Remedy::new("export it at one load with {}", [Setting::any("load")]);
        let what = "the controller has no reading of a load";
        return Err(Error::Export(what.into()).remedied(remedy));
    }
    let without = scheme.inner.is_none() && scheme.stuck_s.is_none();
    if !without || scheme.commands != scheme.drives {
        return refused("an inner loop and readings that repeat are not to be had in the block");
    }
    if scheme.gate == Some(0.0) {
        return refused("the gate of the block has to be above zero: 0 is that there is none");
    }
    if scheme
        .delay
        .is_some_and(|delay| delay != 1 + model.delay().at(Some(scheme.interval_s)))
    {
        return refused("the delay of the block is one sample and the dead time of the model");
    }
    Controller::new(Scheme {
        compensator: None,
        ..scheme.clone()
    })?;
    Ok(())
}

/// A parameter: name, value, and what it is.
pub(super) type Parameter = (&'static str, f64, &'static str);

/// The settings as parameters, in the order of the text.
pub(super) fn parameters(scheme: &Scheme) -> [Parameter; 10] {
    let gains = scheme.pid.unwrap_or(Gains {
        gain: 0.0,
        integral_s: 0.0,
        derivative_s: 0.0,
    });
    let (low, high) = scheme.drives;
    let time = |time: Option<f64>| time.unwrap_or(0.0);
    [
        (
            "gain",
            gains.gain,
            "gain of the PID; 0 for the inverse alone",
        ),
        (
            "integral_s",
            gains.integral_s,
            "integral time in seconds; 0 for no such term",
        ),
        (
            "derivative_s",
            gains.derivative_s,
            "derivative time in seconds; 0 for no such term",
        ),
        ("drive_min", low, "lowest drive"),
        ("drive_max", high, "highest drive"),
        (
            "slew",
            time(scheme.slew),
            "fastest change of the drive per second; 0 for no limit",
        ),
        (
            "lost_s",
            time(scheme.safety.lost_s),
            "seconds without a reading until the drive is the safe one; 0 for never",
        ),
        (
            "stuck_s",
            time(scheme.safety.stuck_s),
            "the same for a reading that stands still where it has to move",
        ),
        (
            "gate",
            scheme.gate.unwrap_or(0.0),
            "a reading that deviates by less is never a spike; 0 for no gate",
        ),
        (
            "filter_s",
            scheme.filter_s,
            "time constant of a low-pass filter on the readings; 0 for none",
        ),
    ]
}

/// The line of `model.txt`.
pub(super) fn line(model: &Model, scheme: &Scheme) -> String {
    let (off, on) = model.output_range();
    let mut line = format!("control {:?} {:?}", scheme.tolerance, (on - off).abs());
    for (_, number, _) in parameters(scheme) {
        // The shortest that reads back as the same number. Writing to a text cannot fail.
        let _ = write!(line, " {number:?}");
    }
    line + "\n"
}

//! The interface between a control loop and a device, real or simulated.

/// One reading of a device's sensors. NaN for a sensor that gave nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// The controlled output, in the model's unit.
    pub output: f64,
    /// The input of the hysteresis (a temperature), if a sensor measures it. `None` if the drive
    /// itself is the input.
    pub input: Option<f64>,
}

/// A device with an actuator and sensors. At each sample the loop reads it, then writes to it.
///
/// The caller of the loop keeps the time between samples. Time in a simulated device passes with
/// [`SimulatedPlant::advance`].
pub trait Device {
    /// Reads the sensors. A lost sample is NaN and not an error, because the loop must continue.
    fn read(&mut self) -> Reading;
    /// Sets the drive (current, voltage), which is held until the next call. The loop keeps the
    /// drive within its limits.
    fn write(&mut self, drive: f64);
}

/// A simulated device. Its time passes on request, and its true state can be read.
pub trait SimulatedPlant: Device {
    /// Lets `dt_s` (s) pass with the drive held. Up to the integration error, the result does not
    /// depend on how the caller divides the time.
    fn advance(&mut self, dt_s: f64);
    /// The true output and input, without sensor errors.
    fn truth(&self) -> Reading;
    /// Changes a condition that acts on the plant.
    ///
    /// # Errors
    /// [`crate::Error::Plant`] for values that the plant's physics do not allow, and for a
    /// disturbance that the plant does not have.
    fn disturb(&mut self, disturbance: Disturbance) -> crate::error::Result<()>;
}

/// A condition that can change while a plant runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Disturbance {
    /// The load, N.
    Load(f64),
    /// The ambient temperature, °C.
    Room(f64),
    /// The pre-deformation, mm.
    Predeformation(f64),
    /// Ageing: the share of its first stroke that the actuator still has.
    Gain(f64),
    /// True: the output's sensor repeats its last reading. False: it works again.
    Stuck(bool),
    /// True: the output's sensor reads NaN. False: it works again.
    Lost(bool),
}

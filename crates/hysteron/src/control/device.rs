//! What a control loop needs of a device, real or simulated.

/// One reading of a device's sensors; NaN where a sensor gave nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// The output that is controlled, in the model's unit.
    pub output: f64,
    /// The input of the hysteresis (a temperature) where a sensor measures it. `None` where the
    /// drive itself is the input.
    pub input: Option<f64>,
}

/// A device with an actuator and sensors: once a sample the loop reads it, then writes to it.
///
/// Whoever runs the loop keeps the time between samples; a simulated device is told how long to go
/// on ([`SimulatedPlant::advance`]).
pub trait Device {
    /// Reads the sensors. A lost sample is NaN, not an error: the loop has to go on.
    fn read(&mut self) -> Reading;
    /// Sets the drive (current, voltage), which is held until the next call. The loop keeps it
    /// within the limits it was given.
    fn write(&mut self, drive: f64);
}

/// A simulated device: time passes when it is told to, and its true state can be seen.
pub trait SimulatedPlant: Device {
    /// Lets `dt_s` (s) pass with the drive held. The result does not depend on how the caller
    /// divides time, up to the error of the integration.
    fn advance(&mut self, dt_s: f64);
    /// The true output and input, without sensors.
    fn truth(&self) -> Reading;
    /// Changes what acts on the plant from outside.
    ///
    /// # Errors
    /// [`crate::Error::Rig`] for values outside the plant's physics, and for a disturbance that the
    /// plant does not know.
    fn disturb(&mut self, disturbance: Disturbance) -> crate::error::Result<()>;
}

/// What can change on a plant while it runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Disturbance {
    /// The load, N.
    Load(f64),
    /// The room's temperature, °C.
    Room(f64),
    /// The pre-deformation, mm.
    Predeformation(f64),
    /// The output's sensor stands still at its last reading, or works again.
    Stuck(bool),
    /// The output's sensor reads NaN, or works again.
    Lost(bool),
}

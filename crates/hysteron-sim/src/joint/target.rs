//! The loop around a model that an export writes.

use super::tune;
use hysteron::control::{Controller, Gains, Safety, Scheme};
use hysteron::{Error, Model, Remedy, Result, Setting};

/// What is chosen of a loop around a model: its inverse and a PID.
///
/// ```
/// use hysteron::{Model, Operator, Plane, Sign};
/// use hysteron_sim::joint::TargetLoop;
/// let plane = Plane::new(1.0, 10.0, 10)?; // from 0 to 10
/// let model = Model::new(Operator::Mkp, plane, vec![0.1; 55], 0.0, Sign::Positive)?;
/// let scheme = TargetLoop::new(0.05).scheme(&model)?;
/// assert_eq!(scheme.drives, (0.0, 10.0));
/// assert!(scheme.pid.is_some()); // from the model
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TargetLoop {
    /// The sample time, s.
    pub dt: f64,
    /// The lowest and the highest drive. By default the model's, or those of its plane.
    pub drives: Option<(f64, f64)>,
    /// The gains; by default those of [`tune`].
    pub gains: Option<Gains>,
    /// A gate against spikes, in the output's unit ([`Scheme::gate`]).
    pub gate: Option<f64>,
    /// The time constant of the filter of the readings, s; by default none.
    pub filter_s: Option<f64>,
}

impl TargetLoop {
    /// A loop with this sample time, and all else by default.
    #[must_use]
    pub fn new(dt: f64) -> Self {
        Self {
            dt,
            drives: None,
            gains: None,
            gate: None,
            filter_s: None,
        }
    }

    /// The loop around `model`. It is given up as a run is by default ([`usual_safety`]).
    ///
    /// # Errors
    /// [`Error::Control`] for settings that cannot be; [`Error::Export`] where no gains come from
    /// the model.
    pub fn scheme(&self, model: &Model) -> Result<Scheme> {
        let plane = model.plane();
        let (lost_s, stuck_s) = usual_safety(self.dt);
        let of_model = || model.drive.unwrap_or((plane.bottom(), plane.max()));
        let mut scheme = Scheme {
            tolerance: model.usual_tolerance(),
            delay: Some(1 + model.delay().at(Some(self.dt))),
            gate: self.gate,
            filter_s: self.filter_s.unwrap_or(0.0),
            safety: Safety {
                lost_s: Some(lost_s),
                stuck_s: Some(stuck_s),
            },
            ..Scheme::new(self.dt, self.drives.unwrap_or_else(of_model))
        };
        // What cannot be is told as that, and not as gains that are missing.
        Controller::new(scheme.clone())?;
        scheme.pid = Some(match self.gains {
            Some(gains) => gains,
            None => tune(model, &scheme, true).map_err(untuned)?.gains,
        });
        Ok(scheme)
    }
}

/// When a loop with this sample time, s, is given up where nothing else is said: the times
/// [`Safety::lost_s`] and [`Safety::stuck_s`], s.
///
/// ```
/// let (lost_s, _) = hysteron_sim::joint::usual_safety(1.0);
/// assert_eq!(lost_s, 5.0); // a few samples at least
/// ```
#[must_use]
pub fn usual_safety(dt: f64) -> (f64, f64) {
    let few = 5.0 * dt;
    (f64::max(0.5, few), f64::max(1.0, few))
}

fn untuned(error: Error) -> Error {
    let what = format!("no gains come from the model ({error})");
    let remedy = Remedy::new("give them with {}", [Setting::any("gains")]);
    Error::Export(what).remedied(remedy)
}

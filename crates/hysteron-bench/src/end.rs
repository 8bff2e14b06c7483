//! The ways that a run can end.

use crate::sweep::Unmoved;
use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// How a run ended. Only [`End::Done`] is a good end.
#[derive(Debug, Clone, PartialEq)]
pub enum End {
    /// The duration has passed, or the profile or the reference is at its end.
    Done,
    /// Somebody stopped it: Ctrl-C, or a signal.
    Stopped,
    /// No valid reading came for so long, s.
    Lost(f64),
    /// The output stood still where it had to move, s.
    Stuck(f64),
    /// The output did not move while a profile went there and back.
    Unmoved(Unmoved),
    /// The output was beyond its limits.
    Limit(f64),
    /// The output stayed far beyond what the model reaches, and far from what was wanted.
    Astray(f64),
    /// The device said that it has ended, and why.
    Device(String),
    /// The line to the device is gone, and how.
    Closed(String),
    /// The log cannot be written, and why.
    Log(String),
    /// The controller refused to go on, and why.
    Failed(String),
}

impl End {
    /// The exit code of the command.
    #[must_use]
    pub fn code(&self) -> u8 {
        match self {
            Self::Done => 0,
            Self::Failed(_) => 1,
            Self::Lost(_) => 3,
            Self::Stuck(_) | Self::Unmoved(_) => 4,
            Self::Limit(_) | Self::Astray(_) => 5,
            Self::Device(_) => 6,
            Self::Closed(_) => 7,
            Self::Log(_) => 8,
            Self::Stopped => 130,
        }
    }

    /// One word for it.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Stopped => "stopped",
            Self::Lost(_) => "lost",
            Self::Stuck(_) | Self::Unmoved(_) => "stuck",
            Self::Limit(_) => "limit",
            Self::Astray(_) => "astray",
            Self::Device(_) => "device",
            Self::Closed(_) => "closed",
            Self::Log(_) => "log",
            Self::Failed(_) => "failed",
        }
    }
}

impl fmt::Display for End {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.word())?;
        match self {
            Self::Done => f.write_str("all was run"),
            Self::Stopped => f.write_str("by Ctrl-C or a signal"),
            Self::Lost(time) => write!(f, "no valid reading for {time:.3} s (safety.lost_s)"),
            Self::Stuck(time) => write!(
                f,
                "the output stood still for {time:.3} s where it had to move (safety.stuck_s)"
            ),
            Self::Unmoved(found) => write!(
                f,
                "the output moved by no more than its noise, {} to {}, while the drive went through \
                 {} to {} and back, from sample {} to {}: look whether the slider moves and the \
                 sensor is connected; an actuator that is slower than the profile needs a slower \
                 one, or a longer safety.stuck_s",
                found.outputs.0,
                found.outputs.1,
                found.drives.0,
                found.drives.1,
                found.samples.0,
                found.samples.1
            ),
            Self::Limit(output) => {
                write!(f, "the output was {output}, beyond limits.output")
            }
            Self::Astray(output) => write!(
                f,
                "the output is {output}, far beyond what the model reaches and from what is wanted: \
                 the loop is unstable (take a smaller gain), drive or sensor is turned round, or the \
                 model is another's; where such outputs are right, give limits.output"
            ),
            Self::Device(why) if why == "limit" => {
                write!(
                    f,
                    "the device ended, and said `limit`: a limit of its own was reached"
                )
            }
            Self::Device(why) => write!(f, "the device ended, and said `{why}`"),
            Self::Closed(how) => write!(f, "the line to the device is gone: {how}"),
            Self::Log(why) => write!(f, "the log cannot be written: {why}"),
            Self::Failed(why) => f.write_str(why),
        }
    }
}

/// Stops a run from another thread, or from a signal.
///
/// ```
/// let stop = hysteron_bench::Stop::default();
/// stop.clone().stop();
/// assert!(stop.is_set());
/// ```
#[derive(Debug, Clone, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Lets the run end: the drive goes safe and the log is closed.
    pub fn stop(&self) {
        self.0.store(true, Ordering::SeqCst);
    }

    /// Whether somebody has stopped it.
    #[must_use]
    pub fn is_set(&self) -> bool {
        self.0.load(Ordering::SeqCst)
    }
}

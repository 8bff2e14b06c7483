//! Where a channel of a recording stood still, as a learner found it.

use crate::recording::Recording;
use hysteron_core::{Channel, Outcome};
use serde::{Serialize, Serializer};
use std::ops::Range;

/// The learner compared pieces in which the channel that moves travelled twice its range. So over this
/// many times its range before, the other one surely stood still.
const TRAVEL: f64 = 1.5;

/// A stretch of a recording over which a channel stood still while the other one moved. Nothing was
/// learned there.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Stuck {
    /// The channel that stood still.
    #[serde(serialize_with = "word")]
    pub channel: Channel,
    /// The samples, counted from 0. The first is where its readings begin to be those of the
    /// stretch; with noise it may be a few samples off.
    #[serde(flatten)]
    pub samples: Range<usize>,
}

fn word<S: Serializer>(channel: &Channel, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(match channel {
        Channel::Input => "input",
        Channel::Output => "output",
    })
}

impl Stuck {
    /// The stretches that `outcomes` tell. `fixed` is the output of the model left alone.
    pub(super) fn all(outcomes: &[Outcome], recording: &Recording, fixed: &[f64]) -> Vec<Self> {
        let mut found: Vec<Self> = Vec::new();
        let mut goes_on = false;
        for (n, outcome) in outcomes.iter().enumerate() {
            let channel = match outcome {
                Outcome::OutputStuck => Channel::Output,
                Outcome::InputStuck => Channel::Input,
                // Nothing is learned there, in whatever state the channels are.
                Outcome::AtRest | Outcome::Rejected | Outcome::Frozen => continue,
                _ => {
                    goes_on = false;
                    continue;
                }
            };
            match found.last_mut() {
                Some(last) if goes_on && last.channel == channel => last.samples.end = n + 1,
                _ => {
                    let (still, moving) = match channel {
                        Channel::Output => (&recording.output[..], fixed),
                        Channel::Input => (&recording.input[..], &recording.output[..]),
                    };
                    let samples = began(still, moving, n)..n + 1;
                    found.push(Self { channel, samples });
                }
            }
            goes_on = true;
        }
        found
    }
}

/// Where the readings begin that are like those of the last samples up to `seen`.
fn began(still: &[f64], moving: &[f64], seen: usize) -> usize {
    let (low, high) = crate::series::range(moving);
    let enough = TRAVEL * (high - low);
    let mut travel = 0.0;
    let mut first = seen;
    while first > 0 && travel < enough {
        first -= 1;
        travel += (moving[first + 1] - moving[first]).abs();
    }
    let (low, high) = crate::series::range(&still[first..=seen]);
    let margin = 0.5 * (high - low);
    let like = |y: &f64| (low - margin..=high + margin).contains(y);
    let before = still[..first].iter().rev().take_while(|y| like(y)).count();
    first - before
}

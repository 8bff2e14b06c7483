//! Where a channel of a recording stood still, as a learner found it.

use crate::model::Model;
use crate::recording::Recording;
use crate::series::frozen::{SHORTEST, are_apart, frozen};
use crate::series::lost::held;
use hysteron_core::{Channel, Outcome, Reading, Watch};
use serde::{Serialize, Serializer};
use std::ops::Range;

/// A learner needs a cycle to see that a channel stands still. So over this many times the range of
/// the other one before, it surely did.
const TRAVEL: f64 = 0.4;

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
    /// The stretches that `outcomes` tell, and where the output was `held`. `fixed` is the output of
    /// the model left alone, `tail` what [`at_the_end`] found.
    pub(super) fn all(
        outcomes: &[Outcome],
        recording: &Recording,
        fixed: &[f64],
        tail: usize,
        held: &[Range<usize>],
    ) -> Vec<Self> {
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
                    let seen = if n + tail < outcomes.len() {
                        n
                    } else {
                        outcomes.len() - 1
                    };
                    let samples = began(still, moving, seen)..n + 1;
                    found.push(Self { channel, samples });
                }
            }
            goes_on = true;
        }
        let held = held.iter().map(|run| (Channel::Output, run.clone()));
        // An input that is frozen to the last digit is one at rest to a learner.
        let frozen = frozen(&recording.input, &recording.output).into_iter();
        let frozen = frozen.map(|run| (Channel::Input, run));
        for (channel, samples) in held.chain(frozen) {
            if found.iter().all(|one| are_apart(&one.samples, &samples)) {
                found.push(Self { channel, samples });
            }
        }
        found.sort_by_key(|one| one.samples.start);
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

/// The stretches over which the output was held while the model left alone moved to `fixed`, or was
/// still while the input moved far, and came back; ascending, apart from each other.
pub(super) fn held_outputs(recording: &Recording, fixed: &[f64]) -> Vec<Range<usize>> {
    let mut found = frozen(&recording.output, &recording.input);
    for run in held(&recording.output, Some(fixed)) {
        if run.len() >= SHORTEST && found.iter().all(|one| are_apart(one, &run)) {
            found.push(run);
        }
    }
    // One that lasts to the end is seen by what learns, which then goes back to before it.
    found.retain(|run| run.end + SHORTEST <= recording.len());
    found.sort_by_key(|run| run.start);
    found
}

/// How many samples at the end of the recordings have an output that seems to stand still, though a
/// learner cannot see it yet, for want of a whole cycle. `fixed` is the output of the model left
/// alone.
pub(super) fn at_the_end(model: &Model, recordings: &[Recording], fixed: &[f64]) -> usize {
    let Some(recording) = recordings.last() else {
        return 0;
    };
    let plane = model.plane();
    let (off, on) = model.output_range();
    let mut watch = Watch::new((on - off).abs(), plane.levels() as f64);
    let fixed = &fixed[fixed.len() - recording.len()..];
    let samples = recording.input.iter().zip(&recording.output).zip(fixed);
    for ((&input, &measured), &expected) in samples {
        let position = plane.normalise(input);
        watch.look(
            Reading {
                position,
                expected,
                measured,
            },
            true,
        );
    }
    if watch.stuck().is_some() || recording.len() < 2 {
        return 0;
    }
    // Noise may begin the run anew after the freeze: its readings tell where that was.
    let first = || began(&recording.output, fixed, recording.len() - 1);
    let still = |count: u32| (count as usize).max(recording.len() - first());
    watch.still_at_the_end().map_or(0, still)
}

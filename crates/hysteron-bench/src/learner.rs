//! A learner that takes long now and then, beside the loop: a sample never waits for it.

use hysteron::{Adaptive, Model, Outcome, Sample};
use std::io;
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, channel, sync_channel};
use std::thread;

/// Samples that may wait for the learner. Minutes of a fast loop.
const WAITING: usize = 1 << 16;

/// A learner in a thread of its own. It sees every sample, late if need be, and what it has learned
/// is taken when it is ready.
pub(crate) struct Beside {
    samples: Option<SyncSender<(Sample, Option<f64>)>>,
    models: Receiver<Model>,
}

impl Beside {
    pub(crate) fn start(mut adaptive: Adaptive) -> io::Result<Self> {
        let (samples, coming) = sync_channel::<(Sample, Option<f64>)>(WAITING);
        let (learned, models) = channel();
        thread::Builder::new()
            .name("learner".into())
            .spawn(move || {
                let mut weights = adaptive.weights();
                for (sample, measured) in coming {
                    let outcome = match measured {
                        Some(measured) => {
                            adaptive.step(sample, measured).map(|found| found.outcome)
                        }
                        None => adaptive.simulate(sample).map(|_| Outcome::Waiting),
                    };
                    // A sample that it refuses teaches nothing.
                    if outcome.is_err() {
                        continue;
                    }
                    let now = adaptive.weights();
                    if now != weights {
                        weights = now;
                        let Ok(model) = adaptive.model() else {
                            continue;
                        };
                        if learned.send(model).is_err() {
                            return;
                        }
                    }
                }
            })?;
        Ok(Self {
            samples: Some(samples),
            models,
        })
    }

    /// Hands a sample on. A learner that has fallen too far behind gets no more: with a gap it
    /// would not know where the actuator is.
    pub(crate) fn push(&mut self, sample: Sample, measured: Option<f64>) {
        if let Some(samples) = &self.samples
            && let Err(TrySendError::Full(_)) = samples.try_send((sample, measured))
        {
            self.samples = None;
        }
    }

    /// The newest model, if there is one that was not taken.
    pub(crate) fn take(&self) -> Option<Model> {
        self.models.try_iter().last()
    }
}

//! Judges a filter on a recording like the one at hand, whose truth is known.
//!
//! A model that is fitted to filtered readings errs less on filtered readings, also where the filter
//! took the tips from the loops; so readings with noise cannot judge it. Here the input between
//! reversals that are larger than the noise, and what a model answers to it, are taken for the
//! truth. White noise of the size found is put on both. A filter is kept only if it brings a model
//! of these readings clearly closer to that truth (a parametric bootstrap: Efron 1979).

use super::band;
use super::change::Change;
use super::judge::{Judge, Judged, apart, from_kept, mean, small, with_its_load};
use crate::identify::Fit;
use crate::recording::Recording;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

/// A filter gains at least this share of the error: another draw of the noise changes it by less.
const WORTH: f64 = 0.05;
/// The draw of the noise.
const SEED: u64 = 1;

pub(super) struct Alike {
    truth: Recording,
    /// The truth with noise, after the filters that were kept.
    noisy: Recording,
    /// The error of a model of these.
    error: Option<f64>,
}

impl Alike {
    /// A recording like `work`, with noise of the deviations `sigma` on input and output; `None` if
    /// no model can be fitted.
    pub(super) fn new(work: &Recording, sigma: [f64; 2]) -> Option<Self> {
        let mut truth = with_its_load(work).into_owned();
        band::settle(&mut truth.input, band::reach(work.len(), sigma[0]));
        truth.output = from_kept(&truth, &|_| true)?;
        let mut noisy = truth.clone();
        let mut rng = ChaCha8Rng::seed_from_u64(SEED);
        for (values, sigma) in [&mut noisy.input, &mut noisy.output].into_iter().zip(sigma) {
            for value in values {
                let noise: f64 = StandardNormal.sample(&mut rng);
                *value += sigma * noise;
            }
        }
        let mut alike = Self {
            truth,
            noisy,
            error: None,
        };
        alike.error = alike.error();
        Some(alike)
    }

    /// The recording with noise, to which a filter is applied.
    pub(super) fn noisy(&self) -> &Recording {
        &self.noisy
    }

    /// Takes the `change` of `work` if that of the recording with noise, `alike`, helps.
    pub(super) fn offer(
        &mut self,
        step: &'static str,
        work: &mut Recording,
        (mut change, mut alike): (Change, Change),
        judge: &mut Judge<'_>,
    ) -> bool {
        let samples = change.samples(work).len();
        alike.swap(&mut self.noisy);
        let (before, after) = (self.error, self.error());
        let kept = after
            .zip(before)
            .is_some_and(|(after, before)| after < (1.0 - WORTH) * before);
        judge.judged.push(Judged {
            step,
            samples,
            before,
            after,
            kept,
        });
        if kept {
            self.error = after;
            judge.take(work, &mut change);
        } else {
            alike.swap(&mut self.noisy);
        }
        kept
    }

    /// How far a model of the recording with noise is from the truth, as root of the mean square;
    /// `None` if none can be fitted.
    fn error(&self) -> Option<f64> {
        let model = Fit::from(small()).run(&self.noisy).ok()?;
        let (output, _) = model.run_over(&mut model.start(), &self.truth).ok()?;
        let squares = apart(&output, &self.truth.output).map(|off| off * off);
        Some(mean(squares).sqrt())
    }
}

//! Warnings about a fit: signs in the data that the model may not be what the user expects.

use crate::error::{Place, Result};
use crate::identify::{AGAINST_INPUT, MANY_OPEN, way_against_input};
use crate::model::{Model, Outlier, Solver, Start, Surroundings};
use crate::prepare::mended::{replaced, settles};
use crate::recording::{Quantity, Recording, named};
use crate::remedy::{Remedy, Setting, counted};
use crate::rivals::wins;
use crate::series::noise::noise;
use crate::series::{branch_spans, range, usual_tolerance};
use std::fmt;

/// A warning about a fit. [`Advice::remedy`] suggests what may help.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Advice {
    /// A simple predictor is better than the model on what was left out.
    RivalWins {
        /// Its name.
        name: String,
        /// Its error on what was left out, in percent of the measured range.
        rival: f64,
        /// The error of the model there.
        model: f64,
    },
    /// Inputs outside the plane's active range were clipped to its ends.
    Clipped {
        /// Number of inputs outside.
        inputs: usize,
        /// Number of inputs in all.
        samples: usize,
        /// Lowest and highest input of the active range.
        range: (f64, f64),
    },
    /// The output moves against its input. Non-negative weights cannot follow that.
    AgainstInput {
        /// The share of the output's path on which it does so, from 0 to 1.
        part: f64,
    },
    /// The input has far more reversals than are larger than its noise. The others count as memory
    /// of the material.
    FalseReversals {
        /// Number of all reversals.
        all: usize,
        /// Number of reversals that are larger than the noise.
        real: usize,
        /// Standard deviation of the input's noise, in its unit.
        noise: f64,
        /// Whether [`crate::prepare`] would remove them.
        removed: bool,
    },
    /// Readings stand out from their neighbours, or were held while the series moved on. Those of
    /// the output that the fit found as outliers are not among them.
    Spikes {
        /// Name of the series.
        series: String,
        /// Number of these readings.
        samples: usize,
        /// The first of them, counted from 1 in its recording.
        first: usize,
        /// Where that stands in its file, if rows count otherwise there.
        place: Option<Place>,
        /// Number of these readings that [`crate::prepare`] would replace.
        replaced: usize,
    },
    /// There are hardly more samples than operators: most weights follow from the prior.
    FewData {
        /// Number of samples.
        samples: usize,
        /// Number of operators.
        operators: usize,
        /// Number of combinations of weights that the data determine; `None` without confidence.
        rank: Option<usize>,
    },
    /// No dead time, ring, lag or body was looked for, because more than the end of a
    /// recording was held out.
    NoDynamics,
    /// The first input does not determine the state of some operators, and all of these were taken
    /// as off.
    OpenStart {
        /// Number of these operators.
        operators: usize,
    },
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Clipped {
                inputs,
                samples,
                range: (low, high),
            } => write!(
                f,
                "{inputs} of {samples} inputs lie outside the active range {} to {} and were \
                 clipped to its ends",
                Quantity::default().text(*low),
                Quantity::default().text(*high)
            ),
            Self::AgainstInput { part } if *part > 0.5 => write!(
                f,
                "on {:.0} % of its path the output moves against the sign of the model",
                100.0 * part
            ),
            Self::AgainstInput { part } => write!(
                f,
                "on {:.0} % of its path the output moves against the input, which non-negative \
                 weights cannot follow",
                100.0 * part
            ),
            Self::RivalWins { name, rival, model } => write!(
                f,
                "on what was left out, {name} errs {rival:.2} % of the range and the model \
                 {model:.2} %: the data do not determine the model, or it cannot follow them"
            ),
            Self::FalseReversals {
                all,
                real,
                noise,
                removed,
            } => write!(
                f,
                "the input reverses {all} times, but only {real} times by more than its noise of \
                 {noise:.3}{}",
                if *removed {
                    ": the others bend the model"
                } else {
                    ""
                }
            ),
            Self::Spikes {
                series,
                samples,
                first,
                place,
                replaced,
            } => write!(
                f,
                "{} of {series} out of line with neighbours or held, the first is {}{}",
                counted(*samples, "reading"),
                named(*first, *place),
                // What a model is no better without may be right.
                match replaced {
                    0 => "",
                    _ => ": this bends the model",
                }
            ),
            Self::FewData {
                samples,
                operators,
                rank,
            } => {
                write!(f, "{samples} samples for {operators} weights")?;
                if let Some(rank) = rank {
                    write!(f, ": the data determine {rank} combinations of them")?;
                }
                write!(
                    f,
                    ". All else comes from the smoothness that is assumed, however small the error \
                     of the fit is"
                )
            }
            Self::NoDynamics => f.write_str(
                "no dead time, ring, lag or body was looked for: they need every sample \
                 before a row, and more than the end was held out",
            ),
            Self::OpenStart { operators } => write!(
                f,
                "the recording does not begin at its lowest input, so {operators} operators could \
                 be on or off there: they are taken as off"
            ),
        }
    }
}

impl Advice {
    /// Whether it warns of readings that [`crate::prepare`] judges, and replaces where that helps.
    #[must_use]
    pub fn is_judged_by_preparation(&self) -> bool {
        matches!(self, Self::Spikes { .. } | Self::FalseReversals { .. })
    }

    /// Whether [`crate::prepare`] would replace such readings.
    #[must_use]
    pub fn is_cured_by_preparation(&self) -> bool {
        matches!(
            self,
            Self::Spikes { replaced: 1.., .. } | Self::FalseReversals { removed: true, .. }
        )
    }

    /// What may help.
    #[must_use]
    pub fn remedy(&self) -> Remedy {
        match self {
            Self::Clipped { .. } => Remedy::new("widen {}", [Setting::any("range")]),
            Self::AgainstInput { part } if *part > 0.5 => Remedy::new(
                "look whether the output moves at all, and with this input; if {} was set, leave it out",
                [Setting::any("sign")],
            ),
            Self::AgainstInput { .. } => Remedy::new(
                "use {} for an output that comes late, {} for a drive that heats, {} for several \
                 loads, {} for a butterfly loop",
                [
                    Setting::word("lag", "auto"),
                    Setting::any("thermal"),
                    Setting::any("load"),
                    Setting::word("solver", "ols"),
                ],
            ),
            Self::FalseReversals { removed: true, .. } => {
                Remedy::new("use {}, which removes them", [Setting::on("prepare")])
            }
            Self::FalseReversals { .. } => Remedy::new(
                "record with less noise, or average the readings: preparation does not remove \
                 these reversals",
                [],
            ),
            Self::Spikes {
                samples, replaced, ..
            } => remedy_of_readings(*samples, *replaced),
            Self::RivalWins { .. } | Self::FewData { .. } => Remedy::new(
                "record more branches, and test the model on another recording",
                [],
            ),
            Self::NoDynamics => Remedy::new(
                "hold out rows at the end or another recording with {}, or turn the search off with {}",
                [Setting::any("hold-out"), Setting::word("dynamics", "off")],
            ),
            Self::OpenStart { .. } => Remedy::new(
                "if the recording does not begin after the lowest input, use {}",
                [Setting::word("start", "unknown")],
            ),
        }
    }
}

/// The warnings for a `model` that was fitted to `recordings`.
///
/// # Errors
/// [`crate::Error::Thermal`] for recordings without time if the model has a thermal body.
pub fn advice(model: &Model, recordings: &[Recording]) -> Result<Vec<Advice>> {
    let plane = model.plane();
    let (mut inputs, mut samples, mut against) = (0, 0, 0.0_f64);
    let wrong: Vec<_> = recordings.iter().map(Recording::wrong_readings).collect();
    for (recording, wrong) in recordings.iter().zip(&wrong) {
        let recording = &*model.rested(recording)?;
        let seen = model.behind_body(recording)?;
        let positions = match &model.load {
            // The load moves the axis under the plane.
            Some(_) => {
                let around = Surroundings::from_recording(model, recording);
                model.seen(&recording.input, around)?
            }
            None => (&seen.input).into(),
        };
        let outside = positions.iter().filter(|x| plane.clipped(**x).is_some());
        inputs += outside.count();
        samples += seen.len();
        // A load that changes moves the output by itself, and so does what comes late: the test
        // says nothing then. Nor does a wrong reading.
        let comes_late = model.without_body().is_timed() || !model.delay().is_none();
        if model.load.is_none() && !comes_late {
            let is_right = |n: usize| wrong.iter().all(|found| found.binary_search(&n).is_err());
            if let Some(right) = seen.only(is_right) {
                against = against.max(way_against_input(&right, model.sign())?);
            }
        }
    }
    let mut advice = Vec::new();
    if inputs > 0 {
        advice.push(Advice::Clipped {
            inputs,
            samples,
            range: match model.load {
                Some(_) => model.active_range(),
                None => (plane.bottom(), plane.max()),
            },
        });
    }
    let noisy = recordings.iter().find_map(false_reversals);
    let fit = model.fit.as_ref();
    let outliers = fit.map_or(&[][..], |fit| &fit.outliers);
    advice.extend(spikes(recordings, wrong, outliers));
    if let Some(fit) = &model.fit {
        if let Some(noisy) = noisy {
            advice.push(noisy);
        } else if fit.solver == Solver::Nnls && against > AGAINST_INPUT {
            advice.push(Advice::AgainstInput { part: against });
        }
        if let Some(found) = &fit.validation {
            let better = found.rivals.iter();
            let better = better.filter(|rival| wins(rival.nrmse_percent, found.nrmse_percent));
            advice.extend(better.map(|rival| Advice::RivalWins {
                name: rival.name.clone(),
                rival: rival.nrmse_percent,
                model: found.nrmse_percent,
            }));
        }
        // Where whole branches were left out, the error on them tells.
        let tested = fit
            .validation
            .as_ref()
            .is_some_and(|found| found.whole_branches);
        if fit.samples <= plane.operators() && !tested {
            advice.push(Advice::FewData {
                samples: fit.samples,
                operators: plane.operators(),
                rank: fit.confidence.as_ref().map(|found| found.rank),
            });
        }
        let operators = fit.open_at_start;
        if fit.start == Start::Off && operators as f64 > MANY_OPEN * plane.operators() as f64 {
            advice.push(Advice::OpenStart { operators });
        }
    }
    Ok(advice)
}

/// The warnings for recordings to which nothing was fitted: readings that stand out or were held,
/// and reversals that are noise.
///
/// ```
/// use hysteron::{Recording, advice_before_fit};
/// let mut output: Vec<f64> = (0..200).map(|n| (f64::from(n) * 0.1).sin()).collect();
/// let input = output.clone();
/// output[70] += 5.0;
/// let found = advice_before_fit(&[Recording::new(input, output)?]);
/// assert!(found[0].to_string().contains("the first is sample 71"));
/// # Ok::<(), hysteron::Error>(())
/// ```
#[must_use]
pub fn advice_before_fit(recordings: &[Recording]) -> Vec<Advice> {
    let noisy = recordings.iter().find_map(false_reversals);
    let wrong = recordings.iter().map(Recording::wrong_readings);
    spikes(recordings, wrong.collect(), &[])
        .chain(noisy)
        .collect()
}

/// What to do about wrong readings, of which the preparation would replace some.
pub(crate) fn remedy_of_readings(samples: usize, replaced: usize) -> Remedy {
    let prepare = [Setting::on("prepare")];
    match replaced {
        0 => Remedy::new(
            "look at them in the file, and mend or remove there what is wrong: preparation leaves \
             them, as a model without them predicts the others no better",
            [],
        ),
        all if all >= samples => Remedy::new("use {}, which replaces them", prepare),
        some => Remedy::new(
            format!("use {{}}, which replaces {some} of them, and look at the others in the file"),
            prepare,
        ),
    }
}

/// The `wrong` readings of each series of each recording, but for `outliers`.
fn spikes(
    recordings: &[Recording],
    wrong: Vec<[Vec<usize>; 2]>,
    outliers: &[Outlier],
) -> impl Iterator<Item = Advice> {
    let each = recordings.iter().zip(wrong).enumerate();
    each.flat_map(|(number, (recording, [input, mut output]))| {
        let is_outlier = |sample| {
            let mut outliers = outliers.iter();
            outliers.any(|outlier| (outlier.recording, outlier.sample) == (number, sample))
        };
        output.retain(|sample| !is_outlier(*sample));
        let replaced = match input.is_empty() && output.is_empty() {
            true => Default::default(),
            false => replaced(recording),
        };
        let of = |found: Vec<usize>, replaced: &[usize], quantity: &Quantity| {
            let is_replaced = |sample: &&usize| replaced.binary_search(sample).is_ok();
            found.first().map(|first| Advice::Spikes {
                series: quantity.name.clone(),
                samples: found.len(),
                first: first + 1,
                place: recording.place(*first),
                replaced: found.iter().filter(is_replaced).count(),
            })
        };
        let both = [
            of(input, &replaced[0], &recording.input_quantity),
            of(output, &replaced[1], &recording.output_quantity),
        ];
        both.into_iter().flatten()
    })
}

/// So many times more reversals than real ones are noise, from this number of them on.
const FALSE: usize = 4;
const SOME: usize = 50;
/// What jumps by more than this share of its range from sample to sample is no noise of a sensor.
const MOST_NOISE: f64 = 0.1;

fn false_reversals(recording: &Recording) -> Option<Advice> {
    let input = &recording.input;
    let all = branch_spans(input, 0.0).count();
    if all < SOME {
        return None;
    }
    let noise = noise(input);
    let (low, high) = range(input);
    if noise > MOST_NOISE * (high - low) {
        return None;
    }
    // Gaussian noise hardly ever reverses by more than six deviations.
    let tolerance = usual_tolerance(input).max(6.0 * noise);
    let real = branch_spans(input, tolerance).count();
    (all > FALSE * real && noise > 0.0).then(|| Advice::FalseReversals {
        all,
        real,
        noise,
        removed: settles(recording),
    })
}

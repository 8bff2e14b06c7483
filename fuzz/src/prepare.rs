//! Preparation of any recording, with any steps: a recording that is whole, or words.

use crate::given::Number;
use crate::worded;
use arbitrary::Arbitrary;
use hysteron::{PrepareOptions, Progress, Recording, Step, prepare};

/// So that an execution stays short.
const MOST: usize = 300;

#[derive(Arbitrary, Debug)]
pub struct Asked {
    samples: u16,
    /// Readings that are put in the place of those of a clean loop.
    input: Vec<(u16, Number)>,
    output: Vec<(u16, Number)>,
    time: Option<Vec<Number>>,
    spikes: Wanted,
    resample: Wanted,
    low_pass: Wanted,
    lag: Option<Number>,
    dead_band: Wanted,
}

#[derive(Arbitrary, Debug, Clone, Copy)]
enum Wanted {
    Auto,
    Off,
    Value(Number),
}

impl From<Wanted> for Step {
    fn from(wanted: Wanted) -> Self {
        match wanted {
            Wanted::Auto => Self::Auto,
            Wanted::Off => Self::Off,
            Wanted::Value(number) => Self::Value(number.get()),
        }
    }
}

impl Asked {
    pub fn check(&self) {
        let count = 3 + usize::from(self.samples) % MOST;
        let series = |phase: f64, faults: &[(u16, Number)]| {
            let clean = (0..count).map(|n| 20.0 * (0.1 * n as f64 - phase).sin());
            let mut series: Vec<f64> = clean.collect();
            for (at, number) in faults {
                series[usize::from(*at) % count] = number.get();
            }
            series
        };
        let (input, output) = (series(0.0, &self.input), series(0.4, &self.output));
        let Ok(mut recording) = Recording::new(input, output) else {
            return;
        };
        recording.time = self.time.as_ref().map(|steps| {
            let mut now = 0.0;
            let steps = steps.iter().map(|step| step.get().abs());
            let steps = steps.chain(std::iter::repeat(1.0)).take(count);
            steps.map(|step| (now, now += step).0).collect()
        });
        // A lag is not estimated: that is forty fits.
        let lag = self.lag.map_or(Step::Off, |lag| Step::Value(lag.get()));
        let options = PrepareOptions {
            spikes: self.spikes.into(),
            resample: self.resample.into(),
            low_pass: self.low_pass.into(),
            lag,
            dead_band: self.dead_band.into(),
            ..PrepareOptions::default()
        };
        match prepare(&recording, &options, Progress::NONE) {
            Err(error) => worded(&error),
            Ok((prepared, report)) => {
                assert_eq!(prepared.input.len(), prepared.output.len());
                assert_eq!(report.samples, prepared.input.len());
                let mut all = prepared.input.iter().chain(&prepared.output);
                assert!(all.all(|value| value.is_finite()), "{options:?}");
                let time = prepared.time.unwrap_or_default();
                assert!(time.is_sorted(), "{options:?}");
            }
        }
    }
}

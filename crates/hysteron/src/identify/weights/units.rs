//! Units of samples: what is left out of a fit, or drawn for a replicate, as a whole.

use crate::identify::weights::experiment::Experiment;
use crate::series::Runs;

/// The unit of each sample. A unit is a branch, or a part of one.
pub(crate) struct Units {
    /// `None` for samples that do not count.
    of: Runs<Option<usize>>,
    /// Number of units.
    pub(crate) count: usize,
    /// Whether each is a whole branch.
    pub(crate) whole_branches: bool,
}

impl Units {
    /// The units of the samples that are kept. They are branches. With fewer than `enough` branches
    /// they are parts of them, and there are at least twice as many units.
    pub(crate) fn new(experiment: &Experiment<'_>, kept: Option<&[f64]>, enough: usize) -> Self {
        let is_kept = |n: usize| kept.is_none_or(|kept| kept[n] != 0.0);
        let (mut of, mut count) = (Runs::default(), 0);
        for branch in &experiment.branches {
            for n in branch.clone() {
                of.push(is_kept(n).then_some(count));
            }
            count += usize::from(branch.clone().any(is_kept));
        }
        let whole = Self {
            of,
            count,
            whole_branches: true,
        };
        match count >= enough {
            true => whole,
            false => whole.divided(&experiment.input, (2 * enough).div_ceil(count.max(1))),
        }
    }

    /// Each unit in so many parts. They divide the path of the input, not the number of samples,
    /// because the input may rest.
    fn divided(mut self, input: &[f64], parts: usize) -> Self {
        let step = |n: usize| match n > 0 && self.unit(n - 1) == self.unit(n) {
            true => (input[n] - input[n - 1]).abs(),
            false => 0.0,
        };
        let mut path = vec![0.0; self.count];
        for (n, unit) in self.of.values().enumerate() {
            if let Some(unit) = unit {
                path[unit] += step(n);
            }
        }
        let mut travelled = vec![0.0; self.count];
        let part_of = |(n, unit): (usize, Option<usize>)| {
            let unit = unit?;
            travelled[unit] += step(n);
            let part = parts as f64 * travelled[unit] / path[unit].max(f64::MIN_POSITIVE);
            Some(unit * parts + (part as usize).min(parts - 1))
        };
        self.of = self.of.values().enumerate().map(part_of).collect();
        self.count *= parts;
        self.whole_branches = false;
        self
    }

    /// The unit of a sample; `None` if the sample does not count.
    pub(crate) fn unit(&self, sample: usize) -> Option<usize> {
        self.of.at(sample)
    }
}

/// What is left out together: every so many units.
pub(crate) struct Folds {
    pub(crate) units: Units,
    pub(crate) count: usize,
}

impl Folds {
    /// At most so many folds.
    pub(crate) fn new(units: Units, most: usize) -> Self {
        let count = units.count.min(most);
        Self { units, count }
    }

    /// The fold that leaves a sample out; `None` if the sample does not count.
    pub(crate) fn fold(&self, sample: usize) -> Option<usize> {
        self.units.unit(sample).map(|unit| unit % self.count)
    }
}

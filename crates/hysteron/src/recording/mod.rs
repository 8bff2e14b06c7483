//! Recordings: the input and the output of one experiment, with time and load if they are known.
//!
//! This file defines [`Recording`] and the [`Quantity`] of each series. `gaps` finds gaps in the
//! time. `split` parts a recording into what is fitted and what is held out. `joined` puts several
//! one after the other, to be shown. `positions` keeps where rows stand in a file, and `rows` names
//! them. `speed` tells whether all was recorded at one. `units` knows what units measure.

mod gaps;
mod joined;
mod positions;
mod rows;
mod speed;
mod split;
mod units;

#[cfg(feature = "data")]
pub(crate) use gaps::long_gaps;
pub(crate) use gaps::{GAP, gaps, turned_in_gaps};
pub(crate) use joined::no_recordings;
pub use joined::one_after_the_other;
pub(crate) use positions::Positions;
#[cfg(feature = "data")]
pub(crate) use positions::RUN;
pub use rows::Rows;
pub(crate) use rows::named;
pub(crate) use speed::{ONE, one_speed};
pub use split::{HoldOut, Split};
pub(crate) use split::{split_each, split_ends};
pub(crate) use units::Measures;

use crate::error::{Error, Place, Result};
use crate::series::lost::wrong_of_both;
use crate::series::range;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A physical quantity: its name and, if known, its unit.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Quantity {
    /// Name, for example `temperature`.
    pub name: String,
    /// Unit, for example `degC`; `None` if it is not known.
    pub unit: Option<String>,
}

impl Quantity {
    /// A quantity without a unit.
    #[must_use]
    pub fn named(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            unit: None,
        }
    }

    /// A quantity with its unit.
    #[must_use]
    pub fn with_unit(name: &str, unit: &str) -> Self {
        Self {
            name: name.to_owned(),
            unit: Some(unit.to_owned()),
        }
    }

    /// The column name that [`Quantity::from_column`] reads as this quantity.
    #[must_use]
    pub fn to_column(&self) -> String {
        match &self.unit {
            Some(unit) => format!("{} [{unit}]", self.name),
            None => self.name.clone(),
        }
    }

    /// A value with four significant digits and the unit, if that is known.
    ///
    /// ```
    /// use hysteron::Quantity;
    /// assert_eq!(Quantity::with_unit("lift", "mm").text(0.066774), "0.06677 mm");
    /// assert_eq!(Quantity::named("force").text(120_000.0), "120000");
    /// ```
    #[must_use]
    pub fn text(&self, value: f64) -> String {
        let digits = match value == 0.0 || !value.is_finite() {
            true => 0,
            false => 3 - value.abs().log10().floor() as i32,
        };
        let number = match digits {
            -2..=8 => format!("{value:.*}", digits.max(0) as usize),
            _ => format!("{value:.3e}"),
        };
        match &self.unit {
            Some(unit) => format!("{number} {unit}"),
            None => number,
        }
    }

    /// Reads `temperature [degC]` and `temperature (degC)` as a name and its unit.
    ///
    /// ```
    /// use hysteron::Quantity;
    /// let column = Quantity::from_column("lift [mm]");
    /// assert_eq!((column.name.as_str(), column.unit.as_deref()), ("lift", Some("mm")));
    /// assert_eq!(Quantity::from_column("voltage_V"), Quantity::named("voltage_V"));
    /// ```
    #[must_use]
    pub fn from_column(column: &str) -> Self {
        let column = column.trim();
        for (open, close) in [('[', ']'), ('(', ')')] {
            if let Some((name, unit)) = column.strip_suffix(close).and_then(|c| c.split_once(open))
                && !name.trim().is_empty()
                && !unit.trim().is_empty()
            {
                return Self::with_unit(name.trim(), unit.trim());
            }
        }
        Self::named(column)
    }
}

/// Where a recording comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// Read from a file.
    Measured,
    /// Produced by a simulated plant. Every surface must show this.
    Simulated,
}

/// The file that a recording was read from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Source {
    /// Its path, as given by the caller.
    pub path: PathBuf,
    /// SHA-256 of its bytes, in hexadecimal.
    pub sha256: String,
    /// Where its samples stand in it, unless they count as its rows do, or are none of them any
    /// more.
    pub(crate) places: Option<Positions>,
}

impl Source {
    /// A file of which all rows are samples.
    #[must_use]
    pub fn new(path: PathBuf, sha256: String) -> Self {
        Self {
            path,
            sha256,
            places: None,
        }
    }
}

/// Largest absolute value that is accepted. A sum of squares of larger values could overflow.
pub(crate) const LARGEST: f64 = 1e140;

/// The input and the output of an experiment, sample by sample.
///
/// All samples are finite. All series have the same length, at least one.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// Time of each sample in seconds, never decreasing; `None` if the source has no time.
    pub time: Option<Vec<f64>>,
    /// Input samples.
    pub input: Vec<f64>,
    /// Output samples, as many as `input`.
    pub output: Vec<f64>,
    /// Name and unit of the input.
    pub input_quantity: Quantity,
    /// Name and unit of the output.
    pub output_quantity: Quantity,
    /// The load (or stress) at each sample, as many as `input`, if it was recorded.
    pub load: Option<Vec<f64>>,
    /// Name and unit of the load; without meaning if there is no load.
    pub load_quantity: Quantity,
    /// Whether the data are measured or simulated.
    pub origin: Origin,
    /// The file that it was read from, if any.
    pub source: Option<Source>,
    /// The lag of the input's sensor that was undone in it.
    pub undone: Option<UndoneLag>,
    /// The input long before the first sample, if it was another one: see [`crate::Surroundings`].
    pub rest: Option<f64>,
}

/// A lag of the input's sensor that was undone ([`crate::prepare()`]).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct UndoneLag {
    /// Its time constant, s.
    pub tau: f64,
    /// Whether it was estimated from the recording, and not given.
    pub estimated: bool,
}

/// Lets one recording be passed where a slice of recordings is expected.
impl AsRef<[Recording]> for Recording {
    fn as_ref(&self) -> &[Recording] {
        std::slice::from_ref(self)
    }
}

impl Recording {
    /// A recording of two series of the same length, without time or load.
    ///
    /// # Errors
    /// [`Error::Recording`] where the lengths differ, there is no sample, or one is not finite.
    pub fn new(input: Vec<f64>, output: Vec<f64>) -> Result<Self> {
        let recording = Self {
            time: None,
            input,
            output,
            input_quantity: Quantity::named("input"),
            output_quantity: Quantity::named("output"),
            load: None,
            load_quantity: Quantity::named("load"),
            origin: Origin::Measured,
            source: None,
            undone: None,
            rest: None,
        };
        recording.check()?;
        Ok(recording)
    }

    /// Whether both have the same inputs and outputs: one and the same recording, or a copy.
    pub(crate) fn has_samples_of(&self, other: &Self) -> bool {
        self.input == other.input && self.output == other.output
    }

    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.input.len()
    }

    /// Whether there are no samples. Never true for a recording made by this crate.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.input.is_empty()
    }

    /// Where in its file a sample stands, counted from 0: a line of text counts from the first line
    /// of the file, so with its header. `None` where samples count as the rows of a binary file do:
    /// no row was left out, and the file is one recording; and where samples are no rows any more.
    #[must_use]
    pub fn place(&self, sample: usize) -> Option<Place> {
        let places = self.source.as_ref()?.places.as_ref()?;
        places.of_sample(sample, self.len())
    }

    /// Smallest and largest input, and smallest and largest output.
    #[must_use]
    pub fn ranges(&self) -> ((f64, f64), (f64, f64)) {
        (range(&self.input), range(&self.output))
    }

    /// The samples whose input stands out from its neighbours or was held, and those whose output
    /// does, ascending.
    pub(crate) fn wrong_readings(&self) -> [Vec<usize>; 2] {
        wrong_of_both(&self.input, &self.output)
    }

    /// Checks the samples. Every function of this crate that takes a recording makes this check.
    ///
    /// # Errors
    /// [`Error::Recording`] where series differ in length, there is no sample, one is not finite,
    /// or time goes back.
    pub fn check(&self) -> Result<()> {
        let fault = |column: &str, problem: String| Error::Recording {
            path: self.source.as_ref().map(|source| source.path.clone()),
            row: None,
            column: Some(column.to_owned()),
            problem,
        };
        let time = self.time.as_ref().map(|time| (time, "time"));
        let series = [
            (&self.input, self.input_quantity.name.as_str()),
            (&self.output, self.output_quantity.name.as_str()),
        ];
        let load = self.load.as_ref();
        let load = load.map(|load| (load, self.load_quantity.name.as_str()));
        for (values, name) in series.into_iter().chain(time).chain(load) {
            if values.len() != self.input.len() {
                let problem = format!(
                    "{} samples, but {} of the input",
                    values.len(),
                    self.input.len()
                );
                return Err(fault(name, problem));
            }
            if values.is_empty() {
                return Err(fault(name, "no samples".into()));
            }
            if let Some(n) = values.iter().position(|v| !v.is_finite()) {
                let problem = format!("sample {n} (from 0) is {}, not a finite number", values[n]);
                return Err(fault(name, problem));
            }
            if let Some(value) = values.iter().find(|v| v.abs() > LARGEST) {
                let problem = format!("{value:e} is too large to be squared: use another unit");
                return Err(fault(name, problem));
            }
        }
        if let Some(rest) = self.rest.filter(|x| !(x.is_finite() && x.abs() <= LARGEST)) {
            let problem = format!("{rest} before the first sample is no input that can be");
            return Err(fault(&self.input_quantity.name, problem));
        }
        let goes_back = |pair: &[f64]| pair[1] < pair[0];
        match self
            .time
            .as_ref()
            .and_then(|time| time.windows(2).position(goes_back))
        {
            Some(n) => Err(fault(
                "time",
                format!("goes back after sample {n} (from 0)"),
            )),
            None => Ok(()),
        }
    }
}

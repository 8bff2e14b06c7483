//! The constants of stages, as lists of numbers by their names: what files and other languages carry.

use crate::error::Result;
use hysteron_core::{Constant, Error, Real, Stages};
use serde::{Deserialize, Serialize};

/// The constants of all stages, as lists of numbers in the order of [`Stages::declared`]. A stage
/// with empty lists is not there.
///
/// ```
/// use hysteron::StageConstants;
/// let constants = StageConstants::new([("lag", vec![0.5])])?;
/// assert_eq!(constants.get("lag"), [0.5]);
/// assert_eq!(constants.stages().behind.lag.tau, 0.5);
/// assert!(StageConstants::new([("lag", vec![0.5, 0.5])]).is_err());
/// # Ok::<(), hysteron::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct StageConstants<T> {
    /// One for each constant; none at all where no stage is there.
    lists: Vec<Vec<T>>,
}

impl<T> Default for StageConstants<T> {
    fn default() -> Self {
        Self { lists: Vec::new() }
    }
}

impl<T: Real> StageConstants<T> {
    /// The constants with these names; the others are empty.
    ///
    /// # Errors
    /// [`crate::Error::Core`] with the name of a stage whose lists are too long or missing, and for
    /// a name that no constant has. Values are checked by the model that the stages are for.
    pub fn new<N: AsRef<str>>(named: impl IntoIterator<Item = (N, Vec<T>)>) -> Result<Self> {
        Self::default().with(named)
    }

    /// The same constants, with others for these names.
    ///
    /// # Errors
    /// As [`StageConstants::new`].
    pub fn with<N: AsRef<str>>(
        &self,
        named: impl IntoIterator<Item = (N, Vec<T>)>,
    ) -> Result<Self> {
        let mut lists: Vec<Vec<T>> = self.iter().map(|(_, numbers)| numbers.to_vec()).collect();
        for (name, numbers) in named {
            let place = table::<T>().position(|constant| constant.name == name.as_ref());
            lists[place.ok_or(Error::Stage { stage: "stages" })?] = numbers;
        }
        let constants = Self { lists };
        Ok(Self::from_stages(&constants.built()?))
    }

    /// The constants of these stages.
    #[must_use]
    pub fn from_stages(stages: &Stages<'_, T>) -> Self {
        let lists = stages.constants().map(|(_, numbers)| numbers.to_vec());
        Self {
            lists: lists.collect(),
        }
        .or_none()
    }

    /// The same constants in another number type.
    ///
    /// # Errors
    /// As `convert`.
    pub fn map<U: Real, E>(
        &self,
        mut convert: impl FnMut(&'static Constant, T) -> std::result::Result<U, E>,
    ) -> std::result::Result<StageConstants<U>, E> {
        let lists = table::<T>().zip(&self.lists).map(|(constant, numbers)| {
            let numbers = numbers.iter().map(|number| convert(constant, *number));
            numbers.collect()
        });
        Ok(StageConstants {
            lists: lists.collect::<std::result::Result<_, E>>()?,
        })
    }

    /// Each constant with its numbers.
    pub fn iter(&self) -> impl Iterator<Item = (&'static Constant, &[T])> {
        let lists = self.lists.iter().map(Vec::as_slice);
        table::<T>().zip(lists.chain(std::iter::repeat(&[] as &[T])))
    }

    /// The numbers of the constant with this name; none where its stage is not there.
    #[must_use]
    pub fn get(&self, name: &str) -> &[T] {
        let mut all = self.iter();
        let found = all.find(|(constant, _)| constant.name == name);
        found.map_or(&[], |(_, numbers)| numbers)
    }

    /// The stages with these constants. Offset and sign are those of [`Stages::NONE`].
    #[must_use]
    pub fn stages(&self) -> Stages<'_, T> {
        // They were built when the lists were taken.
        self.built().unwrap_or(Stages::NONE)
    }

    /// Whether no stage is there.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.lists.is_empty()
    }

    fn built(&self) -> Result<Stages<'_, T>> {
        let mut lists = self.lists.iter();
        Ok(Stages::of_lists(|| {
            lists.next().map_or(&[] as &[T], Vec::as_slice)
        })?)
    }

    /// The same, without lists where no stage is there.
    fn or_none(self) -> Self {
        match self.stages().is_none() {
            true => Self::default(),
            false => self,
        }
    }
}

/// The constants that the stages declare.
fn table<T: Real>() -> impl Iterator<Item = &'static Constant> {
    Stages::<T>::declared().flat_map(|stage| stage.constants)
}

/// One term of the creep: a first-order lag of the operators' sum, which is added to it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an object in braces")]
pub struct CreepTerm {
    /// Share of the operators' sum that creeps; 0 or more.
    pub coefficient: f64,
    /// Time constant in seconds; above zero.
    pub tau: f64,
}

impl StageConstants<f64> {
    /// Creep and lag as constants.
    pub(crate) fn after(terms: &[CreepTerm], lag: f64) -> Result<Self> {
        let all = |of: fn(&CreepTerm) -> f64| terms.iter().map(of).collect();
        Self::new([
            ("creep", all(|term| term.coefficient)),
            ("creep_taus", all(|term| term.tau)),
            ("lag", vec![lag]),
        ])
    }

    /// The terms of the creep.
    pub(crate) fn terms(&self) -> Vec<CreepTerm> {
        let pairs = self.get("creep").iter().zip(self.get("creep_taus"));
        pairs
            .map(|(&coefficient, &tau)| CreepTerm { coefficient, tau })
            .collect()
    }

    /// The time constant of the lag; 0 for none.
    pub(crate) fn lag(&self) -> f64 {
        self.get("lag").first().copied().unwrap_or(0.0)
    }
}

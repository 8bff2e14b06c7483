//! A function of the load at each sample.

use std::ops::Index;

/// The values of a function of the load. Without a load it is 1, which needs no memory.
#[derive(Debug, Clone)]
pub(crate) enum OfLoad {
    /// 1 at so many samples.
    One(usize),
    /// A value for each sample.
    Each(Vec<f64>),
}

impl OfLoad {
    pub(crate) fn iter(&self) -> impl Iterator<Item = f64> {
        let samples = match self {
            Self::One(samples) => *samples,
            Self::Each(values) => values.len(),
        };
        (0..samples).map(|n| self[n])
    }

    /// The function at the samples kept, where `kept` is 1; 0 at the others.
    pub(crate) fn at_kept(&self, kept: Option<&[f64]>) -> Self {
        match kept {
            None => self.clone(),
            Some(kept) => Self::Each(self.iter().zip(kept).map(|(z, kept)| z * kept).collect()),
        }
    }
}

impl Index<usize> for OfLoad {
    type Output = f64;

    #[inline]
    fn index(&self, n: usize) -> &f64 {
        match self {
            Self::One(_) => &1.0,
            Self::Each(values) => &values[n],
        }
    }
}

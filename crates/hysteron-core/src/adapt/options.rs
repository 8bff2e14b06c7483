//! How an estimator learns: the method and the guards around it.

use crate::{Error, Real};

/// How the weights follow the error `e` of the prediction; `φ` is what the operators put out, `κ` the offset's share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method<T> {
    /// Normalised gradient, `μ ← μ + g φ e / (κ² + φᵀφ)`: the projection algorithm (Goodwin & Sin 1984, section 3.3).
    /// `O(K²)` per sample.
    Gradient {
        /// `g`, above 0 and below 2; 1 takes the whole error of the sample away. Usual: 0.1 to 0.5.
        gain: T,
    },
    /// Normalised gradient on the increments between two inputs some levels apart: `Δy = Σ μ Δγ` concerns the rows
    /// and columns that were crossed and nothing else, so that the slope is learned where it is seen and an
    /// offset of the sensor does not matter (the time-difference scheme of Tan & Baras 2005). `O(K)` per sample and level
    /// crossed; what was learned acts when the table has been renewed, `K` samples later. The model needs memory for
    /// two tables.
    Increments {
        /// As for [`Method::Gradient`]; the offset follows the error of the level with the same gain.
        gain: T,
        /// Levels that the input has to travel between two updates, from 1/8 to 8. Long increments are less noisy. Usual: 1.
        span: T,
    },
    /// Recursive least squares with stabilised forgetting (Kulhavý & Zarrop 1993): the covariance goes back to the one at the start
    /// and never beyond it, so that it stays bounded without excitation. `O(n²)` for `n` parameters.
    LeastSquares {
        /// `λ`, above 0 and up to 1; 1 forgets nothing. Usual: 0.95 to 0.999.
        forgetting: T,
        /// Standard deviation of the error of a reading, in the output's unit; above 0.
        noise: T,
        /// Standard deviation by which a parameter may differ from its off-line value, in its unit; above 0.
        spread: T,
        /// Distance on the plane, in levels, over which deviations of weights go together: the covariance at the
        /// start is `spread²/(1 + d²/correlation²)`. 0: each on its own. Not for parts.
        correlation: T,
    },
}

/// The method and its guards.
///
/// | Option | Default | Range | For |
/// | --- | --- | --- | --- |
/// | `method` | gradient, gain 0.3 | see [`Method`] | how weights follow the error |
/// | `offset_share` | 1 | from 0 | `κ`: how freely the offset moves, beside one weight |
/// | `dead_zone` | 0 | from 0 | errors up to this are noise (Peterson & Narendra 1982) |
/// | `leakage` | 0 | 0 to 1 | share by which weights return to the off-line ones with each update (Ioannou & Kokotović 1984) |
/// | `movement` | 0.05 | from 0 | levels that the input has to move before it counts as excitation |
/// | `trial` | 256 | from 1 | samples after which the weights are judged against the last good ones |
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adaptation<T> {
    /// How the weights follow the error.
    pub method: Method<T>,
    /// `κ`; with 0 the offset stays.
    pub offset_share: T,
    /// Errors up to this size change nothing, larger ones count by what they exceed it; in the output's unit.
    pub dead_zone: T,
    /// Share by which the weights return to the off-line ones with each update.
    pub leakage: T,
    /// Half width, in levels, of the play that the input has to overcome before a sample is learned from.
    pub movement: T,
    /// Samples learned from after which the weights are judged.
    pub trial: u32,
}

impl<T: Real> Default for Adaptation<T> {
    fn default() -> Self {
        let hundredths = |n| T::from_index(n) / T::from_index(100);
        Self {
            method: Method::Gradient {
                gain: hundredths(30),
            },
            offset_share: T::ONE,
            dead_zone: T::ZERO,
            leakage: T::ZERO,
            movement: hundredths(5),
            trial: 256,
        }
    }
}

impl<T: Real> Adaptation<T> {
    /// Refuses values out of range.
    ///
    /// # Errors
    /// [`Error::Adaptation`] names the option.
    pub fn check(&self) -> Result<(), Error> {
        let two = T::ONE + T::ONE;
        let from_zero = |value: T| value >= T::ZERO && value.is_finite();
        let positive = |value: T| value > T::ZERO && value.is_finite();
        let learns = |gain: T| gain > T::ZERO && gain < two;
        let require = |fine: bool, option| match fine {
            true => Ok(()),
            false => Err(Error::Adaptation { option }),
        };
        match self.method {
            Method::Gradient { gain } => require(learns(gain), "gain")?,
            Method::Increments { gain, span } => {
                let eight = T::from_index(8);
                require(learns(gain), "gain")?;
                require(span >= T::ONE / eight && span <= eight, "span")?;
            }
            Method::LeastSquares {
                forgetting,
                noise,
                spread,
                correlation,
            } => {
                require(forgetting > T::ZERO && forgetting <= T::ONE, "forgetting")?;
                require(positive(noise), "noise")?;
                require(positive(spread), "spread")?;
                require(from_zero(correlation), "correlation")?;
            }
        }
        require(from_zero(self.offset_share), "offset_share")?;
        require(from_zero(self.dead_zone), "dead_zone")?;
        require(self.leakage >= T::ZERO && self.leakage <= T::ONE, "leakage")?;
        require(from_zero(self.movement), "movement")?;
        require(self.trial > 0, "trial")
    }
}

//! The options of an estimator: the method and its guards.

use crate::error::Error;
use crate::scalar::Real;

/// How the weights follow the prediction error `e`. In the formulas `φ` are the operators' outputs
/// and `κ` is `offset_share`.
///
/// Each method gives the highest cost of a sample that is learned from. A sample that is not
/// learned from costs `O(K)` for each level that the input crossed, because the operators' states
/// move. Two costs come on top from time to time:
///
/// - Where others moved the state, the next sample computes the operators' states from the turning
///   points: `O(K²)` for each of them.
/// - The last sample of a trial copies the parameters, or returns to others and writes the table:
///   `O(K²)`.
///
/// Cost of a sample that is learned from, relative to a step of [`crate::Definition`], as
/// `cargo bench -p hysteron-core --bench adaptation` prints it on an x86-64 processor:
///
/// | K | increments | least squares | least squares, 6 coefficients |
/// | --- | --- | --- | --- |
/// | 10 | 0.9 | 18 | 6 |
/// | 20 | 0.3 | 52 | 2.7 |
/// | 40 | 0.13 | 190 | 1.5 |
/// | 100 | 0.06 | | 1.1 |
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method<T> {
    /// Normalised gradient on the increments between two inputs some levels apart (the
    /// time-difference scheme of Tan & Baras 2005).
    ///
    /// `Δy = Σ μ Δγ` concerns only the rows and columns that the input crossed. So the method
    /// learns the slope where it is seen, and an offset of the sensor does not matter. `O(K)` for
    /// each level crossed since the increment began; `O(K²)` where the input crossed the plane in a
    /// jump.
    ///
    /// The table is renewed by one row in each sample, so what was learned acts at most `2K`
    /// samples later. The model needs memory for two tables. For many levels on a small processor.
    Increments {
        /// `g`, above 0 and below 2. 1 removes nearly the whole error of an increment. Usual: 0.1 to
        /// 0.5. The offset follows the error of the output with the same gain.
        gain: T,
        /// Levels from the start of an increment to its end, from 1/8 to 8. Long increments are
        /// less noisy. Usual: 1.
        span: T,
    },
    /// Recursive least squares with regularised forgetting (Kulhavý & Kraus 1996, after Kulhavý &
    /// Zarrop 1993).
    ///
    /// Forgetting leads the covariance back to that at the start and never beyond it. So it stays
    /// bounded without excitation. `O(n²)` for `n` parameters including the offset. That is `O(K⁴)`
    /// for all weights, so use it for small `K` or for a basis. It learns fastest. With a
    /// correlation it also learns weights where the input has not been.
    LeastSquares {
        /// `λ`, above 0 and up to 1. 1 forgets nothing. Usual: 0.99 to 0.9999. How long a sample is
        /// remembered depends on `noise` and `spread` too.
        forgetting: T,
        /// Standard deviation of the error of a reading, in the output's unit; above 0.
        noise: T,
        /// Standard deviation of a parameter from its off-line value, in the parameter's unit;
        /// above 0.
        spread: T,
        /// Distance on the plane, in levels, over which deviations of weights are correlated; from
        /// 0. The covariance at the start is `spread²/(1 + d²/correlation²)`, `d` levels apart.
        /// With 0 weights are independent. It has to be 0 for a basis.
        correlation: T,
    },
}

/// The method and its guards.
///
/// | Option | Default | Range | For |
/// | --- | --- | --- | --- |
/// | `method` | increments, gain 0.3, span 1 | see [`Method`] | how weights follow the error |
/// | `offset_share` | 1 | from 0 | `κ`: how freely the offset moves, relative to one weight |
/// | `dead_zone` | 0 | from 0 | errors up to this are noise (Peterson & Narendra 1982) |
/// | `leakage` | 0 | 0 to 1 | return to the off-line weights (Ioannou & Kokotović 1984) |
/// | `movement` | 0.05 | from 0 | levels between two samples that are learned from |
/// | `trial` | 256 | from 1 | samples after which weights are compared with the last good ones |
/// | `gate` | 12 | 0, or from 2 | surprises above so many times the usual one are refused |
/// | `burst` | 8 | from 1 | so many refused readings in a row that agree are accepted |
///
/// **Gate.** The gate compares the prediction error of a reading with the error that remained after
/// the last accepted reading. The difference is the surprise. An error that the model makes all the
/// time is no surprise. The usual size of a surprise is a running mean over about 64 accepted
/// readings. It starts at 1/50 of the model's range and does not fall below 1/1000 of it. Samples
/// at rest are not judged, because nothing is learned from them.
///
/// Refused readings in a row agree where their surprises differ by at most half of the larger one.
/// The reading that completes `burst` of them is learned from, and its surprise becomes the usual
/// size. So a wrong reading that lasts for `burst` samples or longer is learned like a jump of the
/// plant: readings cannot tell the two apart. Where `burst` readings in a row are refused and do
/// not agree, for example because noise grew, the usual size doubles.
///
/// **Stuck.** A sensor that goes on with one value looks like a plant whose output no longer
/// depends on its input. A [`Watch`](crate::Watch) finds that, unless `gate` is 0. The parameters
/// then return to those from before the last stretch in which both channels moved, and nothing is
/// learned until both move again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adaptation<T> {
    /// How the weights follow the error.
    pub method: Method<T>,
    /// `κ`, from 0: how freely the offset moves, relative to one weight. With 0 it does not move.
    pub offset_share: T,
    /// Dead zone, in the output's unit, from 0. Errors up to it change nothing; a larger error
    /// counts by the amount beyond it.
    pub dead_zone: T,
    /// The fraction, from 0 to 1, of their deviation by which the weights return to the off-line
    /// ones with each update.
    pub leakage: T,
    /// How far the input has to be from the last sample learned from, in levels, from 0.
    ///
    /// Noise of the input below this teaches nothing at rest. And what is learned depends on the
    /// way of the input, not on the rate of the samples.
    pub movement: T,
    /// Number of samples learned from in a trial, from 1.
    ///
    /// At its end the weights that it began with become the good ones, if they predicted no worse
    /// than the last good ones. The good weights replace the present ones, if these had more than
    /// four times the mean square error. Weights from within a burst of wrong readings do not
    /// become good, if the burst is shorter than half a trial.
    pub trial: u32,
    /// The largest surprise that is learned from, as a multiple of the usual one: from 2, or 0 to
    /// accept every reading, also those of a stuck channel.
    pub gate: T,
    /// So many refused readings in a row that agree are a jump of the plant, from 1. Fewer are a
    /// burst of wrong readings, and nothing is learned from them.
    pub burst: u32,
}

impl<T: Real> Default for Adaptation<T> {
    fn default() -> Self {
        let hundredths = |n| T::from_index(n) / T::from_index(100);
        Self {
            method: Method::Increments {
                gain: hundredths(30),
                span: T::ONE,
            },
            offset_share: T::ONE,
            dead_zone: T::ZERO,
            leakage: T::ZERO,
            movement: hundredths(5),
            trial: 256,
            gate: T::from_index(12),
            burst: 8,
        }
    }
}

impl<T: Real> Adaptation<T> {
    /// Checks the ranges of all options.
    ///
    /// # Errors
    /// [`Error::Adaptation`] with the name of the first option out of range.
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
                // The estimator uses the squares. They must not underflow or overflow either.
                require(positive(noise * noise) && noise > T::ZERO, "noise")?;
                require(positive(spread * spread) && spread > T::ZERO, "spread")?;
                require(from_zero(correlation), "correlation")?;
            }
        }
        require(from_zero(self.offset_share), "offset_share")?;
        require(from_zero(self.dead_zone), "dead_zone")?;
        require(self.leakage >= T::ZERO && self.leakage <= T::ONE, "leakage")?;
        require(from_zero(self.movement), "movement")?;
        require(self.trial > 0, "trial")?;
        let shut = self.gate >= two && self.gate.is_finite();
        require(shut || self.gate == T::ZERO, "gate")?;
        require(self.burst > 0, "burst")
    }

    /// The amount of an error beyond the dead zone.
    pub(super) fn beyond(&self, error: T) -> T {
        error - error.clamp(-self.dead_zone, self.dead_zone)
    }
}

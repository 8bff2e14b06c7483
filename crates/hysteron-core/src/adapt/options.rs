//! How an estimator learns: the method and the guards around it.

use crate::error::Error;
use crate::scalar::Real;

/// How the weights follow the error `e` of the prediction; `φ` is what the operators put out, `κ` the offset's share.
///
/// What a sample costs at most is given with each method; one that nothing is learned from costs `O(K)` for each level that the
/// input crossed, since it moves the operators. Two things come on top, now and then: where a state was moved by
/// others in between, the next sample works out the operators anew, `O(K²)` for each turning point; and at the end of a
/// trial one sample copies the parameters, or takes them back and writes the table, `O(K²)`.
///
/// Cost of a sample that is learned from, relative to a step of the plain [`crate::Definition`], as
/// `cargo bench -p hysteron-core --bench adaptation` prints it on an x86-64 processor:
///
/// | K | gradient | increments | least squares | least squares, 6 shares |
/// | --- | --- | --- | --- | --- |
/// | 10 | 2.5 | 0.9 | 18 | 6 |
/// | 20 | 1.5 | 0.3 | 52 | 2.7 |
/// | 40 | 1.2 | 0.13 | 190 | 1.5 |
/// | 100 | 1.3 | 0.06 | | 1.1 |
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method<T> {
    /// Normalised gradient, `μ ← μ + g φ e/(c + κ² + φᵀφ)`: the projection algorithm (Goodwin & Sin 1984, section 3.3), with
    /// `c` a hundredth of what `φᵀφ` is when every operator is on, so that few operators that are hardly on do not take
    /// the whole blame. `O(K²)`: a few passes over the weights and the table. The first to try: it needs to know nothing of
    /// the noise, and bears more levels than least squares.
    Gradient {
        /// `g`, above 0 and below 2; 1 takes nearly the whole error of the sample away. Usual: 0.1 to 0.5.
        gain: T,
    },
    /// Normalised gradient on the increments between two inputs some levels apart: `Δy = Σ μ Δγ` concerns the rows
    /// and columns that were crossed and nothing else, so that the slope is learned where it is seen and an
    /// offset of the sensor does not matter (the time-difference scheme of Tan & Baras 2005). `O(K)` for each level
    /// crossed since the increment began, `O(K²)` for one that crossed the plane in a jump. The table is renewed a row a sample: what was
    /// learned acts at most `2K` samples later. The model needs memory for two tables. For many levels on a small processor.
    Increments {
        /// As for [`Method::Gradient`]; the offset follows the error of the level with the same gain.
        gain: T,
        /// Levels from the beginning of an increment to its end, from 1/8 to 8. Long increments are less noisy. Usual: 1.
        span: T,
    },
    /// Recursive least squares with regularised forgetting (Kulhavý & Kraus 1996, after Kulhavý & Zarrop 1993): the covariance
    /// goes back to the one at the start and never beyond it, so that it stays bounded without excitation. `O(n²)` for `n`
    /// parameters, the offset among them: `O(K⁴)` for all weights, so for small `K` or for parts. It learns fastest, and with
    /// a correlation also where the input has not been.
    LeastSquares {
        /// `λ`, above 0 and up to 1; 1 forgets nothing. Usual: 0.99 to 0.9999; what it remembers
        /// depends on `noise` and `spread` too.
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
/// | `movement` | 0.05 | from 0 | levels between two samples that are learned from: less is no excitation |
/// | `trial` | 256 | from 1 | samples on which weights are judged against the last good ones |
/// | `gate` | 12 | 0, or from 2 | a reading further off than so many times the usual is not learned from; 0: none is refused |
/// | `burst` | 8 | from 1 | readings in a row that the gate refuses before it believes them, where they agree |
///
/// **Gate.** Measured less expected is compared with what the last reading that was believed left
/// of its error, so that it is the surprise that counts and not what the model says wrongly all the
/// time. The usual size of a surprise is the running mean over the last 64 or so that were
/// believed. It starts at 1/50 of the model's range and does not fall below 1/1000 of it. Samples
/// at rest are not judged, as nothing is learned from them.
///
/// Readings refused one after the other agree where two surprises differ by half of the larger one
/// at most. The one that completes `burst` of them is learned from, and surprises of its size are
/// usual then. So a wrong reading held for `burst` samples or longer is learned as a jump of the
/// plant would be: no reading tells the two apart. Where `burst` are refused in a row without
/// agreeing, as when noise grows, the usual size doubles.
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
    /// Levels that the input has to lie beyond the last sample learned from. Thus noise of the input within this width teaches nothing
    /// at rest, and what is learned depends on the way that the input went and not on how often it was sampled.
    pub movement: T,
    /// Samples learned from in a trial. At its end the weights that it began with become the good ones if they predicted no
    /// worse than these; and the present ones go back to the good ones if their mean square error was more than four times
    /// as large. Weights from within a burst of wrong readings that is shorter than half a trial do not become good.
    pub trial: u32,
    /// How many times the usual surprise a reading may differ from what was expected, to be learned
    /// from. 0 lets every reading pass.
    pub gate: T,
    /// Readings beyond the gate in a row that are taken for a jump of the plant, where they agree.
    /// Fewer are a burst of wrong ones, of which nothing is learned.
    pub burst: u32,
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
            gate: T::from_index(12),
            burst: 8,
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
                // The squares count: these must not vanish nor overflow either.
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

    /// What an error counts beyond the dead zone.
    pub(super) fn beyond(&self, error: T) -> T {
        error - error.clamp(-self.dead_zone, self.dead_zone)
    }
}

/// The range of an option, in words.
pub(crate) fn range_of(option: &str) -> &'static str {
    match option {
        "gain" => "above 0 and below 2",
        "span" => "from 1/8 to 8",
        "forgetting" => "above 0 and up to 1",
        "noise" | "spread" => "above 0, and its square a number too",
        "correlation" => {
            "a finite number from 0 on, and 0 where the coefficients of a basis are adapted"
        }
        "leakage" => "from 0 to 1",
        "trial" | "burst" => "1 or more",
        "gate" => "a finite number from 2 on, or 0 for none",
        "method" => "gradient or least squares where the coefficients of a basis are adapted",
        "coefficients" => "finite numbers from 0 on, at least one",
        _ => "a finite number from 0 on",
    }
}

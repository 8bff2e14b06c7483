//! Ring: the output swings after the operators, as a mass on a spring.

use crate::scalar::Real;
use crate::stages::constant::{Constant, Constants, Declared, Range, Unit, one};
use crate::stages::stage::Stage;

/// A resonance of the second order, `y'' + 2 ζ ω y' + ω² y = ω² u` with `ω = 2π f`.
///
/// Its input `u` is held over a sample, and the solution is exact for any step of time (zero-order
/// hold). Of the velocity it remembers `y'/ω`, which has the unit of the output.
///
/// **The inverse for one sample is stable.** The output is given; what is left to move by itself is
/// the velocity, `v ← z v + …` with `z = (d − e^(−2ζωΔ))/(1 − a)`. For `ζ > 0` and any step `Δ` it
/// lies within the unit circle: `1 + z > 0` comes to `sinh σ > ζ' sin(σ/ζ')` with `σ = ζωΔ` and
/// `ζ' = ζ/√(1−ζ²)`, and `1 − z > 0` to `cosh σ > cos(σ/ζ')`. In a step that is short beside the
/// period `z` comes close to −1, and the input alternates (Åström, Hagander and Sternby 1984). So
/// the exact inverse is used only where little of that alternation is left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ring<T> {
    /// The frequency `f` without damping, in Hz; 0 for no ring.
    pub frequency: T,
    /// The damping ratio `ζ`, above 0; 1 is critical.
    pub damping: T,
}

/// Output, velocity over `ω`, and the output that was last wanted: that of a sample forward.
pub(crate) type Memory<T> = [T; 3];
/// `1 − a`, `b`, `d` of the step: with the input at zero, `y ← a y + b v` and `v ← d v − b y`. All
/// zeros at rest.
pub(crate) type Factors<T> = [T; 3];

/// What the inverse of a ring may ask of the stages before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Aims<X> {
    /// The input that gives the target in this sample.
    pub(crate) exact: X,
    /// The input that gives the target nearly, and ends the alternation of the exact one.
    pub(crate) soft: X,
    /// The input that leads towards the target without swinging about it.
    pub(crate) calm: X,
    /// The inputs between which the exact inverse alternates afterwards, if the target goes on as
    /// it moves now.
    pub(crate) swing: [X; 2],
}

impl<X: Copy> Aims<X> {
    pub(crate) fn map<Y>(self, turn: impl Fn(X) -> Y) -> Aims<Y> {
        Aims {
            exact: turn(self.exact),
            soft: turn(self.soft),
            calm: turn(self.calm),
            swing: self.swing.map(turn),
        }
    }
}

impl<T: Real> Ring<T> {
    /// No ring.
    pub const NONE: Self = Ring {
        frequency: T::ZERO,
        damping: T::ONE,
    };

    /// The inputs that may be wanted for the output `y` in this sample.
    ///
    /// The target moves on by as much as since the sample before. *Exact* leaves the velocity off
    /// by some `δ` from the target's. In the next samples the exact inverse then alternates about
    /// the input that follows the target by `(b/(1−a)) δ`, ever less: that is the swing. Where it
    /// stays within reach, a target that goes on steadily is met in every later sample too.
    ///
    /// *Soft* gives up a little of the target for the velocity, `min (y − y*)² + ½ (1 − a) δ²`: a
    /// change of the input moves both terms by about as much. So the alternation ends within a few
    /// samples.
    ///
    /// *Calm* damps the velocity critically, by `2(1 − ζ)(ẏ*/ω − v)`, but changes the
    /// input by no more than what makes the energy `(y − y*)² + (v − ẏ*/ω)²` at the end of the
    /// sample least. The energy is convex in the input. So for a target at rest it never grows, also
    /// where the operators limit the input: nothing runs away.
    pub(crate) fn aims(&self, memory: &Memory<T>, factors: &Factors<T>, y: T) -> Aims<T> {
        let &[at, v, wanted] = memory;
        let &[gain, b, d] = factors;
        if is_rest(factors) {
            return Aims {
                exact: y,
                soft: y,
                calm: y,
                swing: [y; 2],
            };
        }
        let exact = self.inverse(memory, factors, y);
        // What a sampled ramp of this slope has: its velocity at the samples, and its input.
        let (rise, still) = (y - wanted, T::ONE - d);
        let all = gain * still + b * b;
        let (rate, follow) = (rise * b / all, wanted + rise * still / all);
        let half = T::HALF * b;
        let soft = at + (y - at - b * v + half * (rate - d * v)) / (gain + half * b);
        let off = b / gain * (b * (exact - at) + d * v - rate);
        let swing = off.max(-off);
        let least = at + (gain * (y - at - b * v) + b * (rate - d * v)) / (gain * gain + b * b);
        let most = least - follow;
        let loss = T::ONE - self.damping;
        let damp = (loss + loss) * (rate - v);
        Aims {
            exact,
            soft,
            calm: follow + damp.clamp(most.min(T::ZERO), most.max(T::ZERO)),
            swing: [follow - swing, follow + swing],
        }
    }
}

/// Whether nothing of a past is left. In a step without length `d` is one.
fn is_rest<T: Real>(&[gain, _, d]: &Factors<T>) -> bool {
    gain == T::ZERO && d == T::ZERO
}

impl<'a, T: Real> Constants<'a, T> for Ring<T> {
    const DECLARED: &'static [Declared] = &[Declared {
        name: "ring",
        about: "the output swings, as a mass on a spring",
        constants: &[
            Constant {
                name: "ring_frequency",
                unit: Unit::Hertz,
                range: Range::Frequency,
                meaning: "one frequency, that of the resonance without damping",
            },
            Constant {
                name: "ring_damping",
                unit: Unit::One,
                range: Range::Damping,
                meaning: "one damping ratio, 1 where nothing swings",
            },
        ],
    }];

    fn lists(&self) -> impl Iterator<Item = &[T]> {
        let list = |number| match self.is_there() {
            true => core::slice::from_ref(number),
            false => &[],
        };
        [list(&self.frequency), list(&self.damping)].into_iter()
    }

    fn of_lists(mut next: impl FnMut() -> &'a [T]) -> Option<Self> {
        match (one(next())?, one(next())?) {
            (Some(frequency), Some(damping)) => Some(Self { frequency, damping }),
            (None, None) => Some(Self::NONE),
            _ => None,
        }
    }

    fn fits(&self) -> Result<(), &'static str> {
        Ok(())
    }
}

impl<T: Real> Stage<T> for Ring<T> {
    type Memory = Memory<T>;
    type Factors = Factors<T>;

    fn is_there(&self) -> bool {
        self.frequency != T::ZERO
    }

    fn is_timed(&self) -> bool {
        self.is_there()
    }

    fn factors(&self, dt: T) -> Factors<T> {
        let zeta = self.damping;
        let turn = T::TWO_PI * self.frequency * dt;
        let fade = (-(zeta * turn)).exp();
        if fade == T::ZERO {
            // The sine of an angle beyond all numbers is none.
            return [T::ONE, T::ZERO, T::ZERO];
        }
        let root = ((T::ONE - zeta) * (T::ONE + zeta)).sqrt();
        let angle = root * turn;
        let sine = match root > T::ZERO {
            true => angle.sin() / root,
            false => turn,
        };
        let half = (T::HALF * angle).sin();
        // `1 − a` without the difference of two numbers near one.
        let gain = fade * (half * half + half * half - zeta * sine) - (-(zeta * turn)).exp_m1();
        [gain, fade * sine, fade * (angle.cos() - zeta * sine)]
    }

    fn rest(&self, x: T) -> Memory<T> {
        [x, T::ZERO, x]
    }

    fn forward(&self, memory: &mut Memory<T>, factors: &Factors<T>, x: T) -> T {
        let &[at, v, _] = &*memory;
        let &[gain, b, d] = factors;
        let gap = x - at;
        let y = at + (gain * gap + b * v);
        *memory = [y, b * gap + d * v, y];
        y
    }

    fn inverse(&self, &[at, v, _]: &Memory<T>, factors: &Factors<T>, y: T) -> T {
        let &[gain, b, _] = factors;
        match is_rest(factors) {
            true => y,
            false => at + (y - at - b * v) / gain,
        }
    }

    fn settled(&self, x: T) -> T {
        x
    }

    fn drift(&self, factors: &[T]) -> T {
        // The square of what is left of a past is `a d + b²`; what two numbers remember is rounded.
        let &[gain, b, d] = factors else {
            return T::ZERO;
        };
        T::from_index(8) / (T::ONE - ((T::ONE - gain) * d + b * b))
    }

    fn steepest(&self, factors: &Factors<T>) -> T {
        match is_rest(factors) {
            true => T::ONE,
            false => factors[0],
        }
    }
}

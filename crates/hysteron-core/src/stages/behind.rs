//! The stages behind the operators, one after the other.
//!
//! [`behind!`](self) has the list of them. It writes the composition: constants, what is remembered,
//! forward, and the inverse from the last stage to the first. It calls each stage directly, so it
//! costs what the stages cost that are there.

use crate::scalar::Real;
use crate::stages::constant::{Constants, Declared};
use crate::stages::stage::Stage;
use crate::stages::{creep, curve, lag, ring};
use creep::Creep;
use curve::Curve;
use lag::Lag;
use ring::{Aims, Ring};

/// The inverse of the stages named, from the last to the first.
macro_rules! back {
    ($stages:ident, $memory:ident, $factors:ident, $y:ident;) => { $y };
    ($stages:ident, $memory:ident, $factors:ident, $y:ident; $first:ident $($rest:ident)*) => {{
        let y = back!($stages, $memory, $factors, $y; $($rest)*);
        match $stages.$first.is_there() {
            true => $stages.$first.inverse(&$memory.$first, &$factors.$first, y),
            false => y,
        }
    }};
}

/// Composes the stages named, in their order. The file of a stage has its name, and in it the types
/// `Memory` and `Factors`.
macro_rules! behind {
    ($(#[$about:meta])* $name:ident<$a:lifetime, $t:ident> { $($stage:ident: $type:ty,)+ }) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct $name<$a, $t> {
            $(
                #[doc = concat!("The ", stringify!($stage), ".")]
                pub $stage: $type,
            )+
        }

        /// What the stages remember.
        #[derive(Debug, Clone, Copy, PartialEq, Default)]
        pub(crate) struct Memory<$t> {
            $($stage: $stage::Memory<$t>,)+
        }

        /// The factors of the stages for one time step.
        #[derive(Debug, Clone, Copy, PartialEq, Default)]
        pub(crate) struct Factors<$t> {
            $($stage: $stage::Factors<$t>,)+
        }

        /// How many numbers the stages remember.
        pub(crate) const MEMORY: usize = 0 $(+ size_of::<$stage::Memory<u8>>())+;
        /// How many factors they have.
        pub(crate) const FACTORS: usize = 0 $(+ size_of::<$stage::Factors<u8>>())+;

        impl<$t: Real> Memory<$t> {
            pub(crate) fn numbers(&self) -> impl Iterator<Item = &$t> {
                core::iter::empty()$(.chain(&self.$stage))+
            }

            pub(crate) fn numbers_mut(&mut self) -> impl Iterator<Item = &mut $t> {
                core::iter::empty()$(.chain(&mut self.$stage))+
            }
        }

        impl<$t: Real> Factors<$t> {
            pub(crate) fn numbers(&self) -> impl Iterator<Item = &$t> {
                core::iter::empty()$(.chain(&self.$stage))+
            }
        }

        impl<$a, $t: Real> $name<$a, $t> {
            /// No stage.
            pub const NONE: Self = Self { $($stage: <$type>::NONE,)+ };

            /// What each stage declares.
            pub(crate) fn declared() -> impl Iterator<Item = &'static Declared> {
                core::iter::empty()$(.chain(<$type as Constants<$t>>::DECLARED))+
            }

            /// The constants of all stages.
            pub(crate) fn lists(&self) -> impl Iterator<Item = &[$t]> {
                core::iter::empty()$(.chain(self.$stage.lists()))+
            }

            /// The stages of these constants; the name of one whose constants cannot be.
            pub(crate) fn of_lists(mut next: impl FnMut() -> &$a [$t]) -> Result<Self, &'static str> {
                Ok(Self {
                    $($stage: <$type>::of_lists(&mut next).ok_or(stringify!($stage))?,)+
                })
            }

            /// How the constants have to fit each other.
            pub(crate) fn fits(&self) -> Result<(), &'static str> {
                $(self.$stage.fits()?;)+
                Ok(())
            }

            /// The name of each stage, and whether it is there.
            pub fn there(&self) -> impl Iterator<Item = (&'static str, bool)> {
                [$((stringify!($stage), self.$stage.is_there()),)+].into_iter()
            }

            /// The steepest slope of each stage at rest.
            pub fn slopes(&self) -> impl Iterator<Item = $t> {
                let rest = Factors::<$t>::default();
                [$(self.$stage.steepest(&rest.$stage),)+].into_iter()
            }

            /// Whether a stage depends on time.
            #[must_use]
            pub fn is_timed(&self) -> bool {
                false $(|| self.$stage.is_timed())+
            }

            pub(crate) fn factors(&self, dt: $t) -> Factors<$t> {
                let mut factors = Factors::default();
                $(if self.$stage.is_timed() {
                    factors.$stage = self.$stage.factors(dt);
                })+
                factors
            }

            /// The output for the sum `x`. Before the first sample the stages are at rest, and the
            /// factors have to be zero.
            pub(crate) fn forward(
                &self,
                started: bool,
                memory: &mut Memory<$t>,
                factors: &Factors<$t>,
                x: $t,
            ) -> $t {
                $(let x = match self.$stage.is_there() {
                    true => {
                        if !started {
                            memory.$stage = self.$stage.rest(x);
                        }
                        self.$stage.forward(&mut memory.$stage, &factors.$stage, x)
                    }
                    false => x,
                };)+
                x
            }

            /// The sum for the output `y`. Factors as for [`Self::forward`].
            pub(crate) fn inverse(
                &self,
                memory: &Memory<$t>,
                factors: &Factors<$t>,
                y: $t,
            ) -> $t {
                back!(self, memory, factors, y; $($stage)+)
            }

            /// The output at rest, where the sum has always been `x`.
            #[must_use]
            pub fn settled(&self, x: $t) -> $t {
                $(let x = match self.$stage.is_there() {
                    true => self.$stage.settled(x),
                    false => x,
                };)+
                x
            }

            /// The output for the sum `x` of the stages that do not depend on time.
            #[must_use]
            pub fn untimed(&self, x: $t) -> $t {
                $(let x = match self.$stage.is_there() && !self.$stage.is_timed() {
                    true => self.$stage.settled(x),
                    false => x,
                };)+
                x
            }

            /// The steepest slope of the output over the sum in a sample with these factors.
            pub(crate) fn steepest(&self, factors: &Factors<$t>) -> $t {
                let slope = $t::ONE;
                $(let slope = match self.$stage.is_there() {
                    true => slope * self.$stage.steepest(&factors.$stage),
                    false => slope,
                };)+
                slope
            }

            /// How many roundings of the output are in it at most, because what stages remember is
            /// rounded in each sample of a time step with these factors ([`Rates::to_numbers`]
            /// without the first two).
            ///
            /// [`Rates::to_numbers`]: crate::Rates::to_numbers
            #[must_use]
            pub fn drift(&self, factors: &[$t; FACTORS]) -> $t {
                let (drift, rest) = ($t::ZERO, &factors[..]);
                $(
                    let count = size_of::<$stage::Factors<u8>>();
                    let (own, rest) = rest.split_at(count.min(rest.len()));
                    let drift = match self.$stage.is_there() {
                        true => drift + self.$stage.drift(own),
                        false => drift,
                    };
                )+
                let _ = rest;
                drift
            }

            /// The steepest slope of the output over the sum, at rest.
            #[must_use]
            pub fn steepest_at_rest(&self) -> $t {
                self.steepest(&Factors::default())
            }

            /// The size of the numbers that the output is made from, beside the sum.
            #[must_use]
            pub fn size(&self) -> $t {
                let size = $t::ZERO;
                $(let size = match self.$stage.is_there() {
                    true => {
                        let steepest = self.$stage.steepest(&Factors::<$t>::default().$stage);
                        size * steepest + self.$stage.size()
                    }
                    false => size,
                };)+
                size
            }

            /// The slope of the output at the sum `x` in a sample. Factors as for
            /// [`Self::forward`].
            pub(crate) fn slope(
                &self,
                started: bool,
                mut memory: Memory<$t>,
                factors: &Factors<$t>,
                x: $t,
            ) -> $t {
                let slope = $t::ONE;
                $(let (x, slope) = match self.$stage.is_there() {
                    true => {
                        if !started {
                            memory.$stage = self.$stage.rest(x);
                        }
                        let here = self.$stage.slope(&factors.$stage, x);
                        let x = self.$stage.forward(&mut memory.$stage, &factors.$stage, x);
                        (x, slope * here)
                    }
                    false => (x, slope),
                };)+
                let _ = x;
                slope
            }
        }
    };
}

behind! {
    /// The stages behind the operators, in the order in which they act.
    Behind<'a, T> {
        curve: Curve<'a, T>,
        creep: Creep<'a, T>,
        lag: Lag<T>,
        ring: Ring<T>,
    }
}

impl<T: Real> Behind<'_, T> {
    /// The sums that may be wanted for the output `y`, where a ring is the last stage; `None`
    /// without one. Factors as for [`Self::forward`].
    pub(crate) fn aims(&self, memory: &Memory<T>, factors: &Factors<T>, y: T) -> Option<Aims<T>> {
        if !self.ring.is_there() {
            return None;
        }
        let before = Self {
            ring: Ring::NONE,
            ..*self
        };
        let aims = self.ring.aims(&memory.ring, &factors.ring, y);
        Some(aims.map(|x| before.inverse(memory, factors, x)))
    }

    /// Keeps the output that was wanted, from which the next inverse knows how fast the target
    /// moves.
    pub(crate) fn keep_wanted(&self, memory: &mut Memory<T>, y: T) {
        if self.ring.is_there() {
            memory.ring[2] = y;
        }
    }
}

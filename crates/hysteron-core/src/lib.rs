//! The real-time core of hysteron: hysteresis models for hosts and microcontrollers.
//!
//! The model is a weighted sum of elementary operators (MKP, KP or relay) on a triangular plane of
//! `K` levels (equation 2 of the chapter).
//!
//! - [`Definition`] computes it as written, in `O(K²)` per sample.
//! - [`Model`] computes the same output in amortised `O(1)` per sample.
//! - [`Inverse`] finds the input that gives a wanted output, exactly, in `O(log K)`.
//! - [`Estimator`] adapts the weights while the model runs, [`ShiftEstimator`] follows an unknown
//!   load.
//! - [`Stages`] stand before and behind the operators: [`Body`], [`Axis`], [`Behind`].
//!
//! The core does not allocate: the caller provides all memory. It has no unsafe code and does not
//! panic on any input. Numbers are `f32` or `f64`.
//!
//! The equation numbers in these docs are those of *the chapter*: "Hysteresis behaviour and
//! modeling of SMA actuators", in *Shape Memory Alloys*, ed. C. Cismasiu, 2010. Its misprints: (4)
//! reads `−x/a` for `x/a`; (8) and (9) swap the indices of `s` in some places; the upper index in
//! (13) should be `f + 1`; the plane needs `α ≤ β ≤ T_max`.
#![no_std]
#![forbid(unsafe_code)]

mod adapt;
mod branch;
pub mod control;
mod definition;
mod error;
mod everett;
mod interface;
mod inverse;
mod limits;
mod memory;
mod model;
mod operator;
mod plane;
mod relay;
mod renewal;
mod scalar;
mod search;
mod solution;
mod stages;
mod state;
mod target;

pub use adapt::{
    Adaptation, Channel, Estimator, Gate, Learning, Method, Outcome, Reading, ShiftEstimator,
    ShiftOptions, Verdict, Watch, Watched, estimator_len, estimator_len_of_basis,
};
pub use branch::Turn;
pub use definition::Definition;
pub use error::{Error, NegativeWeights};
pub use everett::{table_index, table_len};
pub use interface::Region;
pub use inverse::Inverse;
pub use limits::MAX_LEVELS;
pub use memory::Memory;
pub use model::{ClippedCount, Model, Output};
pub use operator::{Operator, mkp, relay, ridge};
pub use plane::{Clipped, Plane, operator_count, operator_index, operators};
pub use scalar::Real;
pub use solution::{Solution, Status};
pub use stages::{
    Axis, Behind, Body, Constant, Creep, Curve, Decay, Declared, Lag, Latent, Load, Loaded,
    MAX_CREEP, MAX_PARTS, Parts, Placed, RATE_NUMBERS, Range, Rates, Registration, Ring,
    STATE_NUMBERS, Sample, StageState, Stages, Unit, Wanted, bernstein, mix,
};
pub use state::{State, turn_capacity};
pub use target::{Direction, Target};

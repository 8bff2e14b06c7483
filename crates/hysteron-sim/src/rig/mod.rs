//! The virtual rig: a **simulated** stand-in for the chapter's experiment (section 5.2).
//!
//! The chapter measured a NiTi tension spring that lifts 6 N while a current of 2 A is switched on
//! and off. Those data are not published, so this module simulates the experiment from published
//! laws of the material, and from nothing that the toolkit is to prove: it holds no Preisach, KP or
//! MKP model. What it records is marked [`Origin::Simulated`](hysteron::Origin::Simulated).
//!
//! | Part | Law |
//! | --- | --- |
//! | [`Transformation`] | cosine branches (Brinson 1993), partial loops (Ivshin & Pence 1994) |
//! | [`Spring`] | torsion of rings with two moduli (Waram 1993) |
//! | [`Wire`] | Joule heat, latent heat, natural convection (Churchill & Chu 1975) |
//! | [`Sensor`] | Gaussian noise within the accuracy that the chapter's section 7 gives |
//! | [`Experiment`] | one complete and many partial cycles, sampled and [`prepared`] |
//!
//! Configuration is plain data ([`Rig`], [`Experiment`]); [`Plant`] is the state in motion, to be
//! driven by any current, load and room temperature.

mod convection;
mod error;
mod experiment;
mod plant;
mod reproduction;
mod sensors;
mod spring;
mod thermal;
mod transformation;

pub use convection::still_air;
pub use error::RigError;
pub(crate) use error::check;
pub use experiment::{CUTOFF_HZ, Experiment, Phase, prepared};
pub use plant::{Plant, Rig};
pub use reproduction::{LEVELS, RANGE_DEGC, Reproduction};
pub use sensors::Sensor;
pub use spring::{Ring, Spring};
pub(crate) use thermal::Body;
pub use thermal::Wire;
pub use transformation::{Direction, MaterialPoint, Transformation};

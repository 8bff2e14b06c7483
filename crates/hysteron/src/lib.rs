//! hysteron: from a recording of input and output to a calibrated hysteresis model and its exact inverse.
//!
//! The model is the MKP (modified Krasnosel'skii-Pokrovskii) model, a weighted sum of elementary
//! hysteresis operators; KP and the classical Preisach relay stand beside it. Identify one with
//! [`fit`] ([`prepare()`] it before where it is noisy), simulate with [`Model::simulate`] or step by step with [`Model::step`], compensate with
//! [`Model::inverse`], judge with [`evaluate`]. Where the plant changes, [`adapt()`] lets a model learn from a recording
//! and [`Adaptive`] sample by sample; [`control`] puts models and inverses into loops, [`plant`] simulates devices to try them on,
//! and [`track`](mod@track) compares controllers. *The chapter*, whose equations the docs number, is named in
//! `hysteron-core`. The real-time core below, `hysteron-core`, runs without
//! allocation.
#![forbid(unsafe_code)]

mod adapt;
mod adaptive;
mod advice;
mod band;
pub mod control;
mod design;
mod error;
mod evaluate;
pub mod filter;
mod identify;
mod inspect;
mod inverse;
mod load;
mod metrics;
mod model;
mod model_file;
mod monotone;
mod output;
pub mod plant;
mod predict;
mod prepare;
mod printable;
mod recording;
mod remedy;
pub mod rig;
mod stream;
mod table;
mod thermal;
pub mod track;
mod turning;

pub use adapt::{
    AdaptOptions, Adapted, Compared, Drift, DriftParts, Learner, OutcomeCounts, adapt,
    adapt_watched,
};
pub use adaptive::Adaptive;
pub use advice::{Advice, advice};
pub use band::{Band, BandEvaluation};
pub use design::{Design, DesignOptions, Leg, Rates, design, ramps};
pub use error::{Error, Place, Result};
pub use evaluate::{Evaluation, InverseEvaluation, InverseRun, evaluate, evaluate_from};
pub use hysteron_core::Error as CoreError;
pub use hysteron_core::{
    Adaptation, Clipped, ClippedCount, Direction, Learning, MAX_LEVELS, Method, Operator, Outcome,
    Output, Policy, Region, Solution, Status, operator_index,
};
pub use identify::{
    Candidates, Confidence, Excitation, FitOptions, FitSummary, INTERVAL, LeftOut, Open, Score,
    Solver, Start, Validation, Watch, cross_validate, excitation, fit, fit_experiment, identify,
    left_out, plane_of,
};
pub use inspect::{
    ColumnSummary, ConfidenceSummary, LoadSummary, ModelSummary, RecordingSummary, Series,
    TableSummary, Uncertain, inspect_model, inspect_recording, inspect_table,
};
pub use inverse::Inverse;
pub use load::{LoadDependence, LoadPart};
pub use metrics::Errors;
pub use model::{Model, Sign, State};
pub use monotone::{AGAINST_INPUT, way_against_input};
pub use output::{
    Added, AtomicFile, AtomicFolder, Cell, Own, STANDARD_OUTPUT, TableWriter, Target,
    discard_unfinished, refuse_one_file,
};
pub use predict::Surroundings;
pub use prepare::{
    DeadBand, LowPass, Preparation, PrepareOptions, RateDependence, Repairs, SensorLag, Smoothed,
    Spikes, Step, noise, prepare, prepare_watched, rate_dependence,
};
pub use printable::printable;
pub use recording::{
    Columns, Note, NoteKind, Origin, Others, Places, Quantity, Recording, Repair, Source,
};
pub use remedy::{Remedy, Setting, SettingValue};
pub use stream::{Counts, Invert, Simulate, invert_table, simulate_table};
pub use table::{Column, ReadOptions, Remark, Row, TableReader};
pub use thermal::{FirstOrder, ThermalState, fit_thermal};
pub use turning::{Headings, NOISE, Turning, branches, headings, noise_band, remembered};

/// The discrete Preisach plane, equation (3).
pub type Plane = hysteron_core::Plane<f64>;

/// The README's code, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct Readme;

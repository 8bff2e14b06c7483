//! hysteron: from a recording of input and output to a calibrated hysteresis model and its exact
//! inverse.
//!
//! The model is the MKP (modified Krasnosel'skii-Pokrovskii) model, a weighted sum of elementary
//! hysteresis operators. KP and classical Preisach relay operators can be used in its place.
//!
//! The usual steps:
//! - Clean a noisy recording with [`prepare()`].
//! - Identify a model with [`Fit`].
//! - Simulate a whole input with [`Model::simulate`], or one sample at a time with [`Model::step`].
//! - Run many actuators or many inputs at once with [`BatchModel`].
//! - Compensate the hysteresis with [`Model::inverse`].
//! - Measure the errors with [`evaluate`], and on samples that were not fitted with
//!   [`fit_holding_out`], beside simple predictors ([`Rival`]). A [`Verdict`] says whether that is
//!   good enough, and if not, why.
//! - Where the plant changes, let the model learn: from a recording with [`adapt()`], or sample by
//!   sample with [`Adaptive`].
//! - Fit a model to each of many actuators with [`fit_fleet`].
//! - Build control loops from models and inverses with [`control`].
//!
//! Simulated devices and comparisons of controllers are in the crate `hysteron-sim`. The real-time
//! core is `hysteron-core`, which runs without allocation. Its documentation names *the chapter*,
//! whose equation numbers the docs of both crates use.
#![forbid(unsafe_code)]

mod adapt;
mod advice;
mod batch;
pub mod control;
#[cfg(feature = "data")]
mod data;
mod design;
mod error;
mod evaluate;
#[cfg(feature = "files")]
mod files;
#[cfg(feature = "data")]
mod fleet;
mod forward;
mod hold_out;
mod identify;
mod inspect;
mod model;
mod parallel;
mod prepare;
mod progress;
mod recording;
mod remedy;
mod rivals;
mod series;
mod verdict;

pub use adapt::{
    ADAPT_OPTIONS, AdaptOption, AdaptOptionKind, AdaptOptions, AdaptValue, Adapted, Adaptive,
    AdaptiveLoad, AutoOptions, Compared, Drift, DriftBasis, EstimatorOptions, Learner,
    OutcomeCounts, Refit, ShiftFound, Stuck, Window, adapt,
};
pub use advice::{Advice, advice, advice_before_fit};
pub use batch::BatchModel;
#[cfg(feature = "data")]
pub use data::{
    Added, Around, Budget, Column, ColumnSummary, Columns, Counts, Growing, Invert, Memory, Note,
    NoteKind, Others, PICTURE, Places, ReadOptions, Remark, Repair, RoleDoubt, Roles, Row,
    STANDARD_OUTPUT, Segment, Simulate, TablePreview, TableReader, TableSummary, TableWriter,
    inspect_table, invert_table, preview_table, preview_table_knowing, simulate_table,
};
pub use design::{Design, DesignOptions, Leg, Rates, design, design_heated, ramps};
pub use error::{Error, Place, Result};
pub use evaluate::{
    Evaluation, InverseEvaluation, InverseRun, evaluate, evaluate_errors, evaluate_from,
};
#[cfg(feature = "data")]
pub use fleet::{
    FleetAlone, FleetChoice, FleetFailure, FleetFitted, FleetKind, FleetOptions, FleetRow,
    FleetShared, Norm, Shape, Strangeness, fit_fleet, join_fleets, prior_of_fleet, read_fleet,
};
pub use forward::{Forward, forward};
pub use hold_out::{HeldOut, RivalErrors, fit_holding_out, held_out};
pub use hysteron_core::Error as CoreError;
pub use hysteron_core::{
    Adaptation, Channel, Clipped, ClippedCount, Direction, Learning, MAX_LEVELS, Method, Operator,
    Outcome, Output, Region, ShiftOptions, Solution, Status, Target, operator_index, operators,
};
#[cfg(feature = "files")]
pub use hysteron_files::Destination;
#[cfg(feature = "data")]
pub use identify::Chosen;
pub use identify::{
    AGAINST_INPUT, Auto, Candidates, Choice, Dynamics, FIT_OPTIONS, Fit, FitOption, FitOptions,
    LeftOut, LoadLaw, Spacing, SpacingShape, Thermal, WeightPrior, cross_validate, excitation,
    left_out, plane_of, rested_words, usual_start, way_against_input,
};
pub use inspect::{
    ConfidenceSummary, ConstantSummary, LoadSummary, ModelSummary, RecordingSummary, Series,
    StageSummary, Uncertain, inspect_model, inspect_recording,
};
pub use model::{
    Band, BandEvaluation, Bounds, Change, Confidence, CreepTerm, Criterion, Delay, Excitation,
    FirstOrder, FitSummary, FittedStart, INTERVAL, Inverse, LoadCurves, LoadDependence, LoadPart,
    Model, OperatorState, Operators, Plane, Policy, Registration, RivalScore, Sample, Score,
    SeenFile, Sign, Smooth, Solver, StageConstants, Start, State, Surroundings, Validation, Wanted,
};
pub use prepare::{
    DeadBand, Doubt, Judged, LowPass, Preparation, PrepareOptions, RateDependence, Repairs,
    SensorLag, Smoothed, Spikes, Step, doubts, prepare, rate_dependence,
};
pub use progress::Progress;
pub use recording::{
    HoldOut, Origin, Quantity, Recording, Rows, Source, Split, UndoneLag, one_after_the_other,
};
pub use remedy::{Remedy, Setting, SettingValue, counted};
pub use rivals::{Rival, RivalKind};
pub use series::noise::noise;
pub use series::{
    CutOff, Errors, Headings, NOISE, Turning, branches, fair_range, filter, headings,
    mean_and_deviation, range, remembered, usual_tolerance,
};
pub use verdict::{Basis, Cause, ErrorPart, Grade, PartKind, Verdict, Worst, error_parts};

/// The README's code, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct Readme;

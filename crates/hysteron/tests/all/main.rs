//! The tests of this crate: one program, since every program is linked with all dependencies.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../common/mod.rs"]
mod common;
#[path = "../faulty/mod.rs"]
mod faulty;
mod filtered_feedback;

mod adaptation;
mod adaptive_stages;
mod advised;
mod another_session;
mod arrow_copy;
mod batch;
mod believed;
mod blocks;
mod bounds;
mod broken;
mod confidence;
mod design;
mod determined;
mod either;
mod evaluation;
mod formats;
mod frozen_learning;
mod hold_out;
mod identification;
mod inverse_series;
mod judged_twice;
mod kept_start;
mod mixture;
mod parquet_copy;
mod people;
mod pid;
mod preparation;
mod prepared_faults;
mod preview;
mod priors;
mod readings_that_agree;
mod recordings;
mod remedies;
mod rest;
mod ring;
mod rivals;
mod rivals_left_out;
mod roles;
mod seen;
mod segments;
mod stages;
mod thermal;
mod timestamps;
mod unknown_load;
mod validation;
mod vectors;
mod verdict;
mod warm;
mod weight_prior;
mod wrong_readings;

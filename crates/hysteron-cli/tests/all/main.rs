//! The tests of this crate: one program, since every program is linked with all dependencies.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../common/mod.rs"]
mod common;

mod adapt;
mod command;
mod delay;
mod design;
mod export;
mod export_fmu;
mod fleet;
mod fleet_choice;
mod hold_out;
mod identification;
mod interrupted;
mod logs;
mod messages;
mod options;
mod pages;
mod prepare;
mod readers;
mod replacing;
mod run;
mod segments;
mod shell;
mod start;
mod studio;
mod thermal;
mod track;

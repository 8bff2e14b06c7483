//! A path that a drive follows, and what came of it.

use hysteron::Budget;
use serde::{Deserialize, Serialize};

/// What a path is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// The input, which the model follows.
    Inputs,
    /// The output that is wanted. Where it turns is known ahead.
    Outputs,
}

/// Samples to follow.
#[derive(Debug)]
pub(super) struct Path<'p> {
    pub(super) of: Side,
    pub(super) values: &'p [f64],
    /// The time of each; `None` for steps of `dt`.
    pub(super) time: Option<&'p [f64]>,
    /// The load at each; `None` for the load of the drive.
    pub(super) load: Option<&'p [f64]>,
}

/// A path that was followed, as the page shows it.
#[derive(Debug, Clone, Serialize)]
pub struct FollowedView {
    /// What it was of.
    pub of: Side,
    /// Its samples.
    pub samples: usize,
    /// Of these, how many outputs were not reached, and why: `low`, `high`, `passed`, `limited`.
    pub missed: Vec<(&'static str, usize)>,
}

/// What came of a path.
#[derive(Debug)]
pub(super) struct Followed {
    pub(super) of: Side,
    pub(super) rows: Vec<Row>,
    /// What the rows take of the memory of the session.
    pub(super) _held: Option<Budget>,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Row {
    pub(super) time: f64,
    pub(super) asked: f64,
    pub(super) input: f64,
    pub(super) output: f64,
    pub(super) status: &'static str,
}

impl Followed {
    pub(super) fn view(&self) -> FollowedView {
        let count = |status| self.rows.iter().filter(|row| row.status == status).count();
        let missed = ["low", "high", "passed", "limited"].map(|status| (status, count(status)));
        FollowedView {
            of: self.of,
            samples: self.rows.len(),
            missed: missed.into_iter().filter(|(_, n)| *n > 0).collect(),
        }
    }
}

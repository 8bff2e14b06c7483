//! The requests of a session and its responses.

use super::design::DesignView;
use super::drive::{DriveView, Pull};
use super::fault::Fault;
use super::file_view::FileView;
use super::fitted::FitView;
use super::fitting::Held;
use super::follow::Follow;
use super::id::Id;
use super::job::JobView;
use super::look::Curves;
use super::opened::{Part, Purpose};
use super::pick::WorstView;
use super::plane::{PlaneKind, PlaneView, SampleView};
use super::prepare::Steps;
use super::take_home::{Download, Take};
use super::view::View;
use super::wish::Wish;
use hysteron::FitOption;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What is asked of a session.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "request", rename_all = "snake_case")]
pub enum Request {
    /// All that is open.
    Overview,
    /// Closes a file.
    Close {
        /// The file.
        file: Id,
    },
    /// Says which columns of a file are input, output, time and load.
    Columns {
        /// The file.
        file: Id,
        /// Its columns.
        roles: Part,
    },
    /// Repairs rows that cannot be used, or refuses them.
    Mend {
        /// The file.
        file: Id,
        /// Whether they are repaired.
        on: bool,
    },
    /// Prepares a recording, or takes it as it is.
    Prepare {
        /// The file.
        file: Id,
        /// The steps; `None` for no preparation.
        #[serde(default)]
        steps: Option<Steps>,
    },
    /// Says what a file is for.
    Use {
        /// The file.
        file: Id,
        /// What it is for.
        purpose: Purpose,
    },
    /// Marks a span of samples for validation, besides those that are marked.
    Mark {
        /// The file.
        file: Id,
        /// The first and the last sample, counted from 1; `None` for none at all.
        rows: Option<(usize, usize)>,
    },
    /// Marks the samples in a span of the time for validation, besides those that are marked.
    MarkSpan {
        /// The file.
        file: Id,
        /// Where the span begins, in seconds, or in samples from 1 without a time.
        from: f64,
        /// Where it ends.
        to: f64,
    },
    /// Fits a model to the files that are for it. The answer has a job.
    Fit {
        /// Options that differ from their defaults, by name, as texts: [`hysteron::Fit::with`].
        #[serde(default)]
        options: BTreeMap<String, String>,
        /// What tests the fit.
        #[serde(default)]
        hold_out: Held,
    },
    /// Computes the errors of a fit anew, on the files for validation as they are now.
    JudgeAnew {
        /// The fit.
        fit: Id,
    },
    /// Cancels a job.
    Cancel {
        /// The job.
        job: Id,
    },
    /// Removes a fit.
    Forget {
        /// The fit.
        fit: Id,
    },
    /// Lines to draw.
    Curves(View),
    /// The plane of a fit.
    Plane {
        /// The fit.
        fit: Id,
        /// What is shown of each operator.
        kind: PlaneKind,
        /// The file, and the time (without one the number) of the sample whose states are shown.
        #[serde(default)]
        at: Option<(Id, f64)>,
    },
    /// A sample.
    Sample {
        /// The file.
        file: Id,
        /// The fits whose outputs are wanted.
        #[serde(default)]
        fits: Vec<Id>,
        /// Its time, or without one its number from 1.
        at: f64,
    },
    /// The sample of a picture nearest to a point of it.
    Nearest {
        /// What is shown.
        view: View,
        /// The point, in the units of the axes.
        at: (f64, f64),
    },
    /// The next sample of a file at which an operator of a fit switches; after the last one, the first.
    Switch {
        /// The fit.
        fit: Id,
        /// The file.
        file: Id,
        /// The levels at which the operator switches off and on, counted from 1.
        operator: (usize, usize),
        /// The time (without one the number) of the sample after which it is sought.
        #[serde(default)]
        after: Option<f64>,
    },
    /// The sample with the largest residual of a fit.
    Worst {
        /// The fit.
        fit: Id,
    },
    /// Starts to drive a model by hand.
    Drive {
        /// The fit.
        fit: Id,
    },
    /// Moves a model that is driven.
    Pull(Pull),
    /// Lets it follow a column of a file.
    Follow(Follow),
    /// The profile of input that the data lack.
    Design(Wish),
    /// Something to take home.
    Take(Take),
}

impl Request {
    /// Whether it asks for a part of a picture. A page may ask for one of a file that it, or
    /// another page, has just closed.
    #[must_use]
    pub(super) fn draws(&self) -> bool {
        matches!(
            self,
            Self::Curves(_)
                | Self::Plane { .. }
                | Self::Sample { .. }
                | Self::Nearest { .. }
                | Self::Switch { .. }
        )
    }

    /// Whether the session may be another one afterwards, so that its pages are to look again.
    #[must_use]
    pub fn changes(&self) -> bool {
        !matches!(
            self,
            Self::Overview
                | Self::Curves(_)
                | Self::Plane { .. }
                | Self::Sample { .. }
                | Self::Nearest { .. }
                | Self::Switch { .. }
                | Self::Worst { .. }
                | Self::Design(_)
                | Self::Pull(_)
                | Self::Follow(_)
                | Self::Take(_)
                | Self::Drive { .. }
        )
    }
}

/// What a page is told while it is open.
#[derive(Debug, Clone, Serialize)]
pub struct Told {
    /// Goes up with every change of the session.
    pub changes: u64,
    /// Work under way.
    pub jobs: Vec<JobView>,
    /// Why the last work ended without a fit; `None` if it did not.
    pub failed: Option<Fault>,
    /// Number of files that can be read again from the disk.
    pub named: usize,
}

/// What a session answers.
#[derive(Debug, Serialize)]
#[serde(tag = "response", rename_all = "snake_case")]
pub enum Response {
    /// All that is open.
    Overview(Box<Overview>),
    /// A job was made.
    Started(JobView),
    /// Lines to draw.
    Curves(Curves),
    /// A plane.
    Plane(PlaneView),
    /// A sample.
    Sample(SampleView),
    /// There is no such sample: the operator never switches.
    Never,
    /// The file or the fit that was to be drawn has been closed meanwhile.
    Gone,
    /// The sample with the largest residual.
    Worst(WorstView),
    /// A model that is driven.
    Driven(DriveView),
    /// A profile.
    Designed(Box<DesignView>),
    /// Something to take home.
    Taken(Download),
}

/// All that is open.
#[derive(Debug, Serialize)]
pub struct Overview {
    /// The files, in the order of opening.
    pub files: Vec<FileView>,
    /// The fits, the oldest first.
    pub fits: Vec<FitView>,
    /// Work under way.
    pub jobs: Vec<JobView>,
    /// The best fit.
    pub best: Option<Id>,
    /// By what it is the best.
    pub best_by: &'static str,
    /// The options of a fit.
    pub options: &'static [FitOption],
    /// Memory of the files, and its limit, in bytes.
    pub memory: (u64, u64),
}

//! The session: what is open, without a transport. A request in, a response out.
//!
//! `request` defines both, `handle` leads from one to the other, `fault` is what is wrong. `state`
//! is what the session keeps. `opened` is a file, `parts` its recordings, `prepare` their
//! preparation, `design` the experiment that is missing. `fitting` asks for a fit, `job` is its
//! work, `fitted` what it found and `judged` what is said of it, `anew` where a file has changed
//! since; `carried` has these as bytes. `view` says what a picture shows. `look` and `plane` make
//! the pictures, with the lines of `seen` from what `thinned` leaves; `layers` is drawn besides
//! them, and `pick` points at a sample. `drive` is a model moved by hand, `path` what it may
//! follow, and `follow` the way there. `take_home` is what can be taken away, with `c_archive`;
//! `commands` is the same work as text, `saved` the session as a file.

mod anew;
mod argument;
mod c_archive;
mod carried;
mod commands;
mod design;
mod drive;
mod fault;
mod file_view;
mod fitted;
mod fitting;
mod follow;
mod handle;
mod id;
mod job;
mod judged;
mod layers;
mod look;
mod opened;
mod parts;
mod path;
mod pick;
mod plane;
mod prepare;
mod request;
mod saved;
mod seen;
mod state;
mod take_home;
mod thinned;
mod view;
mod wish;

pub use design::DesignView;
pub use drive::{DriveView, Pull, RivalView};
pub use fault::Fault;
pub use file_view::{ColumnView, FileView};
pub use fitted::FitView;
pub use fitting::Held;
pub use follow::Follow;
pub use handle::Answer;
pub use id::Id;
pub use job::{Finished, Job, JobView};
pub use layers::Layers;
pub use look::{Curves, Line};
pub use opened::{Part, Purpose, RepairView};
pub use path::{FollowedView, Side};
pub use pick::WorstView;
pub use plane::{PlaneKind, PlaneView, SampleView};
pub use prepare::Steps;
pub use request::{Overview, Request, Response, Told};
pub use state::Session;
pub use take_home::{Download, Take};
pub use thinned::Ends;
pub use view::{Area, Picture, View};
pub use wish::Wish;

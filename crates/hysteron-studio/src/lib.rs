//! The studio: a local page in which one sees a recording and its loop, fits models, drives them by
//! hand and takes them home.
//!
//! [`Session`] is what is open: recordings, fits, models that are driven. It takes a [`Request`]
//! and gives a [`Response`], knows no transport, and touches no file. [`Server`] (feature `server`)
//! is one transport: a page and its calls on 127.0.0.1. The crate `hysteron-studio-wasm` is the
//! other: the session in a worker of the browser. Both show the same page; [`static_page`] has its
//! files for the latter.
#![forbid(unsafe_code)]

#[cfg(feature = "page")]
mod page;
#[cfg(feature = "server")]
mod server;
mod session;

#[cfg(feature = "page")]
pub use page::{PageFile, STATIC_SESSION, static_page};
#[cfg(feature = "server")]
pub use server::Server;
pub use session::{
    Answer, Area, ColumnView, Curves, DesignView, Download, DriveView, Ends, Fault, FileView,
    Finished, FitView, Follow, FollowedView, Held, Id, Job, JobView, Layers, Line, Overview, Part,
    Picture, PlaneKind, PlaneView, Pull, Purpose, RepairView, Request, Response, RivalView,
    SampleView, Session, Side, Steps, Take, Told, View, Wish, WorstView,
};

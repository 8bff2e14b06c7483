//! Files that claim what they do not hold: no reader takes more memory than it may.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use hysteron::{Columns, ReadOptions, Recording, Repair};
use rand::rngs::ChaCha8Rng;
use rand::{Rng, RngExt, SeedableRng};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::fs;
use std::path::{Path, PathBuf};

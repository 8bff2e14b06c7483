//! Where the page comes from: the studio's server, or a folder that any server of files gives. Both
//! run the same tests.
#![allow(clippy::unwrap_used)]

use crate::chromium::{Chromium, Tab, browser};
use crate::common::Studio;
use crate::folder::{Files, folder};

/// That a page has begun and has no file yet.
pub const EMPTY: &str = "document.querySelector('#drop.empty')";

/// A test for each way to the session.
macro_rules! both_ways {
    ($($name:ident),* $(,)?) => {
        mod server {
            $(#[test] fn $name() { super::$name(super::Way::Server) })*
        }
        mod folder_alone {
            $(#[test] fn $name() { super::$name(super::Way::Folder) })*
        }
    };
}
pub(crate) use both_ways;

/// A way to the session.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// The session is in the server.
    Server,
    /// The session is in a worker of the browser.
    Folder,
}

/// A page that can be opened.
pub struct Place {
    pub address: String,
    from: From,
}

enum From {
    Server(Studio),
    Folder(Files),
}

impl Way {
    /// The name that the page gives to it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Server => "server",
            Self::Folder => "browser",
        }
    }

    /// How the page says which it is.
    pub fn says(self) -> &'static str {
        match self {
            Self::Server => "Local server",
            Self::Folder => "Static page",
        }
    }

    /// `None` where it cannot be built; a line says why.
    pub fn start(self, budget: u64) -> Option<Place> {
        let (address, from) = match self {
            Self::Server => {
                let studio = Studio::start(budget, &[]);
                (studio.address.clone(), From::Server(studio))
            }
            Self::Folder => {
                let files = Files::start(folder()?);
                (files.address.clone(), From::Folder(files))
            }
        };
        Some(Place { address, from })
    }

    /// A browser with an empty page of so many pixels, of a session with so many bytes of memory.
    /// `None` where there is none; a line says why.
    pub fn open(self, budget: u64, (width, height): (u32, u32)) -> Option<(Chromium, Place, Tab)> {
        let mut browser = browser()?;
        let place = self.start(budget)?;
        let tab = browser.open(&place.address, width, height);
        browser.wait(&tab, EMPTY);
        Some((browser, place, tab))
    }
}

impl Place {
    /// Ends it, and checks what its server was asked for.
    pub fn end(self) {
        match self.from {
            From::Server(studio) => studio.end(),
            From::Folder(files) => files.end(),
        }
    }
}

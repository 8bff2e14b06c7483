//! How a report was made.

use maud::{Markup, html};

/// How a report was made. Its foot says so, with the version of hysteron.
///
/// ```
/// let made = hysteron_report::Made {
///     command: Some("hysteron evaluate model.json data.csv --report report"),
///     date: Some("2026-11-23"),
/// };
/// assert_ne!(made, hysteron_report::Made::default()); // neither is told
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Made<'a> {
    /// The command, as it was typed.
    pub command: Option<&'a str>,
    /// The day, as `2026-11-23`.
    pub date: Option<&'a str>,
}

impl Made<'_> {
    pub(crate) fn html(&self) -> Markup {
        html! {
            p.made {
                "Made by hysteron " (env!("CARGO_PKG_VERSION"))
                @if let Some(date) = self.date { " on " time { (date) } }
                "."
            }
            @if let Some(command) = self.command { pre.made { (command) } }
        }
    }
}

/// A file and the digest of its bytes.
pub(crate) fn file(path: &str, sha256: Option<&str>) -> Markup {
    html! {
        (path) ", "
        @match sha256 {
            Some(digest) => { "SHA-256 " code { (digest) } }
            None => "digest not recorded",
        }
    }
}

//! Output for people and for programs.

use std::error::Error;
use std::io::Write;

/// What a command comes to.
pub(crate) type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// What the command needs to be told, as text: wrong usage, found when a file was read.
#[derive(Debug)]
pub(crate) struct Unclear(pub(crate) String);

impl std::fmt::Display for Unclear {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl Error for Unclear {}

/// Tells a person something, on standard error.
pub(crate) fn say(message: std::fmt::Arguments<'_>) {
    eprintln!(
        "hysteron: {}",
        hysteron_files::printable(&message.to_string())
    );
}

/// What every error begins with, wrong usage too.
pub(crate) const ERROR: &str = "hysteron: error: ";

/// Tells a person why the command failed.
pub(crate) fn fail(message: std::fmt::Arguments<'_>) {
    eprintln!("{ERROR}{}", hysteron_files::printable(&message.to_string()));
}

/// Prints to standard output for people, or JSON; an error there is returned, not a panic.
pub(crate) fn print(text: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{}", hysteron_files::printable(text))?;
    Ok(out.flush()?)
}

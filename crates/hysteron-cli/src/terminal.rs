//! Output for people and for programs.

use std::error::Error;
use std::io::Write;

/// What a command comes to.
pub(crate) type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Tells a person something, on standard error.
pub(crate) fn say(message: std::fmt::Arguments<'_>) {
    eprintln!("hysteron: {}", hysteron::printable(&message.to_string()));
}

/// What every error begins with, wrong usage too.
pub(crate) const ERROR: &str = "hysteron: error: ";

/// Tells a person why the command failed.
pub(crate) fn fail(message: std::fmt::Arguments<'_>) {
    eprintln!("{ERROR}{}", hysteron::printable(&message.to_string()));
}

/// Prints to standard output for people, or JSON; an error there is returned, not a panic.
pub(crate) fn print(text: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{}", hysteron::printable(text))?;
    Ok(out.flush()?)
}

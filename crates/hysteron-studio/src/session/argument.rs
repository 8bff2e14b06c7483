//! Arguments of the command, as a shell reads them.

use hysteron_files::shell_word;

/// An option and its value. A value that begins with a hyphen is no option.
pub(super) fn option(name: &str, value: &str) -> String {
    let between = if value.starts_with('-') { '=' } else { ' ' };
    format!("--{name}{between}{}", shell_word(value))
}

/// A file as an argument: one that begins with a hyphen is no option.
pub(super) fn path(name: &str) -> String {
    match name.starts_with('-') {
        true => shell_word(&format!("./{name}")),
        false => shell_word(name),
    }
}

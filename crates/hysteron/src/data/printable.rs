//! Text from files and names as it may be shown to people.

use std::borrow::Cow;

/// The text without what changes a terminal, or the order in which it is read: control characters
/// but line feed and tab, and marks of direction, are written as `\u` and four hexadecimal digits.
///
/// The result is valid within JSON too. What is written for programs, such as a CSV table, keeps
/// its bytes.
///
/// ```
/// assert_eq!(hysteron::printable("a\u{1b}[31m\u{202e}b"), "a\\u001b[31m\\u202eb");
/// assert_eq!(hysteron::printable("line\n\tunit °C"), "line\n\tunit °C");
/// ```
#[must_use]
pub fn printable(text: &str) -> Cow<'_, str> {
    if !text.chars().any(is_active) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        match is_active(character) {
            true => shown.push_str(&format!("\\u{:04x}", u32::from(character))),
            false => shown.push(character),
        }
    }
    Cow::Owned(shown)
}

/// Whether a character does something instead of showing something.
fn is_active(character: char) -> bool {
    match character {
        '\n' | '\t' => false,
        // Marks of direction, separators of lines and paragraphs, and the mark of byte order.
        '\u{61c}'
        | '\u{200e}'
        | '\u{200f}'
        | '\u{2028}'..='\u{202e}'
        | '\u{2066}'..='\u{2069}'
        | '\u{feff}' => true,
        other => other.is_control(),
    }
}

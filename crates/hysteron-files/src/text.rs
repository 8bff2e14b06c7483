//! Makes text from files and names safe to show to people, and to paste into a shell or a program.

use std::borrow::Cow;

/// The text without characters that would change the state of a terminal or the reading order.
/// Control characters (except line feed and tab) and direction marks are written as `\u` and four
/// hexadecimal digits.
///
/// The result is also valid inside JSON. Output for programs, such as a CSV table, is not changed
/// in this way.
///
/// ```
/// assert_eq!(hysteron_files::printable("a\u{1b}[31m\u{202e}b"), "a\\u001b[31m\\u202eb");
/// assert_eq!(hysteron_files::printable("line\n\tunit °C"), "line\n\tunit °C");
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

/// The text as one word of a POSIX shell. No argument of a program can hold the character 0, which is
/// left out.
///
/// ```
/// assert_eq!(hysteron_files::shell_word("data.csv"), "data.csv");
/// assert_eq!(hysteron_files::shell_word("my wire's.csv"), r"'my wire'\''s.csv'");
/// ```
#[must_use]
pub fn shell_word(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "._-/:,%+=".contains(c);
    match !text.is_empty() && !text.starts_with('-') && text.chars().all(plain) {
        true => text.to_owned(),
        false => format!("'{}'", text.replace('\0', "").replace('\'', "'\\''")),
    }
}

/// The text as a literal of Python.
///
/// ```
/// assert_eq!(hysteron_files::python_literal("my wire's.csv"), r#""my wire's.csv""#);
/// assert_eq!(hysteron_files::python_literal("a\"b\\c\n\u{202e}"), r#""a\"b\\c\x0a\U0000202e""#);
/// ```
#[must_use]
pub fn python_literal(text: &str) -> String {
    let mut literal = String::with_capacity(text.len() + 2);
    literal.push('"');
    for character in text.chars() {
        match character {
            '"' | '\\' => literal.extend(['\\', character]),
            '\0'..'\u{20}' | '\u{7f}' => literal += &format!("\\x{:02x}", u32::from(character)),
            _ if is_active(character) => literal += &format!("\\U{:08x}", u32::from(character)),
            _ => literal.push(character),
        }
    }
    literal.push('"');
    literal
}

/// Whether a character controls the display instead of being shown.
fn is_active(character: char) -> bool {
    match character {
        '\n' | '\t' => false,
        // Direction marks, line and paragraph separators, and the byte order mark.
        '\u{61c}'
        | '\u{200e}'
        | '\u{200f}'
        | '\u{2028}'..='\u{202e}'
        | '\u{2066}'..='\u{2069}'
        | '\u{feff}' => true,
        other => other.is_control(),
    }
}

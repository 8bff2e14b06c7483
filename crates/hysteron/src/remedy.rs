//! The remedy for an error, kept apart from the error itself. The names of options stay symbols in
//! it, so that each surface can spell them in its own way.

use std::borrow::Cow;
use std::fmt;

/// What to do about an error: a text with the options in it.
///
/// ```
/// use hysteron::{Remedy, Setting};
/// let remedy = Remedy::new("take {} at most", [Setting::number("load-degree", 2)]);
/// assert_eq!(remedy.to_string(), "take `load degree` 2 at most");
/// assert_eq!(remedy.spelt(Setting::typed), "take --load-degree 2 at most");
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Remedy {
    words: Cow<'static, str>,
    settings: Vec<Setting>,
}

/// An option and the value that it should have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Setting {
    /// Name of the option as on the command line, without dashes in front: `load-degree`.
    pub name: &'static str,
    /// The value that it should have.
    pub value: SettingValue,
}

/// The value that an option should have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SettingValue {
    /// Any value: the user chooses it.
    Any,
    /// On, for an option that is either on or off.
    On,
    /// A word.
    Word(&'static str),
    /// A number.
    Number(usize),
}

impl Remedy {
    /// A remedy from a text with `{}` in place of each option.
    #[must_use]
    pub fn new<const N: usize>(
        words: impl Into<Cow<'static, str>>,
        settings: [Setting; N],
    ) -> Self {
        let (words, settings) = (words.into(), settings.into());
        Self { words, settings }
    }

    /// The same, of a list.
    pub(crate) fn listed(words: String, settings: Vec<Setting>) -> Self {
        let words = words.into();
        Self { words, settings }
    }

    /// The text, with each option spelt by `spelling`.
    pub fn spelt(&self, spelling: impl Fn(&Setting) -> String) -> String {
        let mut words = self.words.split("{}");
        let first = words.next().unwrap_or_default().to_owned();
        let pairs = self.settings.iter().zip(words);
        pairs.fold(first, |text, (setting, words)| {
            text + &spelling(setting) + words
        })
    }
}

/// A number of things, of which there may be one.
///
/// ```
/// assert_eq!(hysteron::counted(1, "reading"), "1 reading");
/// assert_eq!(hysteron::counted(2, "reading"), "2 readings");
/// ```
#[must_use]
pub fn counted(count: usize, one: &str) -> String {
    match count {
        1 => format!("1 {one}"),
        _ => format!("{count} {one}s"),
    }
}

impl Setting {
    /// An option whose value the user chooses.
    #[must_use]
    pub const fn any(name: &'static str) -> Self {
        let value = SettingValue::Any;
        Self { name, value }
    }

    /// An option to turn on.
    #[must_use]
    pub const fn on(name: &'static str) -> Self {
        let value = SettingValue::On;
        Self { name, value }
    }

    /// An option with a word as its value.
    #[must_use]
    pub const fn word(name: &'static str, word: &'static str) -> Self {
        let value = SettingValue::Word(word);
        Self { name, value }
    }

    /// An option with a number as its value.
    #[must_use]
    pub const fn number(name: &'static str, number: usize) -> Self {
        let value = SettingValue::Number(number);
        Self { name, value }
    }

    /// The option as it is typed on a command line.
    #[must_use]
    pub fn typed(&self) -> String {
        let Self { name, value } = self;
        match value {
            SettingValue::Any | SettingValue::On => format!("--{name}"),
            value => format!("--{name} {value}"),
        }
    }
}

/// The text for users of no particular surface: options are shown by name.
impl fmt::Display for Remedy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let spelling = |setting: &Setting| {
            let name = setting.name.replace('-', " ");
            match setting.value {
                SettingValue::Any | SettingValue::On => format!("`{name}`"),
                value => format!("`{name}` {value}"),
            }
        };
        f.write_str(&self.spelt(spelling))
    }
}

/// Empty for a value that has no text of its own.
impl fmt::Display for SettingValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Any | Self::On => Ok(()),
            Self::Word(word) => f.write_str(word),
            Self::Number(number) => number.fmt(f),
        }
    }
}

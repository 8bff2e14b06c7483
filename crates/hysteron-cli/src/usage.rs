//! Wrong usage: what is said of it, and what was probably meant.

use crate::args::Cli;
use crate::terminal::ERROR;
use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Command, CommandFactory, Error, Parser};
use std::path::Path;

/// What people call a task, and the command that does it.
const MEANT: [(&str, &str); 11] = [
    ("identify", "fit"),
    ("train", "fit"),
    ("model", "fit"),
    ("predict", "simulate"),
    ("validate", "evaluate"),
    ("test", "evaluate"),
    ("clean", "prepare"),
    ("show", "inspect"),
    ("info", "inspect"),
    ("plan", "design"),
    ("gui", "studio"),
];

/// The arguments. Where they are wrong, the program ends.
pub(crate) fn parse() -> Cli {
    Cli::try_parse().unwrap_or_else(|mut error| {
        if !error.use_stderr() {
            error.exit();
        }
        advise(&mut error);
        let text = error.to_string();
        // A message may repeat the arguments, so control characters are escaped as in others.
        match text.strip_prefix("error: ") {
            Some(text) => eprint!("{ERROR}{}", hysteron_files::printable(text)),
            None => eprint!("{}", hysteron_files::printable(&text)),
        }
        std::process::exit(error.exit_code())
    })
}

/// Adds what was probably meant.
fn advise(error: &mut Error) {
    let words: Vec<String> = std::env::args_os()
        .skip(1)
        .map(|word| word.to_string_lossy().into_owned())
        .collect();
    let mut command = Cli::command();
    let command = reached(&mut command, &words);
    match error.kind() {
        ErrorKind::InvalidSubcommand => {
            let Some(ContextValue::String(word)) = error.get(ContextKind::InvalidSubcommand) else {
                return;
            };
            let word = word.clone();
            if let Some(name) = meant(command, &word) {
                let names = ContextValue::Strings(vec![name.to_owned()]);
                error.insert(ContextKind::SuggestedSubcommand, names);
            } else if is_file(&word) {
                error.remove(ContextKind::SuggestedSubcommand);
                tip(error, &first_a_command(command, &word));
            }
        }
        ErrorKind::UnknownArgument => {
            let Some(ContextValue::String(word)) = error.get(ContextKind::InvalidArg) else {
                return;
            };
            let word = word.clone();
            // An option of another command is no file whose name begins with dashes.
            if word.starts_with("--") {
                error.remove(ContextKind::Suggested);
            }
            if command.get_name() == "invert" && word == "--input" {
                tip(
                    error,
                    "the column of the wanted output is named with --target",
                );
            }
        }
        ErrorKind::MissingRequiredArgument => {
            let Some(ContextValue::Strings(names)) = error.get(ContextKind::InvalidArg) else {
                return;
            };
            if names.iter().any(|name| name.ends_with("<COL>")) {
                tip(
                    error,
                    "`hysteron inspect FILE` lists the columns of a recording",
                );
            }
        }
        _ => {}
    }
}

fn tip(error: &mut Error, text: &str) {
    let tips = ContextValue::StyledStrs(vec![StyledStr::from(text.to_owned())]);
    error.insert(ContextKind::Suggested, tips);
}

/// The command that the words lead to, as `export` of `export model.json`.
fn reached<'c>(command: &'c mut Command, words: &[String]) -> &'c Command {
    command.build();
    let mut command = &*command;
    // `help` is followed by commands of the first level.
    for word in words.iter().filter(|word| *word != "help") {
        match command.find_subcommand(word) {
            Some(next) => command = next,
            None => break,
        }
    }
    command
}

/// The one command that a word stands for, or is mistyped from.
fn meant<'c>(command: &'c Command, word: &str) -> Option<&'c str> {
    let names: Vec<&str> = command.get_subcommands().map(Command::get_name).collect();
    let word = word.to_lowercase();
    let other = MEANT.iter().find(|(other, _)| *other == word);
    if let Some((_, name)) = other {
        return names.iter().find(|known| *known == name).copied();
    }
    // Of four letters one may be wrong, and of three.
    let most = word.chars().count().div_ceil(4).max(1);
    let near = names
        .iter()
        .map(|name| (strsim::osa_distance(&word, name), *name));
    let (distance, name) = near.min()?;
    (distance <= most && word.len() > 1).then_some(name)
}

/// Whether a word in the place of a command is the name of a file.
fn is_file(word: &str) -> bool {
    Path::new(word).extension().is_some() || Path::new(word).exists()
}

fn first_a_command(command: &Command, word: &str) -> String {
    let file = hysteron_files::shell_word(word);
    let is_model = Path::new(word).extension().is_some_and(|end| end == "json");
    match (command.get_name(), is_model) {
        ("hysteron", true) => format!("`hysteron inspect {file}` shows what is in a model"),
        ("hysteron", false) => format!("`hysteron start {file}` begins with a recording"),
        (name, _) => {
            let below = command.get_subcommands().map(Command::get_name);
            let below: Vec<&str> = below.filter(|name| *name != "help").collect();
            format!(
                "the file comes after one of these: hysteron {name} {}",
                below.join(" | ")
            )
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// Every command, with any one letter missing, doubled, wrong, or exchanged with the next.
    #[test]
    fn a_mistyped_command_gets_its_suggestion() {
        let mut command = Cli::command();
        let command = reached(&mut command, &[]);
        let names: Vec<&str> = command.get_subcommands().map(Command::get_name).collect();
        assert!(names.len() > 15);
        for name in &names {
            let letters: Vec<char> = name.chars().collect();
            for n in 0..letters.len() {
                let mut typed = [(); 4].map(|()| letters.clone());
                typed[0].remove(n);
                typed[1].insert(n, letters[n]);
                typed[2][n] = 'x';
                let next = (n + 1).min(letters.len() - 1);
                typed[3].swap(n, next);
                for typed in typed.map(String::from_iter) {
                    let found = meant(command, &typed).unwrap();
                    let distance = |name| strsim::osa_distance(&typed, name);
                    assert!(distance(found) <= distance(name), "{typed}: {found}");
                }
            }
        }
        for (other, name) in MEANT {
            assert!(names.contains(&name) || cfg!(not(feature = "studio")));
            assert!(!names.contains(&other), "{other}");
        }
        assert_eq!(meant(command, "x"), None);
        assert_eq!(meant(command, "recording"), None);
    }

    /// What is written can be named in words too, where `--output` is no column.
    #[test]
    fn the_file_that_is_written_has_a_long_name_where_one_is_free() {
        fn each(command: &Command, found: &mut Vec<String>) {
            let long = |name| {
                let mut all = command.get_arguments();
                all.find(|argument| argument.get_long() == Some(name))
            };
            let short = |name| {
                let mut all = command.get_arguments();
                all.find(|argument| argument.get_short() == Some(name))
            };
            if let Some(out) = short('o') {
                let output = long("output").unwrap();
                let is_column = output
                    .get_value_names()
                    .is_some_and(|names| names[0] == "COL");
                assert!(is_column || output.get_id() == out.get_id());
                found.push(command.get_name().to_owned());
            }
            command
                .get_subcommands()
                .for_each(|below| each(below, found));
        }
        let mut found = Vec::new();
        each(&Cli::command(), &mut found);
        assert!(found.len() > 10, "{found:?}");
    }
}

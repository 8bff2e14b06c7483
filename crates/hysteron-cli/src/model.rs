//! Models from files.

use crate::terminal::{Result, say};
use hysteron::{Grade, Model, Setting, Verdict};
use hysteron_files::shell_word;
use std::path::Path;

/// The model of a command that takes a model, then a recording.
pub(crate) fn read(model: &Path, data: &Path) -> Result<Model> {
    Model::read(model).map_err(|error| match !Model::is_in(model) && Model::is_in(data) {
        true => exchanged(model, data).into(),
        false => error.into(),
    })
}

/// Says of a model that is going to drive something if its fit calls it poor.
pub(crate) fn say_if_poor(model: &Model) {
    let verdict = Verdict::of_record(model).filter(|verdict| verdict.grade == Grade::Poor);
    let lines = verdict.map(|verdict| verdict.lines(Setting::typed));
    let error = lines
        .into_iter()
        .flatten()
        .find(|(heading, _)| *heading == "error");
    if let Some((_, error)) = error {
        say(format_args!(
            "the model is poor, do not drive by it yet: it errs by {error}"
        ));
    }
}

/// A word for a shell; options need no quotes.
fn shown(word: &str) -> String {
    let bare = word.trim_start_matches('-');
    match shell_word(bare) == bare {
        true => word.to_owned(),
        false => shell_word(word),
    }
}

/// What to say of the two in the wrong order: the command again, with the right one.
fn exchanged(model: &Path, data: &Path) -> String {
    let words = std::env::args_os().skip(1).map(|word| match word {
        word if word == model => data.as_os_str().to_owned(),
        word if word == data => model.as_os_str().to_owned(),
        word => word,
    });
    let words: Vec<String> = words.map(|word| shown(&word.to_string_lossy())).collect();
    format!(
        "{} is no model, and {} is one: the model comes first: hysteron {}",
        model.display(),
        data.display(),
        words.join(" ")
    )
}

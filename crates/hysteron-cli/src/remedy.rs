//! Errors of the library, with its options as they are on the command line.

use crate::terminal::say;
use hysteron::{Advice, Doubt, Remedy, Setting};
use std::error::Error;

/// What is wrong, where, and what to do.
pub(crate) fn text_of(error: &(dyn Error + 'static)) -> String {
    match error.downcast_ref().map(hysteron::Error::parts) {
        Some((error, Some(remedy))) => format!("{error}: {}", spelt(remedy)),
        _ => error.to_string(),
    }
}

pub(crate) fn text_of_advice(advice: &Advice) -> String {
    format!("{advice}: {}", spelt(&advice.remedy()))
}

/// More doubts about one file are not read.
const SAID: usize = 5;

/// Says what is not to be believed, and what may help; `which` recording it is goes before.
pub(crate) fn say_doubts(doubts: &[Doubt], which: &str) {
    for doubt in doubts.iter().take(SAID) {
        say(format_args!("{which}{doubt}: {}", spelt(&doubt.remedy())));
    }
    if let Some(more @ 1..) = doubts.len().checked_sub(SAID) {
        let more = hysteron::counted(more, "doubt");
        say(format_args!(
            "{which}{more} more: inspect with --json lists them all"
        ));
    }
}

fn spelt(remedy: &Remedy) -> String {
    remedy.spelt(Setting::typed)
}

//! The `hysteron` command: a thin surface over the library, which does the work.

mod adapt;
mod args;
mod columns;
mod compare;
mod demo;
mod design;
mod evaluate;
mod export;
mod fit;
mod fleet;
mod hold_out;
mod inspect;
mod made;
mod model;
mod prepare;
mod progress;
mod recording;
mod remedy;
mod run;
mod shell;
mod start;
#[cfg(feature = "studio")]
mod studio;
mod table;
mod terminal;
mod text;
mod track;
mod usage;

use args::Command;
use std::error::Error;
use std::io::ErrorKind;
use std::path::Path;
use std::process::ExitCode;
use terminal::fail;

fn main() -> ExitCode {
    // Ended by Ctrl-C or a signal, nothing half-written is left. Without the handler the rest works
    // as well.
    let _ = ctrlc::set_handler(|| {
        #[cfg(feature = "studio")]
        if studio::stop() {
            return;
        }
        if run::stop() {
            return;
        }
        hysteron_files::discard_unfinished();
        std::process::exit(130);
    });
    let done = match usage::parse().command {
        Command::Fit(args) => fit::run(&args),
        Command::Fleet(args) => fleet::run(&args),
        Command::Prepare(args) => prepare::run(&args),
        Command::Simulate(args) => table::simulate(&args),
        Command::Invert(args) => table::invert(&args),
        Command::Evaluate(args) => evaluate::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Adapt(args) => adapt::run(&args),
        Command::Inspect(args) => inspect::run(&args),
        Command::Design(args) => design::run(&args),
        Command::Track(args) => track::run(&args),
        Command::Run(args) => run::run(&args),
        Command::Export(args) => export::run(&args),
        Command::Demo(args) => demo::run(&args),
        Command::Start(args) => start::run(&args),
        #[cfg(feature = "studio")]
        Command::Studio(args) => studio::run(&args),
        Command::Completions(args) => shell::completions(&args),
        Command::Man(args) => shell::man(&args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if broken_pipe(error.as_ref()) => ExitCode::SUCCESS,
        Err(error) if error.is::<run::Ended>() => {
            fail(format_args!("{error}"));
            let code = error.downcast_ref().map_or(1, run::Ended::code);
            ExitCode::from(code)
        }
        Err(error) => {
            let what = remedy::text_of(error.as_ref());
            fail(format_args!("{what}{}", advice(error.as_ref())));
            match error.is::<terminal::Unclear>() {
                true => ExitCode::from(2),
                false => ExitCode::FAILURE,
            }
        }
    }
}

/// A closed standard output, as by `head`, is no fault. The closed reader of a named pipe is one.
fn broken_pipe(error: &(dyn Error + 'static)) -> bool {
    if let Some((path, _)) = of_file(error)
        && path != Path::new(hysteron::STANDARD_OUTPUT)
    {
        return false;
    }
    let io = causes(error).find_map(|cause| cause.downcast_ref::<std::io::Error>());
    io.is_some_and(|io| io.kind() == ErrorKind::BrokenPipe)
}

/// What to do where a file is kept.
fn advice(error: &(dyn Error + 'static)) -> &'static str {
    match of_file(error) {
        Some((_, ErrorKind::AlreadyExists)) => ": name another, or replace it with --force",
        _ => "",
    }
}

/// The file that an error is about, and what kind of fault it is.
fn of_file<'a>(error: &'a (dyn Error + 'static)) -> Option<(&'a Path, ErrorKind)> {
    causes(error).find_map(|cause| {
        let (path, source) = match cause.downcast_ref() {
            Some(hysteron::Error::File { path, source }) => (path, source),
            _ => cause
                .downcast_ref()
                .map(|hysteron_files::Error { path, source }| (path, source))?,
        };
        Some((path.as_path(), source.kind()))
    })
}

fn causes<'a>(error: &'a (dyn Error + 'static)) -> impl Iterator<Item = &'a (dyn Error + 'static)> {
    std::iter::successors(Some(error), |&error| error.source())
}

//! The `hysteron` command: a thin surface over the library, which does the work.

mod adapt;
mod args;
mod demo;
mod design;
mod evaluate;
mod export;
mod fit;
mod inspect;
mod prepare;
mod progress;
mod recording;
mod remedy;
mod table;
mod text;
mod track;

use args::{Cli, Command};
use clap::Parser;
use std::error::Error;
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

fn main() -> ExitCode {
    // Ended by Ctrl-C or a signal, nothing half-written is left. Without the handler the rest works as well.
    let _ = ctrlc::set_handler(|| {
        hysteron::discard_unfinished();
        std::process::exit(130);
    });
    let done = match parse().command {
        Command::Fit(args) => fit::run(&args),
        Command::Prepare(args) => prepare::run(&args),
        Command::Simulate(args) => table::simulate(&args),
        Command::Invert(args) => table::invert(&args),
        Command::Evaluate(args) => evaluate::run(&args),
        Command::Adapt(args) => adapt::run(&args),
        Command::Inspect(args) => inspect::run(&args),
        Command::Design(args) => design::run(&args),
        Command::Track(args) => track::run(&args),
        Command::Export(args) => export::run(&args),
        Command::Demo(args) => demo::run(&args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) if broken_pipe(error.as_ref()) => ExitCode::SUCCESS,
        Err(error) => {
            say(format_args!("{}", remedy::text_of(error.as_ref())));
            ExitCode::FAILURE
        }
    }
}

/// Whoever read our output, such as `head`, has had enough: that is no fault.
fn broken_pipe(error: &(dyn Error + 'static)) -> bool {
    let mut cause = Some(error);
    while let Some(error) = cause {
        if let Some(io) = error.downcast_ref::<std::io::Error>() {
            return io.kind() == std::io::ErrorKind::BrokenPipe;
        }
        cause = error.source();
    }
    false
}

/// Refuses to write over a file that is read.
fn keep_apart(data: &Path, out: &Path) -> Result<()> {
    let there = out.canonicalize().ok();
    if there.is_some() && there == data.canonicalize().ok() {
        let out = out.display();
        return Err(
            format!("{out}: this would replace a file that is read: name another one").into(),
        );
    }
    Ok(())
}

/// The arguments. What is wrong with them may repeat them, so that it is shown as other messages are.
fn parse() -> Cli {
    Cli::try_parse().unwrap_or_else(|error| {
        let text = error.to_string();
        if error.use_stderr() && hysteron::printable(&text) != text {
            eprint!("{}", hysteron::printable(&text));
            std::process::exit(error.exit_code());
        }
        error.exit()
    })
}

/// Tells a person something, on standard error.
fn say(message: std::fmt::Arguments<'_>) {
    eprintln!("hysteron: {}", hysteron::printable(&message.to_string()));
}

/// Prints to standard output for people, or JSON; an error there is returned, not a panic.
fn print(text: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{}", hysteron::printable(text))?;
    Ok(out.flush()?)
}

//! `hysteron completions` and `hysteron man`: what a shell and `man` show of the command line, from
//! the tables that `--help` prints.

use crate::args;
use crate::terminal::{Result, print};
use clap::{Command, CommandFactory};
use clap_mangen::Man;
use hysteron::Error;
use hysteron_files::AtomicFolder;
use std::io::Write;
use std::path::PathBuf;

pub(crate) fn completions(args: &args::Completions) -> Result<()> {
    let mut script = Vec::new();
    let mut command = args::Cli::command();
    clap_complete::generate(args.shell, &mut command, "hysteron", &mut script);
    let mut out = std::io::stdout().lock();
    out.write_all(&script)?;
    Ok(out.flush()?)
}

pub(crate) fn man(args: &args::Man) -> Result<()> {
    let mut command = args::Cli::command();
    // Names of subcommands and what they inherit are filled in.
    command.build();
    let mut folder = AtomicFolder::create(args.force.target(&args.out, &[]), None)?;
    let mut count = 0;
    for command in with_subcommands(&command) {
        let source = concat!("hysteron ", env!("CARGO_PKG_VERSION"));
        let page = Man::new(command.clone()).source(source);
        let name = page.get_filename();
        folder.file(&name, |path| {
            let mut text = Vec::new();
            let written = page
                .render(&mut text)
                .and_then(|()| std::fs::write(path, text));
            written.map_err(|source| Error::File {
                path: PathBuf::from(&name),
                source,
            })
        })?;
        count += 1;
    }
    folder.commit()?;
    let folder = args.out.display();
    print(&format!(
        "{count} pages in {folder}; read one with `man {folder}/hysteron.1`"
    ))
}

/// A command, and all below it that are shown in its help.
fn with_subcommands(command: &Command) -> Vec<&Command> {
    let below = command.get_subcommands();
    let below = below.filter(|one| !one.is_hide_set() && one.get_name() != "help");
    std::iter::once(command)
        .chain(below.flat_map(with_subcommands))
        .collect()
}

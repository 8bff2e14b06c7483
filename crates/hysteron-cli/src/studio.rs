//! `hysteron studio`

use crate::args;
use crate::terminal::{Result, print, say};
use hysteron_studio::{Fault, Server};
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::mpsc::{Sender, channel};

/// How the studio is told to end, while one runs.
static STOP: Mutex<Option<Sender<()>>> = Mutex::new(None);

/// Ends a studio that runs; false if none does.
pub(crate) fn stop() -> bool {
    let sender = STOP.lock().ok().and_then(|mut stop| stop.take());
    sender.is_some_and(|sender| sender.send(()).is_ok())
}

pub(crate) fn run(args: &args::Studio) -> Result<()> {
    let mut server = Server::bind(args.port, args.memory.limit())?;
    if let Some(session) = &args.session {
        server.keep(session).map_err(worded)?;
    }
    for file in &args.files {
        server.open(file).map_err(worded)?;
    }
    let (sender, receiver) = channel();
    if let Ok(mut stop) = STOP.lock() {
        *stop = Some(sender);
    }
    let address = server.address()?;
    print(&address)?;
    say(format_args!(
        "the studio is open at this address; Ctrl-C ends it"
    ));
    // It is there as long as the studio is.
    let door = match args.no_open {
        true => None,
        false => door(&address).ok(),
    };
    if !args.no_open && !door.as_ref().is_some_and(|door| open(door.path())) {
        say(format_args!(
            "no browser was found: open the address in yours"
        ));
    }
    Ok(server.run(receiver)?)
}

fn worded(fault: Fault) -> String {
    match fault.remedy {
        Some(remedy) => format!("{}: {remedy}", fault.problem),
        None => fault.problem,
    }
}

/// A page on the disk that leads to the address. Only the user may read it. What is handed to the
/// browser is its name: the arguments of programs, and so the secret in an address, can be read by
/// every user of the machine.
fn door(address: &str) -> std::io::Result<tempfile::NamedTempFile> {
    let mut page = tempfile::Builder::new()
        .prefix("hysteron-studio-")
        .suffix(".html")
        .tempfile()?;
    write!(
        page,
        "<!doctype html><meta charset=\"utf-8\"><meta name=\"referrer\" content=\"no-referrer\">\n\
         <meta http-equiv=\"refresh\" content=\"0;url={address}\">\n\
         <title>hysteron studio</title><a href=\"{address}\">hysteron studio</a>\n"
    )?;
    page.flush()?;
    Ok(page)
}

/// Opens a page in the user's browser.
fn open(page: &Path) -> bool {
    let (program, before): (&str, &[&str]) = if cfg!(target_os = "macos") {
        ("open", &[])
    } else if cfg!(windows) {
        ("rundll32", &["url.dll,FileProtocolHandler"])
    } else {
        ("xdg-open", &[])
    };
    let mut command = Command::new(program);
    command.args(before).arg(page);
    let quiet = command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    quiet.spawn().is_ok()
}

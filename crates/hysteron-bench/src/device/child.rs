//! A child process on its standard input and output.

use super::line::{Line, Received};
use super::wires::Wires;
use std::io;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

/// A child, which does not outlive the run.
pub(super) struct Child {
    child: std::process::Child,
    wires: Wires,
    /// Whether it has been waited for.
    over: bool,
}

impl Child {
    pub(super) fn start(words: &[String], folder: &Path) -> io::Result<Self> {
        let (program, arguments) = words
            .split_first()
            .ok_or_else(|| io::Error::other("a program is needed"))?;
        let folder = match folder == Path::new("") {
            true => Path::new("."),
            false => folder,
        };
        // A path is from the folder of the file; a name is looked for as a shell does.
        let path = Path::new(program);
        let program = match path.is_relative() && path.components().count() > 1 {
            true => folder.canonicalize()?.join(path),
            false => path.to_owned(),
        };
        let mut command = Command::new(program);
        command
            .args(arguments)
            .current_dir(folder)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped());
        // A group of its own: Ctrl-C in the terminal is for the host, which then tells the device.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = command.spawn()?;
        let (to, from) = (child.stdin.take(), child.stdout.take());
        let (Some(to), Some(from)) = (to, from) else {
            return Err(io::Error::other("it has no standard input or output"));
        };
        let wires = Wires::new(from, to, Arc::default())?;
        Ok(Self {
            child,
            wires,
            over: false,
        })
    }

    /// How it ended by itself, if it does until the deadline.
    fn wait(&mut self, deadline: Instant) -> Option<String> {
        loop {
            match self.child.try_wait() {
                Ok(Some(status)) => {
                    self.over = true;
                    return Some(format!("the child ended with {status}"));
                }
                Ok(None) if Instant::now() < deadline => thread::sleep(Duration::from_millis(5)),
                _ => return None,
            }
        }
    }

    /// Ends it, and what it has started.
    fn kill(&mut self) {
        #[cfg(unix)]
        if let Some(group) = i32::try_from(self.child.id())
            .ok()
            .and_then(rustix::process::Pid::from_raw)
        {
            let _ = rustix::process::kill_process_group(group, rustix::process::Signal::KILL);
        }
        if !self.over {
            let _ = self.child.kill();
            let _ = self.child.wait();
            self.over = true;
        }
    }
}

impl Line for Child {
    fn send(&mut self, line: &str) -> io::Result<()> {
        self.wires.send(line)
    }

    fn receive(&mut self, deadline: Instant) -> Received {
        self.wires.receive(deadline)
    }

    fn close(mut self: Box<Self>, deadline: Instant) -> Option<String> {
        self.wires.finish(deadline);
        let how = self.wait(deadline);
        self.kill();
        how
    }
}

impl Drop for Child {
    fn drop(&mut self) {
        if !self.over {
            self.kill();
        }
    }
}

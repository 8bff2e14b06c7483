//! A serial line, raw: eight bits, no parity, no flow control.

use super::wires::Wires;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// A read that ends at once, so many times in a row, is that of a line that was pulled out.
const PULLED: u32 = 20;

pub(super) fn open(path: &Path, baud: u32) -> io::Result<Wires> {
    let port = raw(path, baud)?;
    let closed = Arc::new(AtomicBool::new(false));
    let from = Polled {
        port: port.try_clone()?,
        closed: Arc::clone(&closed),
    };
    Wires::new(from, port, closed)
}

#[cfg(unix)]
fn raw(path: &Path, baud: u32) -> io::Result<File> {
    use rustix::fs::{Mode, OFlags};
    use rustix::termios::{
        ControlModes, OptionalActions, SpecialCodeIndex, ioctl_tiocexcl, tcgetattr, tcsetattr,
    };
    // Without waiting for a carrier, which a board does not give.
    let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
    let port = rustix::fs::open(path, flags, Mode::empty())?;
    let mut settings = tcgetattr(&port)?;
    ioctl_tiocexcl(&port)?;
    settings.make_raw();
    settings.set_speed(baud)?;
    settings.control_modes |= ControlModes::CLOCAL | ControlModes::CREAD;
    settings.control_modes -= ControlModes::CRTSCTS;
    // A read waits a tenth of a second.
    settings.special_codes[SpecialCodeIndex::VMIN] = 0;
    settings.special_codes[SpecialCodeIndex::VTIME] = 1;
    tcsetattr(&port, OptionalActions::Now, &settings)?;
    rustix::fs::fcntl_setfl(&port, OFlags::RDWR)?;
    Ok(File::from(port))
}

/// The system's settings of the port stay: `mode COM3: baud=115200` sets them.
#[cfg(not(unix))]
fn raw(path: &Path, _baud: u32) -> io::Result<File> {
    File::options().read(true).write(true).open(path)
}

/// A port whose reads end when nothing comes, until the line is closed.
struct Polled {
    port: File,
    closed: Arc<AtomicBool>,
}

impl Read for Polled {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let mut at_once = 0;
        while !self.closed.load(Ordering::SeqCst) && at_once < PULLED {
            let before = Instant::now();
            let count = self.port.read(bytes)?;
            if count > 0 {
                return Ok(count);
            }
            match before.elapsed() < Duration::from_millis(10) {
                true => at_once += 1,
                false => at_once = 0,
            }
        }
        Ok(0)
    }
}

//! A file that one program at a time may write.

use std::fs::{File, TryLockError};
use std::io;
use std::ops::{Deref, DerefMut};
use std::time::Duration;

/// Number of attempts to lock a file, and the pause after each: two seconds in all.
const ATTEMPTS: usize = 40;
const PAUSE: Duration = Duration::from_millis(50);

/// A file with a lock, which nobody holds any more once this is dropped.
///
/// A child shares the open files of its parent, and with them their locks, from the moment that the
/// system makes it until it runs a program of its own. Closing a file in the parent then leaves the
/// lock with the child. So the lock is given back by name, which ends it for both. A parent that is
/// killed gives nothing back: who finds a lock waits a moment for its child.
#[derive(Debug)]
pub struct Locked(File);

impl Locked {
    /// Locks the file, or waits for up to two seconds.
    ///
    /// # Errors
    /// [`io::ErrorKind::ResourceBusy`]: another process keeps the lock.
    pub fn new(file: File) -> io::Result<Self> {
        Self::waiting(file, || std::thread::sleep(PAUSE))
    }

    fn waiting(file: File, mut pause: impl FnMut()) -> io::Result<Self> {
        for _ in 0..ATTEMPTS {
            match file.try_lock() {
                Err(TryLockError::WouldBlock) => pause(),
                // File systems without locks have none to respect either.
                Ok(()) | Err(TryLockError::Error(_)) => return Ok(Self(file)),
            }
        }
        let problem = "another process is writing this file: let it end, or name another file";
        Err(io::Error::new(io::ErrorKind::ResourceBusy, problem))
    }
}

impl Drop for Locked {
    fn drop(&mut self) {
        // Where it fails, closing the file gives the lock back.
        let _ = self.0.unlock();
    }
}

impl Deref for Locked {
    type Target = File;

    fn deref(&self) -> &File {
        &self.0
    }
}

impl DerefMut for Locked {
    fn deref_mut(&mut self) -> &mut File {
        &mut self.0
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A second handle to the same open file is what a child has before it runs its own program.
    #[test]
    fn a_child_that_is_being_started_keeps_no_lock() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        let first = Locked::new(File::create(&path).unwrap()).unwrap();
        let of_the_child = first.try_clone().unwrap();
        drop(first);
        let never = || unreachable!("the lock was given back");
        assert!(Locked::waiting(File::open(&path).unwrap(), never).is_ok());
        drop(of_the_child);
    }

    /// The child of a program that was killed, which has given nothing back.
    #[test]
    fn a_lock_is_waited_for_as_long_as_the_bound_says() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        let held = File::create(&path).unwrap();
        held.lock().unwrap();
        let mut pauses = 0;
        let refused = Locked::waiting(File::open(&path).unwrap(), || pauses += 1);
        assert!(refused.is_err_and(|error| error.to_string().contains("another process")));
        assert_eq!(pauses, ATTEMPTS);

        let mut of_the_child = Some(held);
        let mut pauses = 0;
        let ends = || {
            pauses += 1;
            of_the_child.take_if(|_| pauses == ATTEMPTS - 1);
        };
        assert!(Locked::waiting(File::open(&path).unwrap(), ends).is_ok());
        assert_eq!(pauses, ATTEMPTS - 1);
    }
}

//! Computes the hash of a file while it is read, because a pipe can be read only once.

use sha2::{Digest, Sha256};
use std::cell::RefCell;
use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::rc::Rc;

/// The hash of the bytes that have passed through a [`Hashing`].
#[derive(Clone, Default)]
pub struct Hash(Rc<RefCell<Sha256>>);

impl Hash {
    /// SHA-256 of a whole file, in hexadecimal.
    pub fn file(path: &Path) -> std::io::Result<String> {
        let hash = Self::default();
        let mut file = Hashing::new(File::open(path)?, Some(hash.clone()));
        std::io::copy(&mut file, &mut std::io::sink())?;
        Ok(hash.finish())
    }

    /// SHA-256 of bytes, in hexadecimal.
    pub fn bytes(bytes: &[u8]) -> String {
        let hash = Self::default();
        hash.0.borrow_mut().update(bytes);
        hash.finish()
    }

    /// The hash in hexadecimal. After this call, the hash starts again from empty.
    pub fn finish(&self) -> String {
        let bytes = self.0.take().finalize();
        bytes.iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// A reader that hashes the bytes that pass through it, if asked to.
pub struct Hashing<R> {
    file: R,
    hash: Option<Hash>,
}

impl<R: Read> Hashing<R> {
    /// Reads `file`, and hashes what is read with `hash`.
    pub fn new(file: R, hash: Option<Hash>) -> Self {
        Self { file, hash }
    }
}

impl<R: Read> Read for Hashing<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let count = self.file.read(buffer)?;
        if let Some(hash) = &self.hash {
            hash.0.borrow_mut().update(&buffer[..count]);
        }
        Ok(count)
    }
}

//! The list of files that hysteron wrote into a folder, with their digests. It shows which files in
//! the folder are ours and unchanged.
//!
//! The format can also be read by `sha256sum -c`.

use crate::hashing::Hash;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::io;
use std::path::Path;

/// The file name of the list.
pub(crate) const NAME: &str = "hysteron.sha256";

/// The first line of a list.
const HEAD: &str =
    "# Files of hysteron. As long as one is as listed here, another run may replace it.";

/// File names and digests of one folder, without its subfolders.
#[derive(Default)]
pub(crate) struct Manifest(BTreeMap<String, String>);

impl Manifest {
    /// Reads the list of a folder; empty if there is none, or if a file of that name is something
    /// else.
    pub(crate) fn read(folder: &Path) -> Self {
        let text = std::fs::read_to_string(folder.join(NAME)).unwrap_or_default();
        Self::parse(&text).unwrap_or_default()
    }

    fn parse(text: &str) -> Option<Self> {
        let rest = text.strip_prefix(HEAD)?.strip_prefix('\n')?;
        let entries = rest.lines().map(|line| {
            let (digest, name) = line.split_once("  ")?;
            Some((name.to_owned(), digest.to_owned()))
        });
        entries.collect::<Option<_>>().map(Self)
    }

    /// Adds a file of a folder.
    pub(crate) fn add(&mut self, folder: &Path, name: &str) -> io::Result<()> {
        let digest = Hash::file(&folder.join(name))?;
        self.0.insert(name.to_owned(), digest);
        Ok(())
    }

    /// The text of the list.
    pub(crate) fn text(&self) -> String {
        let mut text = format!("{HEAD}\n");
        for (name, digest) in &self.0 {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{digest}  {name}");
        }
        text
    }

    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str)
    }

    /// Whether a file of the folder is the list itself, or matches its digest in the list. A link
    /// does not.
    pub(crate) fn owns(&self, folder: &Path, name: &str) -> io::Result<bool> {
        let path = folder.join(name);
        if !std::fs::symlink_metadata(&path)?.is_file() {
            return Ok(false);
        }
        if name == NAME {
            return Ok(Self::parse(&std::fs::read_to_string(path).unwrap_or_default()).is_some());
        }
        match self.0.get(name) {
            Some(digest) => Ok(*digest == Hash::file(&path)?),
            None => Ok(false),
        }
    }

    /// Whether a folder contains only files that are ours, and subfolders of the same kind. An
    /// empty subfolder is not ours, because we make none.
    pub(crate) fn owns_all(folder: &Path) -> io::Result<bool> {
        let listed = Self::read(folder);
        for entry in std::fs::read_dir(folder)? {
            let entry = entry?;
            let name = entry.file_name();
            let ours = match (entry.file_type()?.is_dir(), name.to_str()) {
                (true, _) => {
                    let path = entry.path();
                    std::fs::read_dir(&path)?.next().is_some() && Self::owns_all(&path)?
                }
                (false, Some(name)) => listed.owns(folder, name)?,
                (false, None) => false,
            };
            if !ours {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

//! Writes the studio as a folder that any server of files can give: the page, and beside it the
//! session as WebAssembly. `tools/static-studio` builds the latter and runs this.
//!
//! `static_studio FOLDER SESSION.wasm`

use hysteron_files::{AtomicFile, AtomicFolder, Own};
use hysteron_studio::{STATIC_SESSION, static_page};
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [target, session] = &arguments[..] else {
        return Err("usage: static_studio FOLDER SESSION.wasm".into());
    };
    let session = std::fs::read(session)?;
    let mut folder = AtomicFolder::create(target, None)?;
    let mut write = |name: &str, bytes: &[u8]| {
        folder.file(name, |path| {
            AtomicFile::create(path, Own::SAME_BYTES)?.commit_with(bytes)
        })
    };
    for file in static_page() {
        write(file.name, file.text.as_bytes())?;
    }
    write(STATIC_SESSION, &session)?;
    folder.commit()?;
    println!("{}: session of {} bytes", target.display(), session.len());
    Ok(())
}

//! Writes the test vectors that every surface must reproduce: `cargo run -p hysteron --example
//! vectors -- vectors`

mod chain;
mod make;
mod plain;
mod staged;

use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("name the folder: vectors")?;
    let folder = PathBuf::from(folder);
    for (name, text) in make::all()? {
        std::fs::write(folder.join(name), text)?;
    }
    Ok(())
}

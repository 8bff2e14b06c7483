//! Packs plotly.js, which the crate `plotly` carries, for the pages that draw with it.

use flate2::{Compression, write::GzEncoder};
use std::io::{Error, Write};
use std::path::PathBuf;

fn main() -> std::io::Result<()> {
    println!("cargo:rerun-if-changed=build.rs");
    let folder = std::env::var_os("OUT_DIR").ok_or_else(|| Error::other("cargo gives OUT_DIR"))?;
    let scripts = plotly::Plot::offline_js_sources();
    let script = first(&scripts).ok_or_else(|| Error::other("plotly carries no plotly.js"))?;
    let mut packed = GzEncoder::new(Vec::new(), Compression::best());
    packed.write_all(script.as_bytes())?;
    std::fs::write(PathBuf::from(folder).join("plotly.js.gz"), packed.finish()?)
}

/// The first script of `elements`: plotly.js, which others follow.
fn first(elements: &str) -> Option<&str> {
    const ELEMENT: &str = "<script type=\"text/javascript\">";
    let rest = elements.strip_prefix(ELEMENT)?;
    // A later element begins where the last of these marks is.
    let script = rest.rsplit_once(ELEMENT).map_or(rest, |(first, _)| first);
    let script = script.trim_end().strip_suffix("</script>")?;
    script.contains("plotly.js v").then_some(script)
}

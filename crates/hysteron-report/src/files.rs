//! The files of a report: each appears complete or not at all.

use crate::error::ReportError;
use crate::png;
use hysteron::printable;
use std::fmt::Display;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Writes each of `figures` that there is as SVG and PNG into `dir`, which is made if absent, and around them the page
/// that `page` makes. Files of the others, which an earlier report may have left, are removed.
///
/// Returns the paths written, the page first.
pub(crate) fn write_report<F: Display>(
    dir: &Path,
    figures: impl Iterator<Item = (F, Option<String>)>,
    page: impl FnOnce(&[(F, String)]) -> String,
) -> Result<Vec<PathBuf>, ReportError> {
    fs::create_dir_all(dir).map_err(|source| in_the_way(dir, source))?;
    let index = dir.join("index.html");
    let mut drawn = Vec::new();
    let mut written = vec![index.clone()];
    for (figure, svg) in figures {
        let [svg_path, png_path] =
            ["svg", "png"].map(|extension| dir.join(format!("{figure}.{extension}")));
        // Names come from anywhere; XML allows no control characters.
        let Some(svg) = svg.map(|svg| printable(&svg).into_owned()) else {
            remove_stale(&svg_path)?;
            remove_stale(&png_path)?;
            continue;
        };
        write(&svg_path, svg.as_bytes())?;
        let pixels = png::of_svg(&svg).map_err(|reason| ReportError::Raster {
            path: png_path.clone(),
            reason,
        })?;
        write(&png_path, &pixels)?;
        written.extend([svg_path, png_path]);
        drawn.push((figure, svg));
    }
    // The page comes last, so that a page in the directory means a complete report.
    write(&index, printable(&page(&drawn)).as_bytes())?;
    Ok(written)
}

fn write(path: &Path, content: &[u8]) -> Result<(), ReportError> {
    Ok(hysteron::AtomicFile::write_all(path, content)?)
}

fn remove_stale(path: &Path) -> Result<(), ReportError> {
    match fs::remove_file(path) {
        Err(source) if source.kind() != io::ErrorKind::NotFound => Err(in_the_way(path, source)),
        _ => Ok(()),
    }
}

fn in_the_way(path: &Path, source: io::Error) -> ReportError {
    ReportError::Write(hysteron::Error::File {
        path: path.to_owned(),
        source,
    })
}

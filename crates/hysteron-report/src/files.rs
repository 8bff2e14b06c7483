//! The files of a report, which appear together.

use crate::error::ReportError;
use crate::png;
use hysteron::{AtomicFile, AtomicFolder, Own, printable};
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// Where a report goes: a folder that may hold other results too, and the report's own folder in it.
pub(crate) struct Place<'a> {
    pub(crate) folder: &'a mut AtomicFolder,
    pub(crate) within: &'a Path,
}

/// Writes each of `figures` that there is as SVG and PNG, and around them the page that `page` makes.
///
/// Returns the paths that the files will have, the page first.
pub(crate) fn write_report<F: Display>(
    place: Place<'_>,
    figures: impl Iterator<Item = (F, Option<String>)>,
    page: impl FnOnce(&[(F, String)]) -> String,
) -> Result<Vec<PathBuf>, ReportError> {
    let Place { folder, within } = place;
    let mut drawn = Vec::new();
    let mut names = vec![within.join("index.html")];
    for (figure, svg) in figures {
        // Names come from anywhere; XML allows no control characters.
        let Some(svg) = svg.map(|svg| printable(&svg).into_owned()) else {
            continue;
        };
        let [svg_name, png_name] =
            ["svg", "png"].map(|extension| within.join(format!("{figure}.{extension}")));
        write(folder, &svg_name, svg.as_bytes())?;
        let pixels = png::of_svg(&svg).map_err(|reason| ReportError::Raster {
            path: folder.path().join(&png_name),
            reason,
        })?;
        write(folder, &png_name, &pixels)?;
        names.extend([svg_name, png_name]);
        drawn.push((figure, svg));
    }
    write(folder, &names[0], printable(&page(&drawn)).as_bytes())?;
    Ok(names.iter().map(|name| folder.path().join(name)).collect())
}

fn write(folder: &mut AtomicFolder, name: &Path, content: &[u8]) -> Result<(), ReportError> {
    Ok(folder.file(name, |path| {
        AtomicFile::create(path, Own::SAME_BYTES)?.commit_with(content)
    })?)
}

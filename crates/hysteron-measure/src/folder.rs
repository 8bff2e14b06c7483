//! The recordings of a folder, with the columns that they are known to have.

use crate::genuine;
use crate::result::Result;
use hysteron::{Columns, Recording, TableReader};
use std::path::{Path, PathBuf};

/// What drives the actuator, the first of these that a recording has.
const INPUTS: [&str; 5] = [
    "temperature_C",
    "voltage_V",
    "duty",
    "current_A",
    "H_A_per_m",
];

/// What the actuator does, the first of these that a recording has.
const OUTPUTS: [&str; 10] = [
    "output",
    "strain",
    "strain_percent",
    "extension_mm",
    "position_m",
    "position",
    "BL_T",
    "polarization_uC_cm2",
    "displacement_nm",
    "B_T",
];

/// The folder of the recordings, the first of the arguments.
pub fn named(arguments: &[String]) -> Result<PathBuf> {
    let named = arguments
        .first()
        .ok_or("name the folder of the recordings")?;
    Ok(named.into())
}

/// A name, and the recording if the file has known columns.
type Named = (String, Option<Recording>);

/// Every recording of a folder, by name.
pub fn recordings(folder: &Path) -> Result<Vec<Named>> {
    let mut names: Vec<String> = std::fs::read_dir(folder)?
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| name.ends_with(".csv") && name != "MANIFEST.csv")
        .collect();
    names.sort();
    let mut all = Vec::new();
    for name in names {
        let path = folder.join(&name);
        let table = TableReader::open(&path)?;
        let find = |known: &[&'static str]| {
            let mut known = known.iter().copied();
            known.find(|k| table.header().iter().any(|h| h == k))
        };
        let recording = match (find(&INPUTS), find(&OUTPUTS)) {
            (Some(input), Some(output)) => Some(genuine::read(&path, Columns::new(input, output))?),
            _ => None,
        };
        all.push((name.trim_end_matches(".csv").to_owned(), recording));
    }
    Ok(all)
}

//! Files for methods of others: the tasks as tables, and the predictions that come back.

use super::splits::{Set, Split};
use crate::result::Result;
use hysteron::{Columns, Recording, Repair};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// A method of somebody else: a name for the table, and a folder of predictions.
pub struct Entry {
    pub name: String,
    folder: PathBuf,
}

impl Entry {
    /// From `NAME=FOLDER`.
    pub fn parse(text: &str) -> Result<Self> {
        let (name, folder) = text.split_once('=').ok_or("--entry wants NAME=FOLDER")?;
        Ok(Self {
            name: name.into(),
            folder: folder.into(),
        })
    }

    /// The column `output_model` of `SPLIT.csv`; `None` where there is no such file.
    pub fn predict(&self, split: &Split) -> Result<Option<Vec<f64>>> {
        let path = self.folder.join(format!("{}.csv", split.name));
        if !path.exists() {
            return Ok(None);
        }
        let columns = Columns::new("input", "output_model");
        let predicted = Recording::read(&path, columns, Repair::Refuse)?.0.output;
        if predicted.len() != split.test.len() {
            let (path, rows) = (path.display(), split.test.len());
            let have = predicted.len();
            return Err(format!("{path} has {have} rows, and {rows} are needed").into());
        }
        Ok(Some(predicted))
    }
}

/// Writes `SPLIT-train-N.csv` and `SPLIT-test.csv` for every task. The test has no outputs.
pub fn write(sets: &[Set], folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder)?;
    for split in sets.iter().flat_map(|set| &set.splits) {
        for (n, training) in split.training.iter().enumerate() {
            let name = format!("{}-train-{}.csv", split.name, n + 1);
            std::fs::write(folder.join(name), table(training, Last::Output)?)?;
        }
        let name = format!("{}-test.csv", split.name);
        std::fs::write(
            folder.join(name),
            table(&split.test, Last::Scored(&split.scored))?,
        )?;
    }
    Ok(())
}

/// The last column of a table.
enum Last<'a> {
    Output,
    Scored(&'a [bool]),
}

fn table(recording: &Recording, last: Last<'_>) -> Result<String> {
    let series = [
        // History that was put before a test has no time.
        ("time_s", recording.time.as_ref()),
        ("input", Some(&recording.input)),
        ("load", recording.load.as_ref()),
    ];
    let present = || {
        series
            .iter()
            .filter_map(|(name, values)| Some((name, (*values)?)))
    };
    let mut text = String::new();
    present().for_each(|(name, _)| text += &format!("{name},"));
    text += match last {
        Last::Output => "output\n",
        Last::Scored(_) => "scored\n",
    };
    for n in 0..recording.len() {
        for (_, values) in present() {
            write!(text, "{},", values[n])?;
        }
        match last {
            Last::Output => writeln!(text, "{}", recording.output[n])?,
            Last::Scored(scored) => writeln!(text, "{}", u8::from(scored[n]))?,
        }
    }
    Ok(text)
}

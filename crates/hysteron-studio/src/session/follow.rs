//! A drive follows a path: typed, drawn, or a column of a file; and what came of it, as a table.

use super::drive::Drive;
use super::fault::Fault;
use super::id::Id;
use super::opened::Opened;
use super::path::{Followed, Path, Row, Side};
use super::state::Session;
use hysteron::{Budget, Policy, TableReader, TableWriter, headings};
use serde::Deserialize;
use std::sync::Arc;

/// The most samples of a path in a file.
const LONGEST: usize = 100_000;

/// A column of a file for a drive to follow.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct Follow {
    /// The drive.
    pub drive: Id,
    /// The file.
    pub file: Id,
    /// Its column.
    pub column: String,
    /// What the column is.
    pub of: Side,
    /// What the inverse does when the target reverses.
    #[serde(default)]
    pub policy: Policy,
    /// Time between two samples in seconds, where the file has no time.
    #[serde(default)]
    pub dt: Option<f64>,
    /// The load, where the file has none.
    #[serde(default)]
    pub load: Option<f64>,
}

impl Drive {
    /// Follows a path to its end. One that is refused at its middle moves nothing.
    ///
    /// # Errors
    /// [`Fault`] for a sample that cannot be.
    pub(super) fn follow(
        &mut self,
        path: &Path<'_>,
        policy: Policy,
        held: Option<Budget>,
    ) -> Result<(), Fault> {
        let mut moved = self.clone();
        // A hand does not draw smaller turns on purpose.
        let still = 0.002 * (moved.outputs.1 - moved.outputs.0).abs();
        let ahead = match path.of {
            Side::Inputs => Vec::new(),
            Side::Outputs => headings(path.values, still),
        };
        let (usual, mut rows, mut time) = (moved.dt, Vec::new(), 0.0);
        for (n, &value) in path.values.iter().enumerate() {
            if let (Some(times), true) = (path.time, n > 0) {
                moved.dt = times[n] - times[n - 1];
            }
            moved.load = match path.load {
                Some(load) if moved.load.is_some() => Some(load[n]),
                _ => moved.load,
            };
            match path.of {
                Side::Inputs => moved.push(value)?,
                Side::Outputs => moved.pull(value, policy, Some(ahead[n]))?,
            }
            time += if n > 0 { moved.dt } else { 0.0 };
            rows.push(Row {
                time: path.time.map_or(time, |times| times[n]),
                asked: value,
                input: moved.way.input,
                output: moved.way.output,
                status: moved.way.status,
            });
        }
        moved.dt = usual;
        moved.followed = Some(Arc::new(Followed {
            of: path.of,
            rows,
            _held: held,
        }));
        *self = moved;
        Ok(())
    }
}

impl Opened {
    /// A column, with the time and the load beside it. Where it is the input or the output of the
    /// recording, it is what was read, repaired and prepared of it.
    fn path(&self, column: &str) -> Result<[Option<Vec<f64>>; 3], Fault> {
        let is = |role: &Option<String>| role.as_deref() == Some(column);
        if let Ok(recording) = self.recording() {
            let (time, load) = (recording.time.clone(), recording.load.clone());
            if is(&self.roles.input) {
                return Ok([Some(recording.input.clone()), time, load]);
            }
            if is(&self.roles.output) {
                return Ok([Some(recording.output.clone()), time, load]);
            }
        }
        let memory = self.memory().clone();
        let mut table = TableReader::from_bytes(&self.name, self.bytes.clone(), memory)?;
        let time = self.roles.time.as_deref().filter(|name| *name != column);
        let load = self.roles.load.as_deref().filter(|name| *name != column);
        let columns = [
            Some(table.column(column)?),
            time.map(|name| table.time_column(name)).transpose()?,
            load.map(|name| table.column(name)).transpose()?,
        ];
        let mut series = columns.map(|column| column.map(|_| Vec::new()));
        while table.advance()? {
            for (values, column) in series.iter_mut().zip(columns) {
                if let (Some(values), Some(column)) = (values, column) {
                    values.push(table.number(column)?);
                }
            }
            // A longer one is refused whatever comes.
            if series[0]
                .as_ref()
                .is_some_and(|values| values.len() > LONGEST)
            {
                break;
            }
        }
        Ok(series)
    }
}

impl Session {
    /// Lets a drive follow a column of a file.
    pub(super) fn follow(&mut self, wish: &Follow) -> Result<(), Fault> {
        let [values, time, load] = self.file(wish.file)?.path(&wish.column)?;
        let values = values.unwrap_or_default();
        if values.is_empty() || values.len() > LONGEST {
            return Err(Fault::missing(
                &format!("a path in a file has one sample or more, and up to {LONGEST}"),
                "use `hysteron invert` or `hysteron simulate` for a longer one",
            ));
        }
        let bytes = (values.len() * size_of::<Row>()) as u64;
        let held = self.held(bytes, "a path")?;
        let drive = self.drives.get_mut(&wish.drive);
        let drive = drive.ok_or_else(|| Fault::gone("drive", wish.drive))?;
        drive.takes(wish.dt, wish.load);
        let path = Path {
            of: wish.of,
            values: &values,
            time: time.as_deref(),
            load: load.as_deref(),
        };
        drive.follow(&path, wish.policy, Some(held))
    }

    /// What came of the last path of a drive, as CSV.
    pub(super) fn followed_table(&self, drive: Id) -> Result<Vec<u8>, Fault> {
        let found = self.drives.get(&drive);
        let drive = found.ok_or_else(|| Fault::gone("drive", drive))?;
        let nothing = || Fault::missing("no path was followed", "follow one first");
        let followed = drive.followed.as_ref().ok_or_else(nothing)?;
        let (input, output) = (
            drive.model().input.to_column(),
            drive.model().output.to_column(),
        );
        let mut table = TableWriter::in_memory("way.csv", &self.memory)?;
        let asked = (followed.of == Side::Outputs).then(|| format!("wanted {output}"));
        let names = ["time [s]".to_owned()].into_iter().chain(asked);
        let mut names: Vec<String> = names.chain([input, format!("modelled {output}")]).collect();
        names.extend((followed.of == Side::Outputs).then(|| "status".to_owned()));
        table.row(&names)?;
        for row in &followed.rows {
            let mut cells = vec![row.time.to_string()];
            cells.extend((followed.of == Side::Outputs).then(|| row.asked.to_string()));
            cells.extend([row.input.to_string(), row.output.to_string()]);
            cells.extend((followed.of == Side::Outputs).then(|| row.status.to_owned()));
            table.row(&cells)?;
        }
        Ok(table.into_bytes()?)
    }
}

//! A file as the page shows it.

use super::fault::Fault;
use super::id::Id;
use super::opened::{Opened, Part, Purpose, RepairView};
use super::parts::Parts;
use super::prepare::Steps;
use hysteron::{ColumnSummary, Preparation, Quantity, Recording, Repairs, RoleDoubt};
use serde::Serialize;

/// A column as the page shows it.
#[derive(Debug, Clone, Serialize)]
pub struct ColumnView {
    /// Name, smallest and largest number, cells that are no numbers.
    #[serde(flatten)]
    pub summary: ColumnSummary,
    /// The smallest and the largest number in each part of the rows.
    pub picture: Vec<Option<(f64, f64)>>,
}

/// A file as the page shows it.
#[derive(Debug, Clone, Serialize)]
pub struct FileView {
    /// Its number.
    pub id: Id,
    /// Its name, without a folder.
    pub name: String,
    /// Its size in bytes.
    pub bytes: usize,
    /// Tells versions of a file apart.
    pub digest: u64,
    /// Rows below the header.
    pub rows: u64,
    /// Its columns.
    pub columns: Vec<ColumnView>,
    /// What each column is.
    pub roles: Part,
    /// Why these were guessed.
    pub reasons: Vec<String>,
    /// The roles without a column, and the columns that may have them.
    pub doubts: Vec<RoleDoubt>,
    /// How the file was understood, and what was repaired.
    pub notes: Vec<String>,
    /// What is wrong with it as a recording.
    pub problem: Option<Fault>,
    /// What a repair would do, where there is something wrong that it mends.
    pub repair: Option<RepairView>,
    /// The steps of its preparation; `None` if it is taken as it is.
    pub steps: Option<Steps>,
    /// What the preparation did, for each recording.
    pub preparation: Vec<Preparation>,
    /// Where in the file the repaired samples of input and output stand that it lists.
    pub prepared_at: Vec<[Vec<String>; 2]>,
    /// Whether rows are repaired.
    pub mend: bool,
    /// What it is for.
    pub purpose: Purpose,
    /// Spans of rows marked for validation, in order, counted from 1.
    pub marked: Vec<(usize, usize)>,
    /// Samples of its recordings.
    pub samples: usize,
    /// The first sample of each recording, counted from 1: the actuator's history does not go on.
    pub begins: Vec<usize>,
    /// The time of the first and of the last sample of each recording.
    pub spans: Vec<(f64, f64)>,
    /// Branches of its input.
    pub branches: usize,
    /// The input, with its unit.
    pub input: Option<String>,
    /// The output, with its unit.
    pub output: Option<String>,
}

impl Opened {
    /// What is still in doubt: a role that was given to a column is settled, and so is its column.
    fn doubts(&self) -> Vec<RoleDoubt> {
        let Part {
            input,
            output,
            time,
            load,
        } = &self.roles;
        let open = |doubt: &&RoleDoubt| match doubt.role {
            "input" => input.is_none(),
            _ => output.is_none(),
        };
        let is_free = |name: &str| {
            let taken = [input, output, time, load];
            taken.iter().all(|role| role.as_deref() != Some(name))
        };
        let doubts = self.preview.roles.doubts.iter().filter(open).cloned();
        let free = doubts.map(|mut doubt| {
            doubt.candidates.retain(|(name, _)| is_free(name));
            doubt
        });
        free.collect()
    }

    /// The places of the samples that a preparation lists, which counts within each recording.
    fn prepared_at(&self) -> Vec<[Vec<String>; 2]> {
        let Some(raw) = self.raw() else {
            return Vec::new();
        };
        let each = self.preparation.iter().zip(raw.begins());
        let each = each.map(|(done, begin)| {
            let places = |repairs: &Repairs| {
                let samples = repairs.first.iter();
                let places = samples.filter_map(|first| raw.place(begin + first - 1));
                places.map(|place| place.to_string()).collect()
            };
            let spikes = done.spikes.as_ref();
            spikes.map_or_else(Default::default, |of| {
                [places(&of.input), places(&of.output)]
            })
        });
        each.collect()
    }

    pub(super) fn view(&self) -> FileView {
        let columns = self
            .preview
            .table
            .columns
            .iter()
            .zip(&self.preview.pictures);
        let columns = columns.map(|(summary, picture)| ColumnView {
            summary: summary.clone(),
            picture: picture.clone(),
        });
        let recording = self.recording().ok();
        let begins = self.parts.iter().flat_map(Parts::begins);
        let shown = |of: fn(&Recording) -> &Quantity| recording.map(|r| of(r).to_column());
        FileView {
            id: self.id,
            name: self.name.clone(),
            bytes: self.bytes.len(),
            digest: self.digest,
            rows: self.preview.table.rows,
            columns: columns.collect(),
            roles: self.roles.clone(),
            reasons: self.preview.roles.reasons.clone(),
            doubts: self.doubts(),
            notes: self.notes.clone(),
            problem: self.parts.as_ref().err().cloned(),
            repair: self.repair.clone(),
            steps: self.steps.clone(),
            preparation: self.preparation.clone(),
            prepared_at: self.prepared_at(),
            mend: self.mend,
            purpose: self.purpose,
            marked: self.marked.clone(),
            samples: recording.map_or(0, |recording| recording.len()),
            begins: begins.map(|begin| begin + 1).collect(),
            spans: self.spans(),
            branches: self.branches,
            input: shown(|recording| &recording.input_quantity),
            output: shown(|recording| &recording.output_quantity),
        }
    }
}

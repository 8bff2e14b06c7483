//! Weights that depend on the load.

use super::lines::{Lines, Parsed};
use hysteron_core::{MAX_PARTS, Model, Parts};

/// The parts of the weights.
#[derive(Debug)]
pub(crate) struct ByLoad {
    range: (f64, f64),
    offsets: Vec<f64>,
    /// Everett tables, one after the other.
    tables: Vec<f64>,
}

impl ByLoad {
    /// Reads the lines before the weights.
    pub(crate) fn read(lines: &mut Lines<'_>) -> Parsed<Self> {
        let range = match lines.numbers("range")?[..] {
            [low, high] if low < high => (low, high),
            _ => return lines.fault("`range` and 2 numbers in order are expected"),
        };
        let offsets = lines.numbers("parts")?;
        if !(1..=MAX_PARTS).contains(&offsets.len()) {
            return lines.fault(format!("`parts` and 1 to {MAX_PARTS} numbers are expected"));
        }
        Ok(Self {
            range,
            offsets,
            tables: Vec::new(),
        })
    }

    /// How many parts there are.
    pub(crate) fn count(&self) -> usize {
        self.offsets.len()
    }

    /// The same with the weights of these models.
    pub(crate) fn with(self, models: &[Model<f64, Vec<f64>>]) -> Self {
        let tables = models.iter().flat_map(|model| model.table()).copied();
        Self {
            tables: tables.collect(),
            ..self
        }
    }

    /// As the core takes them.
    pub(crate) fn core(&self) -> Parts<'_, f64> {
        Parts {
            range: self.range,
            offsets: &self.offsets,
            tables: &self.tables,
        }
    }
}

//! The columns of a recording: as they were named, or as the table tells them.

use crate::args;
use crate::terminal::{Result, say};
use hysteron::{Columns, TablePreview, TableReader};
use std::path::Path;

/// Names of columns, some of which may not have been given.
#[derive(Default)]
pub(crate) struct Given<'a> {
    pub(crate) input: Option<&'a str>,
    pub(crate) output: Option<&'a str>,
    pub(crate) time: Option<&'a str>,
    pub(crate) load: Option<&'a str>,
}

impl<'a> Given<'a> {
    pub(crate) fn of(columns: &'a args::Columns, load: Option<&'a str>) -> Self {
        Self {
            input: columns.input.as_deref(),
            output: columns.output.as_deref(),
            time: columns.time.as_deref(),
            load,
        }
    }

    /// What is in a table of which these columns are known.
    pub(crate) fn preview(&self, table: &mut TableReader) -> Result<TablePreview> {
        let mut known = [None; 4];
        let names = [self.input, self.output, self.time, self.load];
        for (place, name) in known.iter_mut().zip(names) {
            if let Some(name) = name {
                *place = Some(table.column(name)?);
            }
        }
        Ok(hysteron::preview_table_knowing(table, known)?)
    }
}

/// Names of columns that are known.
pub(crate) struct Named {
    pub(crate) input: String,
    pub(crate) output: String,
    pub(crate) time: Option<String>,
    load: Option<String>,
    /// A load that the table has, and that is not taken.
    pub(crate) unused_load: Option<String>,
}

impl Named {
    /// The columns as they were named. What was not is told by the table: a log of `run` or `track`,
    /// or one whose columns leave no doubt. Its load is taken only if it is named: a model with a
    /// load is another one.
    pub(crate) fn of(path: &Path, given: &Given<'_>, repair: &args::Repair) -> Result<Self> {
        let owned = |name: Option<&str>| name.map(str::to_owned);
        if let (Some(input), Some(output)) = (given.input, given.output) {
            return Ok(Self {
                input: input.into(),
                output: output.into(),
                time: owned(given.time),
                load: owned(given.load),
                unused_load: None,
            });
        }
        let refused = |why: &str| {
            let path = path.display();
            format!("{path}: {why}: name them with --input and --output, or see `hysteron start`")
        };
        if path == Path::new("-") {
            return Err(refused("the columns of standard input are not looked for").into());
        }
        let mut table = TableReader::open_with(path, repair.max_memory())?;
        let roles = given.preview(&mut table)?.roles;
        let (Some(input), Some(output)) = (roles.input, roles.output) else {
            return Err(
                refused("the columns do not tell which is the input and the output").into(),
            );
        };
        say(format_args!(
            "{}: {}",
            path.display(),
            roles.reasons.join("; ")
        ));
        Ok(Self {
            input,
            output,
            time: roles.time,
            load: owned(given.load),
            unused_load: roles.load.filter(|_| given.load.is_none()),
        })
    }

    pub(crate) fn columns(&self) -> Columns<'_> {
        Columns {
            time: self.time.as_deref(),
            load: self.load.as_deref(),
            ..Columns::new(&self.input, &self.output)
        }
    }
}

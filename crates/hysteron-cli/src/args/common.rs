//! Options that several commands have.

use super::value::parse_bytes;
use clap::Args;
use hysteron::Destination;
use std::path::Path;

#[derive(Args)]
pub(crate) struct Json {
    /// Print one JSON object on standard output, and nothing else there
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args)]
pub(crate) struct Force {
    /// Also replace files that hysteron did not make, or that were changed since
    #[arg(long)]
    pub(crate) force: bool,
}

impl Force {
    /// A place for a result, which replaces none of the files that are read.
    pub(crate) fn target<'a>(&self, path: &'a Path, inputs: &'a [&'a Path]) -> Destination<'a> {
        Destination::keeping_foreign(path, self.force).made_from(inputs)
    }
}

/// Columns of a recording. What is not named, the table tells.
#[derive(Args)]
pub(crate) struct Columns {
    /// Column of the input [default: as the table tells: a log of `run` or `track`, or one whose
    /// columns leave no doubt]
    #[arg(long, value_name = "COL")]
    pub(crate) input: Option<String>,
    /// Column of the output [default: as for --input]
    #[arg(long, value_name = "COL")]
    pub(crate) output: Option<String>,
    /// Column of time, in seconds or with its unit in its name: for all that depends on time, a
    /// warning if loops depend on rate, and tables and figures over time
    #[arg(long, value_name = "COL")]
    pub(crate) time: Option<String>,
}

#[derive(Args)]
pub(crate) struct Repair {
    /// Repair the table and report it: drop rows that are cut short, lack a number or come twice;
    /// begin another segment where the clock goes back
    #[arg(long)]
    repair: bool,
    #[command(flatten)]
    memory: Memory,
}

/// Repairs of a table whose rows all stay.
#[derive(Args)]
pub(crate) struct Rows {
    /// Where the clock of --time goes back, begin another recording: the model begins anew
    #[arg(long)]
    repair: bool,
    #[command(flatten)]
    memory: Memory,
}

impl Rows {
    pub(crate) fn what(&self) -> hysteron::Repair {
        match self.repair {
            true => hysteron::Repair::Mend,
            false => hysteron::Repair::Refuse,
        }
    }

    pub(crate) fn max_memory(&self) -> u64 {
        self.memory.limit()
    }
}

#[derive(Args)]
pub(crate) struct Memory {
    /// Limit of the memory for the contents of a file, in bytes or with K, M or G [default: half of
    /// what is free]
    #[arg(long, value_name = "SIZE", value_parser = parse_bytes)]
    max_memory: Option<u64>,
}

impl Memory {
    pub(crate) fn limit(&self) -> u64 {
        self.max_memory
            .unwrap_or_else(hysteron::ReadOptions::usual_memory)
    }
}

impl From<&Repair> for hysteron::ReadOptions {
    fn from(args: &Repair) -> Self {
        Self {
            repair: args.what(),
            max_memory: args.memory.limit(),
        }
    }
}

impl Repair {
    pub(crate) fn is_asked(&self) -> bool {
        self.repair
    }

    pub(crate) fn what(&self) -> hysteron::Repair {
        match self.repair {
            true => hysteron::Repair::Mend,
            false => hysteron::Repair::Refuse,
        }
    }

    /// For tables that are read without repair.
    pub(crate) fn max_memory(&self) -> u64 {
        self.memory.limit()
    }
}

#[derive(Args)]
pub(crate) struct Load {
    /// For a model that depends on a load: the load, or its column
    #[arg(long, value_name = "LOAD|COL", allow_hyphen_values = true)]
    load: Option<String>,
}

impl Load {
    /// A number gives the model at that load; otherwise the model stays, and the column is
    /// returned.
    pub(crate) fn apply(
        &self,
        model: hysteron::Model,
    ) -> crate::terminal::Result<(hysteron::Model, Option<String>)> {
        match self.load.as_ref().map(|load| (load, load.parse())) {
            Some((_, Ok(load))) => Ok((model.at_load(load)?, None)),
            Some((column, Err(_))) => Ok((model, Some(column.clone()))),
            None => Ok((model, None)),
        }
    }
}

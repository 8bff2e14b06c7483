//! `read`.

use crate::choices::none_left;
use crate::convert::warn;
use crate::error::Raise;
use crate::recording::Recording;
use hysteron::{Columns, Quantity, ReadOptions, Repair};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// Read a recording from a CSV, Parquet, Arrow or MATLAB file.
///
/// `HysteronWarning` reports assumptions about the file, repaired rows and gaps in time.
///
/// Parameters
/// ----------
/// path : str or path-like
/// input, output : str
///     The columns, by name, with or without the unit in brackets, or by number from 1; in a MATLAB
///     file the variables, ``'M:2'`` being the second column of the matrix ``M`` and ``'s.x'`` the
///     field ``x`` of the structure ``s``.
/// time : str, optional
///     The column of time: in seconds, or with another unit in its name, or timestamps.
/// load : str, optional
///     The column of the load or stress.
/// input_name, output_name, load_name : str, optional
///     Names, with the unit in brackets. By default those of the file.
/// repair : bool
///     Drop rows that lack a number, are cut short or come twice. By default they are refused. Where
///     the clock goes back another recording begins: that is refused here.
/// max_memory : int, optional
///     Most memory in bytes that the contents of the file may take; more is refused. By default half
///     of what is free.
///
/// Returns
/// -------
/// Recording
///
/// Raises
/// ------
/// FileError
/// RecordingError
///     With line and column.
///
/// Examples
/// --------
/// >>> import os, tempfile
/// >>> path = os.path.join(tempfile.mkdtemp(), 'run.csv')
/// >>> _ = open(path, 'w').write('T [degC];lift\n20,5;0\n80;14\n')
/// >>> pyhysteron.read(path, input='T [degC]', output='lift').input
/// array([20.5, 80. ])
#[pyfunction]
#[pyo3(signature = (path, *, input, output, time=None, load=None, input_name=None, output_name=None, load_name=None, repair=false, max_memory=None, **unknown),
    text_signature = "(path, *, input, output, time=None, load=None, input_name=None, output_name=None, load_name=None, repair=False, max_memory=None)")]
#[allow(clippy::too_many_arguments)]
pub(crate) fn read(
    py: Python<'_>,
    path: PathBuf,
    input: &str,
    output: &str,
    time: Option<&str>,
    load: Option<&str>,
    input_name: Option<&str>,
    output_name: Option<&str>,
    load_name: Option<&str>,
    repair: bool,
    max_memory: Option<u64>,
    unknown: Option<&Bound<'_, PyDict>>,
) -> PyResult<Recording> {
    let names = [
        "input",
        "output",
        "time",
        "load",
        "input_name",
        "output_name",
        "load_name",
        "repair",
        "max_memory",
    ];
    none_left("read", unknown, &names)?;
    let columns = Columns {
        input,
        output,
        time,
        load,
    };
    let repair = match repair {
        true => Repair::Mend,
        false => Repair::Refuse,
    };
    let options = ReadOptions {
        repair,
        max_memory: max_memory.unwrap_or_else(ReadOptions::usual_memory),
    };
    let (mut recording, notes) =
        py.detach(|| hysteron::Recording::read(&path, columns, options).raise())?;
    for note in notes {
        warn(py, &format!("{}: {note}", path.display()))?;
    }
    let named = [
        (input_name, &mut recording.input_quantity),
        (output_name, &mut recording.output_quantity),
        (load_name, &mut recording.load_quantity),
    ];
    for (name, quantity) in named {
        if let Some(name) = name {
            *quantity = Quantity::from_column(name);
        }
    }
    Ok(recording.into())
}

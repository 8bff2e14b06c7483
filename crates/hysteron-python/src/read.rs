//! `read` and `read_segments`.

use crate::choices::none_left;
use crate::convert::warn;
use crate::error::Raise;
use crate::recording::Recording;
use hysteron::{Columns, Note, Quantity, ReadOptions, Repair};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::{Path, PathBuf};

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
///     the clock goes back another recording begins: `read_segments` reads these.
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
    none_left("read", unknown, &NAMES)?;
    let columns = Columns {
        input,
        output,
        time,
        load,
    };
    let options = options_of(repair, max_memory);
    let (mut recording, notes) =
        py.detach(|| hysteron::Recording::read(&path, columns, options).raise())?;
    tell(py, &path, &notes)?;
    name(&mut recording, [input_name, output_name, load_name]);
    Ok(recording.into())
}

/// Read the recordings of one experiment from a file: another one begins where the clock goes back,
/// if `repair` is true, and after a gap in which the input may have turned unseen.
///
/// The result can be given to `fit`, `Model.evaluate`, `compare` and `adapt` as it is: each recording
/// starts from its own initial state.
///
/// Parameters
/// ----------
/// path : str or path-like
/// input, output : str
/// time : str, optional
/// load : str, optional
/// input_name, output_name, load_name : str, optional
/// repair : bool
/// max_memory : int, optional
///     All as for `read`.
///
/// Returns
/// -------
/// list of Recording
///     In the order of the file.
///
/// Raises
/// ------
/// FileError
/// RecordingError
///     With line and column.
///
/// Examples
/// --------
/// >>> import os, tempfile, warnings
/// >>> path = os.path.join(tempfile.mkdtemp(), 'run.csv')
/// >>> _ = open(path, 'w').write('t,T,lift\n0,20,0\n1,80,14\n2,20,1\n0,20,0\n1,50,3\n2,20,0\n')
/// >>> with warnings.catch_warnings():
/// ...     warnings.simplefilter('ignore')
/// ...     parts = pyhysteron.read_segments(path, input='T', output='lift', time='t', repair=True)
/// >>> [part.input.max() for part in parts]
/// [np.float64(80.0), np.float64(50.0)]
#[pyfunction]
#[pyo3(signature = (path, *, input, output, time=None, load=None, input_name=None, output_name=None, load_name=None, repair=false, max_memory=None, **unknown),
    text_signature = "(path, *, input, output, time=None, load=None, input_name=None, output_name=None, load_name=None, repair=False, max_memory=None)")]
#[allow(clippy::too_many_arguments)]
pub(crate) fn read_segments(
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
) -> PyResult<Vec<Recording>> {
    none_left("read_segments", unknown, &NAMES)?;
    let columns = Columns {
        input,
        output,
        time,
        load,
    };
    let options = options_of(repair, max_memory);
    let (segments, notes) =
        py.detach(|| hysteron::Recording::read_segments(&path, columns, options).raise())?;
    tell(py, &path, &notes)?;
    let named = segments.into_iter().map(|mut part| {
        name(&mut part.recording, [input_name, output_name, load_name]);
        part.recording.into()
    });
    Ok(named.collect())
}

const NAMES: [&str; 9] = [
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

fn options_of(repair: bool, max_memory: Option<u64>) -> ReadOptions {
    ReadOptions {
        repair: match repair {
            true => Repair::Mend,
            false => Repair::Refuse,
        },
        max_memory: max_memory.unwrap_or_else(ReadOptions::usual_memory),
    }
}

fn tell(py: Python<'_>, path: &Path, notes: &[Note]) -> PyResult<()> {
    let mut notes = notes.iter();
    notes.try_for_each(|note| warn(py, &format!("{}: {note}", path.display())))
}

/// Names input, output and load as asked for.
fn name(recording: &mut hysteron::Recording, names: [Option<&str>; 3]) {
    let quantities = [
        &mut recording.input_quantity,
        &mut recording.output_quantity,
        &mut recording.load_quantity,
    ];
    for (name, quantity) in names.into_iter().zip(quantities) {
        if let Some(name) = name {
            *quantity = Quantity::from_column(name);
        }
    }
}

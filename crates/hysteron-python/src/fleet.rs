//! `pyhysteron.fleet`.

use crate::convert::result;
use crate::error::Raise;
use crate::fit::{fit_with, hold_out_of};
use crate::integer::Integer;
use crate::model::Model;
use crate::prior::WeightPrior;
use crate::progress::with_progress;
use hysteron::{Columns, Destination, FleetChoice, FleetOptions, ReadOptions, Repair};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// Fit a model to each of many actuators, and write one table with a row for each.
///
/// All cores work, and what is done is kept beside the target: after a call that was ended, the
/// same call goes on there. An actuator that cannot be fitted is named in the result and stops
/// nothing. The table has the same bits as that of ``hysteron fleet fit``, whatever the number of
/// threads.
///
/// Parameters
/// ----------
/// data : list of str or path-like
///     Tables, or folders of tables.
/// target : str or path-like
///     Where the table of models goes: ``'*.parquet'``.
/// input, output : str
///     The columns; see `pyhysteron.read`.
/// by : str, optional
///     The column that tells the actuators apart; the rows of one stand next to each other. By
///     default each file is an actuator.
/// time, load : str, optional
///     The columns of time and load.
/// levels, range, operator, solver, smooth, ridge, robust, start, sign, offset, load_law, load_degree, spacing, delay, creep, lag, dynamics, curve, bootstrap, thermal, prior
///     As for `pyhysteron.fit`.
/// choice : {'pilots', 'each'}
///     Who chooses what is left to the data, such as the levels. ``'pilots'``: some actuators, spread
///     over the data, choose for all. One that their choice does not serve is fitted by itself, and
///     is named in the result. A fleet of fewer than 24 has no pilots. ``'each'``: each for itself.
/// hold_out : str, optional
///     A part of each recording that takes no part in its fit, as for `pyhysteron.fit`.
/// repair : bool
///     As for `pyhysteron.read`.
/// force : bool
///     Whether a file that hysteron did not write may be replaced.
/// progress : callable, bool or None
///     As for `pyhysteron.fit`.
///
/// Returns
/// -------
/// results.FleetFitted
///
/// Raises
/// ------
/// FileError
///     For a path that is missing, and a target that cannot be written.
///
/// Examples
/// --------
/// >>> import os, tempfile
/// >>> folder = tempfile.mkdtemp()
/// >>> for n in range(3):
/// ...     x = 50 - 50 * np.cos(np.arange(200) * 0.05)
/// ...     rows = ''.join(f'{a},{(1 + n) * a}\n' for a in x)
/// ...     _ = open(os.path.join(folder, f'a{n}.csv'), 'w').write('x,y\n' + rows)
/// >>> table = os.path.join(folder, 'models.parquet')
/// >>> fleet = pyhysteron.fleet
/// >>> found = fleet.fit_fleet([folder], table, input='x', output='y', levels=4, bootstrap=0)
/// >>> found.fitted, found.failed
/// (3, {})
/// >>> sorted(fleet.read_fleet(table))
/// ['a0', 'a1', 'a2']
#[pyfunction]
#[pyo3(signature = (
    data, target, *, input, output, by=None, time=None, load=None, bootstrap=None, choice=None, hold_out=None,
    thermal=None, prior=None, repair=false, force=false, progress=None, **options,
), text_signature = "(data, target, *, input, output, by=None, levels='auto', range=None, operator='mkp', solver='nnls', smooth='auto', ridge=1e-6, robust=True, start='auto', sign=None, offset=None, load_law='auto', load_degree='auto', spacing='auto', delay='auto', creep='off', lag='off', dynamics='auto', curve='off', bootstrap=None, choice='pilots', hold_out=None, thermal=None, prior=None, time=None, load=None, repair=False, force=False, progress=None)")]
#[allow(clippy::too_many_arguments)]
pub(crate) fn fit_fleet<'py>(
    py: Python<'py>,
    data: Vec<PathBuf>,
    target: PathBuf,
    input: &str,
    output: &str,
    by: Option<&str>,
    time: Option<&str>,
    load: Option<&str>,
    bootstrap: Option<Integer>,
    choice: Option<&str>,
    hold_out: Option<&Bound<'py, PyAny>>,
    thermal: Option<&Bound<'py, PyAny>>,
    prior: Option<PyRef<'_, WeightPrior>>,
    repair: bool,
    force: bool,
    progress: Option<&Bound<'py, PyAny>>,
    options: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let names = [
        "input",
        "output",
        "by",
        "time",
        "load",
        "bootstrap",
        "choice",
        "hold_out",
        "thermal",
        "prior",
        "repair",
        "force",
        "progress",
    ];
    let fit = fit_with("fit_fleet", &names, (bootstrap, thermal, prior), options)?;
    let columns = Columns {
        time,
        load,
        ..Columns::new(input, output)
    };
    let options = FleetOptions {
        by,
        hold_out: hold_out.map(hold_out_of).transpose()?,
        choice: choice
            .map_or(Ok(FleetChoice::default()), str::parse)
            .raise()?,
        read: ReadOptions {
            repair: match repair {
                true => Repair::Mend,
                false => Repair::Refuse,
            },
            ..ReadOptions::default()
        },
        ..FleetOptions::new(columns, fit)
    };
    let found = with_progress(py, progress, |progress| {
        let inputs: Vec<&Path> = data.iter().map(PathBuf::as_path).collect();
        let target = Destination::keeping_foreign(&target, force).made_from(&inputs);
        hysteron::fit_fleet(&data, &options, target, progress)
    })?;
    let dict = PyDict::new(py);
    dict.set_item("fitted", found.fitted)?;
    dict.set_item("resumed", found.resumed)?;
    dict.set_item("with_warnings", found.with_warnings)?;
    let failed = PyDict::new(py);
    for failure in &found.failed {
        failed.set_item(&failure.id, failure.error.to_string())?;
    }
    dict.set_item("failed", failed)?;
    dict.set_item("notes", found.notes)?;
    dict.set_item("choice", found.shared.as_ref().map(ToString::to_string))?;
    let alone = PyDict::new(py);
    for one in &found.alone {
        alone.set_item(&one.id, (one.shared_percent, one.own_percent))?;
    }
    dict.set_item("alone", alone)?;
    result(py, "FleetFitted", dict)
}

/// Put tables of models together, made of the parts of a fleet. The result has the same bits as a
/// table that was fitted at once to the data of all parts in the same order.
///
/// Parameters
/// ----------
/// parts : list of str or path-like
///     Tables of `fit_fleet`.
/// target : str or path-like
///     Where the whole table goes.
/// force : bool
///     Whether a file that hysteron did not write may be replaced.
///
/// Returns
/// -------
/// int
///     The number of actuators.
///
/// Raises
/// ------
/// FileError, RecordingError
///     For a part that is no such table, and for an actuator in two parts. Nothing is written then.
#[pyfunction]
#[pyo3(signature = (parts, target, *, force=false))]
pub(crate) fn join_fleets(
    py: Python<'_>,
    parts: Vec<PathBuf>,
    target: PathBuf,
    force: bool,
) -> PyResult<usize> {
    py.detach(|| {
        let inputs: Vec<&Path> = parts.iter().map(PathBuf::as_path).collect();
        let target = Destination::keeping_foreign(&target, force).made_from(&inputs);
        hysteron::join_fleets(&parts, target).raise()
    })
}

/// The models of a fleet's table, by actuator, in its order. They have no band: the table does not
/// hold it.
///
/// Parameters
/// ----------
/// models : str or path-like
///     A table of `fit_fleet` or of ``hysteron fleet fit``.
/// actuators : list of str, optional
///     Those that are wanted; by default all.
///
/// Returns
/// -------
/// dict of Model
///
/// Raises
/// ------
/// FileError, RecordingError
///     For a file that is no such table.
#[pyfunction]
#[pyo3(signature = (models, *, actuators=None))]
pub(crate) fn read_fleet<'py>(
    py: Python<'py>,
    models: PathBuf,
    actuators: Option<Vec<String>>,
) -> PyResult<Bound<'py, PyDict>> {
    let actuators: Option<HashSet<String>> = actuators.map(|wanted| wanted.into_iter().collect());
    let mut found = Vec::new();
    py.detach(|| {
        hysteron::read_fleet(&models, |row| {
            if actuators
                .as_ref()
                .is_none_or(|wanted| wanted.contains(&row.id))
            {
                found.push((row.id, row.model));
            }
            Ok(true)
        })
        .raise()
    })?;
    let dict = PyDict::new(py);
    for (id, model) in found {
        dict.set_item(id, Bound::new(py, Model::from(model))?)?;
    }
    Ok(dict)
}

/// The prior of a fleet's table. Actuators that are unlike the others do not count.
///
/// Parameters
/// ----------
/// models : str or path-like
///     A table of `fit_fleet` or of ``hysteron fleet fit``.
///
/// Returns
/// -------
/// WeightPrior
///
/// Raises
/// ------
/// FileError, RecordingError
///     For a file that is no such table.
/// FitError
///     For models that make no prior.
#[pyfunction]
pub(crate) fn prior_of_fleet(py: Python<'_>, models: PathBuf) -> PyResult<WeightPrior> {
    Ok(py
        .detach(|| hysteron::prior_of_fleet(&models).raise())?
        .into())
}

"""A fleet on a Dask cluster. Needs the extra ``dask``: ``pip install 'pyhysteron[dask]'``.

`fit_fleet` is for tables in files. Each of them is a task, which writes a table of its own into a
folder that all workers reach, and `pyhysteron.fleet.join_fleets` puts the tables together. So the
result has the same bits whichever worker fitted which part. A task that is lost with its worker
runs again elsewhere, and writes the same table.

`fit` is for a frame of samples. A task fits one of its partitions.

Each part or partition has pilots of its own (``choice='pilots'``). With ``choice='each'``, or
nothing left to the data, the bits are those of one machine.
"""

import hashlib
from collections.abc import Iterable, Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

try:
    import pandas
    import pyarrow
    from dask import delayed
except ImportError as _missing:
    raise ImportError(
        "pyhysteron.fleet.dask needs Dask and its frames: pip install 'pyhysteron[dask]'"
    ) from _missing

from ..results import FleetFitted
from . import _frames, fit_fleet as _fit_part, join_fleets

if TYPE_CHECKING:
    from dask.dataframe import DataFrame

__all__ = ["fit", "fit_fleet"]


def fit(
    frame: "DataFrame",
    *,
    by: str,
    input: str,
    output: str,
    order: str | None = None,
    partitions: int | None = None,
    **options: Any,
) -> "DataFrame":
    """Fit a model to each actuator of a frame of samples.

    Rows of an actuator may be anywhere in the frame. The work is done where the result is used, and
    again with each use: write it, or `persist` it. A partition is in memory while it is fitted.

    Each partition has pilots of its own, so let about a thousand actuators share one.

    Parameters
    ----------
    frame : dask.dataframe.DataFrame
        A row for each sample.
    by : str
        The column that tells the actuators apart.
    input, output : str
        The columns of input and output.
    order : str, optional
        The column that sorts the samples of an actuator; by default that of `time`.
    partitions : int, optional
        Number of partitions; by default as many as the frame has.
    **options
        As for `pyhysteron.fleet.fit_fleet`, `time` and `load` included, but no `prior`.

    Returns
    -------
    dask.dataframe.DataFrame
        A row for each actuator, with the columns of a fleet's table, in Arrow's types. `file` is
        empty. The column ``failed`` is null, or says why there is no model; then all others but
        `id` are null.

    Raises
    ------
    KeyError
        For a column that is missing.
    TypeError
        Without `order` and `time`, for an option that does not exist, and for a `prior`.
    HysteronError
        As `pyhysteron.fleet.fit_fleet`, also for columns that hold no numbers.

    Notes
    -----
    What is assumed about a partition is a warning of the logger ``pyhysteron.fleet``, in the log of
    its worker. What pilots chose stands in each model.

    Examples
    --------
    >>> import dask.dataframe, pandas
    >>> from pyhysteron.fleet import dask as on_dask
    >>> x = 50 - 50 * np.cos(np.arange(200) * 0.05)
    >>> one = pandas.DataFrame({'serial': 17, 't': np.arange(200), 'x': x, 'y': 17 * x})
    >>> lines = pandas.concat([one, one.assign(serial=18, y=18 * x)], ignore_index=True)
    >>> lines = dask.dataframe.from_pandas(lines, npartitions=2)
    >>> columns = {'by': 'serial', 'input': 'x', 'output': 'y', 'time': 't'}
    >>> models = on_dask.fit(lines, levels=4, bootstrap=0, **columns)
    >>> models.compute().set_index('id')['stroke'].round().sort_index().to_dict()
    {'17': 1700.0, '18': 1800.0}
    """
    options = {**options, "by": by, "input": input, "output": output}
    read, order = _frames.columns(frame.columns, order, options)
    _frames.check(_arrow(frame._meta[read]).schema, options)
    # What only sorts is asked for once.
    samples = frame[list(dict.fromkeys([*read, order]))].shuffle(by, npartitions=partitions)
    rows = _frames.schema()
    meta = _pandas([], rows)
    models: DataFrame = samples.map_partitions(_models, read, order, options, rows, meta=meta)
    return models


def _models(
    samples: Any, read: list[str], order: str, options: dict[str, Any], rows: pyarrow.Schema
) -> Any:
    """The rows of a partition's actuators."""
    samples = _arrow(samples.sort_values([options["by"], order])[read])
    return _pandas(_frames.fit(samples.to_batches(), options, rows), rows)


def _arrow(samples: Any) -> pyarrow.Table:
    return pyarrow.Table.from_pandas(samples, preserve_index=False)


def _pandas(models: Iterable[pyarrow.RecordBatch], rows: pyarrow.Schema) -> Any:
    """In Arrow's types, which have whole numbers that may be null, and lists."""
    return pyarrow.Table.from_batches(models, rows).to_pandas(types_mapper=pandas.ArrowDtype)


def fit_fleet(
    parts: Sequence[str | PathLike[str]],
    target: str | PathLike[str],
    *,
    folder: str | PathLike[str],
    force: bool = False,
    **options: Any,
) -> FleetFitted:
    """Fit the parts of a fleet as tasks of Dask, and join their tables.

    The tasks run on the cluster of the current `dask.distributed.Client`, and without one on
    threads of this process.

    Parameters
    ----------
    parts : list of str or path-like
        Tables, or folders of tables, as the workers see them. An actuator is in one part.
    target : str or path-like
        Where the whole table goes: ``'*.parquet'``.
    folder : str or path-like
        Where the tables of the parts go. All workers have to reach it. What a lost task had done is
        found there.
    force : bool
        Whether a file that hysteron did not write may be replaced.
    **options
        As for `pyhysteron.fleet.fit_fleet`; ``input`` and ``output`` are needed.

    Returns
    -------
    results.FleetFitted
        Of all parts together.

    Raises
    ------
    HysteronError
        As `pyhysteron.fleet.fit_fleet` and `pyhysteron.fleet.join_fleets`.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    tasks = [delayed(_one, pure=False)(fspath(part), fspath(_table(folder, part)), options) for part in parts]
    found: Sequence[FleetFitted] = delayed(list)(tasks).compute()
    tables = [_table(folder, part) for part, result in zip(parts, found) if result.fitted]
    join_fleets(tables, target, force=force)
    return FleetFitted(
        fitted=sum(result.fitted for result in found),
        resumed=sum(result.resumed for result in found),
        with_warnings=sum(result.with_warnings for result in found),
        failed={name: why for result in found for name, why in result.failed.items()},
        notes=tuple(note for result in found for note in result.notes),
        choice="; ".join(dict.fromkeys(result.choice for result in found if result.choice)) or None,
        alone={name: errors for result in found for name, errors in result.alone.items()},
    )


def _table(folder: Path, part: str | PathLike[str]) -> Path:
    """Parts of the same name in several folders have tables of their own."""
    path = fspath(part)
    return folder / f"{Path(path).stem}-{hashlib.sha256(path.encode()).hexdigest()[:12]}.parquet"


def _one(part: str, table: str, options: dict[str, Any]) -> FleetFitted:
    return _fit_part([part], table, **options)

"""A fleet in a frame of Spark. Needs the extra ``spark``: ``pip install 'pyhysteron[spark]'``.

An executor fits a whole partition by one call of `pyhysteron.fleet.fit_fleet`. So executors need
this package, too.
"""

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

try:
    import pyarrow
except ImportError as _missing:
    raise ImportError(
        "pyhysteron.fleet.spark needs PyArrow: pip install 'pyhysteron[spark]'"
    ) from _missing

from . import _frames

if TYPE_CHECKING:
    from pyspark.sql import DataFrame as _DataFrame

__all__ = ["fit"]

#: What Spark calls the types of a fleet's table.
_TYPES = {"string": "string", "int64": "bigint", "double": "double", "list": "array<double>"}


def fit(
    frame: "_DataFrame",
    *,
    by: str,
    input: str,
    output: str,
    order: str | None = None,
    partitions: int | None = None,
    **options: Any,
) -> "_DataFrame":
    """Fit a model to each actuator of a frame of samples.

    Rows of an actuator may be anywhere in the frame. The work is done where the result is used, and
    again with each use: write it, or `persist` it.

    Each partition has pilots of its own (``choice='pilots'``), so let about a thousand actuators
    share one. With ``choice='each'``, or nothing left to the data, a model has the same bits as in
    one process.

    Parameters
    ----------
    frame : pyspark.sql.DataFrame
        A row for each sample.
    by : str
        The column that tells the actuators apart.
    input, output : str
        The columns of input and output.
    order : str, optional
        The column that sorts the samples of an actuator; by default that of `time`.
    partitions : int, optional
        Number of partitions. By default Spark chooses it, and with it, who shares pilots.
    **options
        As for `pyhysteron.fleet.fit_fleet`, `time` and `load` included, but no `prior`.

    Returns
    -------
    pyspark.sql.DataFrame
        A row for each actuator, with the columns of a fleet's table. `file` is empty. The column
        ``failed`` is null, or says why there is no model; then all others but `id` are null.

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
    its executor. What pilots chose stands in each model.

    Examples
    --------
    >>> from pyhysteron.fleet import spark
    >>> lines = session.read.parquet('/shared/lines')  # doctest: +SKIP
    >>> models = spark.fit(lines, by='serial', input='T', output='lift', time='t')  # doctest: +SKIP
    >>> models.where('failed is null').write.parquet('/shared/models')  # doctest: +SKIP
    """
    options = {**options, "by": by, "input": input, "output": output}
    read, order = _frames.columns(frame.columns, order, options)
    # A frame of no rows has types, and Spark does no work for it.
    _frames.check(frame.select(*read).limit(0).toArrow().schema, options)
    if partitions is None:
        together = frame.repartition(by)
    else:
        together = frame.repartition(partitions, by)
    samples = together.sortWithinPartitions(by, order).select(*read)
    rows = _frames.schema()

    def models(batches: Iterable[pyarrow.RecordBatch]) -> Iterator[pyarrow.RecordBatch]:
        return _frames.fit(batches, options, rows)

    types = ((column.name, str(column.type).partition("<")[0]) for column in rows)
    return samples.mapInArrow(models, ", ".join(f"`{name}` {_TYPES[of]}" for name, of in types))

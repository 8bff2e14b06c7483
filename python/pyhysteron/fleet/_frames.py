"""What the fits of Spark's and Dask's frames share: a partition of samples in, rows of models out.

Both bring all rows of an actuator into one partition and sort them. A partition then is a table of
many actuators, which `fit_fleet` takes.
"""

import itertools
import logging
import tempfile
import uuid
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import pyarrow
import pyarrow.parquet

from .._convert import did_you_mean
from .._hysteron import fit_fleet, join_fleets
from ..errors import RecordingError

_LOG = logging.getLogger("pyhysteron.fleet")

#: Rows of models that are in memory at once.
_ROWS = 1000


def schema() -> pyarrow.Schema:
    """The columns of a fleet's table, and `failed`."""
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder, "models.parquet")
        join_fleets([], table)  # of no parts: columns and no rows
        columns = list(pyarrow.parquet.read_schema(table))
    # What is in a list may be null for Spark.
    numbers = pyarrow.list_(pyarrow.float64())
    lists = [column for column in columns if pyarrow.types.is_list(column.type)]
    columns = [column.with_type(numbers) if column in lists else column for column in columns]
    return pyarrow.schema([*columns, pyarrow.field("failed", pyarrow.string())])


def columns(
    there: Iterable[str], order: str | None, options: dict[str, Any]
) -> tuple[list[str], str]:
    """The columns that a fit reads, and the one that sorts the rows of an actuator.

    All of them have to be there.
    """
    order = options.get("time") if order is None else order
    if order is None:
        raise TypeError(
            "`order` is needed, or `time`: a frame does not keep the order of its rows, which is "
            "that of the samples. Name the column that sorts them"
        )
    asked = (options.get(name) for name in ("by", "input", "output", "time", "load"))
    read = list(dict.fromkeys(name for name in asked if name is not None))
    there = list(there)
    for name in [*read, order]:
        if name not in there:
            raise KeyError(f"the frame has no column `{name}`{did_you_mean(name, there, '`')}")
    return read, order


def check(samples: pyarrow.Schema, options: dict[str, Any]) -> None:
    """Raises what is wrong with the options, and with columns of these types."""
    if options.get("prior") is not None:
        raise TypeError("`prior` cannot be sent to other processes: `fit_fleet` takes it in one")
    nothing = pyarrow.RecordBatch.from_pylist([], schema=samples)
    list(fit([nothing], options, pyarrow.schema([])))


def fit(
    samples: Iterable[pyarrow.RecordBatch], options: dict[str, Any], rows: pyarrow.Schema
) -> Iterator[pyarrow.RecordBatch]:
    """The rows of all actuators of a partition, as `schema` has them. Failed ones come last."""
    samples = iter(samples)
    first = next(samples, None)
    if first is None:
        return
    with tempfile.TemporaryDirectory(prefix="pyhysteron-") as folder:
        # What is wrong with the whole table is said of its name, which so is that of no actuator.
        name = uuid.uuid4().hex
        table, models = Path(folder, f"{name}.arrows"), Path(folder, "models.parquet")
        with pyarrow.OSFile(str(table), "wb") as file:
            with pyarrow.ipc.new_stream(file, first.schema) as stream:
                for batch in itertools.chain([first], samples):
                    stream.write_batch(batch)
        found = fit_fleet([table], models, **options)
        # The file will be gone when this is read.
        failed = {id: why.replace(str(table), "of a partition") for id, why in found.failed.items()}
        if name in failed:
            raise RecordingError(failed[name])
        for note in found.notes:
            _LOG.warning(note.replace(str(table), "a partition"))
        if found.fitted:
            with pyarrow.parquet.ParquetFile(models) as fitted:
                for batch in fitted.iter_batches(_ROWS):
                    yield from _rows(batch, rows)
    lost = [{"id": id, "failed": why} for id, why in failed.items()]
    yield from pyarrow.Table.from_pylist(lost, rows).to_batches()


def _rows(models: pyarrow.RecordBatch, rows: pyarrow.Schema) -> list[pyarrow.RecordBatch]:
    """Rows of a fleet's table as those of a frame."""
    table = pyarrow.Table.from_batches([models])
    no_file = pyarrow.array([""] * len(table))
    table = table.set_column(table.schema.get_field_index("file"), "file", no_file)
    table = table.append_column("failed", pyarrow.nulls(len(table), pyarrow.string()))
    batches: list[pyarrow.RecordBatch] = table.cast(rows).to_batches()
    return batches

"""A fleet on several machines, with Dask. Needs the extra ``dask``: ``pip install 'pyhysteron[dask]'``.

Each part of the data is a task. It writes a table of its own into a folder that all workers reach,
and `pyhysteron.fleet.join_fleets` puts the tables together. So the result has the same bits
whichever worker fitted which part. Each part has pilots of its own (``choice='pilots'``). With
``choice='each'``, or nothing left to the data, the bits are those of one machine. A task that is lost with its worker runs again
elsewhere, and writes the same table.
"""

import hashlib
from collections.abc import Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import Any

from dask import delayed

from ..results import FleetFitted
from . import fit_fleet as _fit_part, join_fleets

__all__ = ["fit_fleet"]


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

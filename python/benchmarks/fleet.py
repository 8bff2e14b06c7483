"""A fleet in one process against a Dask cluster of as many processes as cores on the same machine.

    python python/benchmarks/fleet.py

Random simulated actuators, 500 samples each, in tables of 250. K = 20, nothing left to the data, no bootstrap. *Parts*: `dask.fit_fleet` of the tables; its table of models must be the same bytes. *Frame*: `dask.fit` of all samples, written as Parquet; its models must have the same bits. Needs the extra `dask`.
"""

import os
import tempfile
import time
from pathlib import Path

import numpy as np
import pyarrow
import pyarrow.parquet
from dask.dataframe import read_parquet
from dask.distributed import Client, LocalCluster

from pyhysteron import fleet
from pyhysteron.fleet import dask

EACH, ROWS = 250, 500
OPTIONS = {
    "by": "id", "input": "x", "output": "y", "levels": 20, "smooth": 0.0, "spacing": "uniform",
    "bootstrap": 0, "robust": False, "start": "off",
}


def table(path, part, random):
    """Actuators of five plays of random widths and weights."""
    x = 50 + 30 * np.linspace(1, 0.4, ROWS) * np.sin(np.linspace(0, 6 * np.pi, ROWS))
    width, weight = random.uniform(2, 20, (EACH, 5)), random.uniform(0.1, 1, (EACH, 5))
    play, y = np.full((EACH, 5), x[0]), np.empty((EACH, ROWS))
    for n, now in enumerate(x):
        play = np.clip(play, now - width, now + width)
        y[:, n] = (weight * play).sum(axis=1)
    y += 0.01 * random.normal(size=y.shape)
    names = np.repeat(np.arange(part * EACH, (part + 1) * EACH), ROWS)
    times = np.tile(np.arange(ROWS), EACH)
    columns = {"id": names, "t": times, "x": np.tile(x, EACH), "y": y.ravel()}
    pyarrow.parquet.write_table(pyarrow.table(columns), path)


def same(folder, table):
    """Whether Parquet files of a folder have the models of a table, to the last bit."""
    columns = ["id", "model", "weights"]
    paths = (folder, table)
    models, expected = (pyarrow.parquet.read_table(path, columns=columns).sort_by("id") for path in paths)
    return models.cast(expected.schema).equals(expected)


def fit_frame(parts, folder):
    dask.fit(read_parquet(parts), order="t", **OPTIONS).to_parquet(folder, overwrite=True)


def seconds(work):
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


def main():
    random, cores = np.random.default_rng(1), os.cpu_count()
    print(f"{cores} cores; seconds\n\n| actuators | one process | cluster: start | parts | frame |\n| ---: | ---: | ---: | ---: | ---: |")
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        parts = [folder / f"part-{n}.parquet" for n in range(40)]
        for n, part in enumerate(parts):
            table(part, n, random)
        for count in (2, 20, 40):
            one, many, frame = folder / "one.parquet", folder / "many.parquet", folder / "frame"
            local = seconds(lambda: fleet.fit_fleet(parts[:count], one, force=True, **OPTIONS))
            begin = time.perf_counter()
            with LocalCluster(cores, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster):
                started = time.perf_counter() - begin
                by_parts = seconds(lambda: dask.fit_fleet(parts[:count], many, folder=folder / f"tables-{count}", force=True, **OPTIONS))
                of_frame = seconds(lambda: fit_frame(parts[:count], frame))
            assert one.read_bytes() == many.read_bytes() and same(frame, one)
            print(f"| {count * EACH} | {local:.1f} | {started:.1f} | {by_parts:.1f} | {of_frame:.1f} |", flush=True)


if __name__ == "__main__":
    main()

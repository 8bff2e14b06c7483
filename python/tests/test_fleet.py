"""Fleets: one table for many actuators, on one machine and on several."""

import json
import os
import signal
import threading
import time

import numpy as np
import pytest

import pyhysteron
from pyhysteron import fleet

OPTIONS = {"input": "x", "output": "y", "levels": 5, "range": (0, 100), "smooth": 0.0, "spacing": "uniform", "start": "off", "bootstrap": 0}


def record(seed, samples=300):
    """A play with a stroke of its own."""
    rng = np.random.default_rng(seed)
    x = 50 - 50 * np.cos(0.05 * np.arange(samples)) * np.exp(-np.arange(samples) / 1000)
    y, held, stroke = np.empty(samples), 0.0, 1 + rng.random()
    for n, now in enumerate(x):
        held = min(max(held, now - 20), now)
        y[n] = stroke * held + 0.01 * rng.random()
    return x, y


def write(path, ids, samples=300):
    lines = ["id,x,y"] + [f"a{n:03},{x},{y}" for n in ids for x, y in zip(*record(n, samples))]
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.fixture(scope="module")
def parts(tmp_path_factory):
    folder = tmp_path_factory.mktemp("parts")
    return [write(folder / f"part-{n}.csv", range(10 * n, 10 * n + 10)) for n in range(4)]


@pytest.fixture(scope="module")
def table(parts, tmp_path_factory):
    target = tmp_path_factory.mktemp("table") / "models.parquet"
    found = fleet.fit_fleet(parts, target, by="id", **OPTIONS)
    assert (found.fitted, found.resumed, found.failed) == (40, 0, {})
    return target


def test_each_model_is_that_of_a_fit_alone(table):
    models = fleet.read_fleet(table)
    assert list(models) == [f"a{n:03}" for n in range(40)]
    options = {name: value for name, value in OPTIONS.items() if name not in ("input", "output")}
    for n in (0, 17, 39):
        alone = pyhysteron.fit(*record(n), **options)
        # Text and table hold every digit.
        assert np.array_equal(models[f"a{n:03}"].weights, alone.weights, equal_nan=True)
    assert list(fleet.read_fleet(table, actuators=["a003"])) == ["a003"]


def test_pilots_choose_for_all(parts, tmp_path):
    options = {**OPTIONS, "start": "auto"}
    shared = fleet.fit_fleet(parts, tmp_path / "shared.parquet", by="id", **options)
    assert " pilots chose for all: levels 5," in shared.choice and shared.fitted == 40
    alone = fleet.fit_fleet(parts, tmp_path / "each.parquet", by="id", choice="each", **options)
    assert alone.choice is None and alone.alone == {}
    with pytest.raises(pyhysteron.FitError, match="`some`"):
        fleet.fit_fleet(parts, tmp_path / "other.parquet", by="id", choice="some", **options)


def test_what_is_broken_is_named_and_stops_nothing(tmp_path):
    write(tmp_path / "good.csv", [1])
    (tmp_path / "flat.csv").write_text("x,y\n1,2\n1,3\n")
    found = fleet.fit_fleet([tmp_path], tmp_path / "models.parquet", **OPTIONS)
    assert found.fitted == 1 and list(found.failed) == ["flat"]
    with pytest.raises(pyhysteron.FileError):
        fleet.fit_fleet([tmp_path / "nothing"], tmp_path / "other.parquet", **OPTIONS)
    (tmp_path / "mine.parquet").write_text("mine")
    with pytest.raises(pyhysteron.FileError):
        fleet.fit_fleet([tmp_path / "good.csv"], tmp_path / "mine.parquet", **OPTIONS)
    with pytest.raises(TypeError, match="`smoth`"):
        fleet.fit_fleet([tmp_path], tmp_path / "models.parquet", smoth=3, **OPTIONS)
    with pytest.raises(pyhysteron.RecordingError):
        fleet.read_fleet(tmp_path / "good.csv")


def test_parts_are_joined_to_the_table_of_the_whole(parts, table, tmp_path):
    tables = [tmp_path / f"{n}.parquet" for n in range(len(parts))]
    for part, target in zip(parts, tables):
        fleet.fit_fleet([part], target, by="id", **OPTIONS)
    assert fleet.join_fleets(tables, tmp_path / "joined.parquet") == 40
    assert (tmp_path / "joined.parquet").read_bytes() == table.read_bytes()
    with pytest.raises(pyhysteron.RecordingError, match="is in"):
        fleet.join_fleets([tables[0], tables[0]], tmp_path / "twice.parquet")
    assert not (tmp_path / "twice.parquet").exists()


def test_a_prior_says_what_a_short_recording_does_not(table):
    x, y = record(99)
    prior = fleet.prior_of_fleet(table)
    assert "models" in repr(prior)
    options = {name: value for name, value in OPTIONS.items() if name not in ("input", "output")}

    def error(model):
        return model.evaluate(x, y, start="off").forward.rmse

    whole, alone = error(pyhysteron.fit(x, y, **options)), error(pyhysteron.fit(x[:40], y[:40], **options))
    short = error(pyhysteron.fit(x[:40], y[:40], prior=prior, start="off"))
    assert short < whole + 0.3 * (alone - whole)
    same = error(pyhysteron.fit(x[:40], y[:40], prior=fleet.WeightPrior(list(fleet.read_fleet(table).values())), start="off"))
    assert same == pytest.approx(short, rel=0.2)
    with pytest.raises(pyhysteron.FitError, match="10 or more"):
        fleet.WeightPrior([])


def kill_in_the_middle(pid, tables):
    """Kills a worker as soon as a part is begun."""
    while not (tables.exists() and any(tables.iterdir())):
        time.sleep(0.01)
    os.kill(pid, signal.SIGKILL)


def test_dask_gives_the_same_bits_though_a_worker_dies(parts, table, tmp_path):
    distributed = pytest.importorskip("distributed")
    from pyhysteron.fleet import dask

    with distributed.LocalCluster(n_workers=3, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as client:
            pids = list(client.run(os.getpid).values())
            target = tmp_path / "models.parquet"
            # The workers are busy for a while, so one dies in the middle.
            options = {**OPTIONS, "levels": 20, "bootstrap": 40}
            whole = tmp_path / "whole.parquet"
            fleet.fit_fleet(parts, whole, by="id", **options)
            tables = tmp_path / "tables"
            killer = threading.Thread(target=kill_in_the_middle, args=(pids[0], tables))
            killer.start()
            found = dask.fit_fleet(parts, target, folder=tables, by="id", **options)
            killer.join()
            assert pids[0] not in client.run(os.getpid).values()
            assert found.fitted == 40 and not found.failed
            assert target.read_bytes() == whole.read_bytes()
            again = dask.fit_fleet(parts, tmp_path / "again.parquet", folder=tmp_path / "other", by="id", **OPTIONS)
            assert again.fitted == 40
    assert (tmp_path / "again.parquet").read_bytes() == table.read_bytes()
    assert json.loads(next(iter(fleet.read_fleet(target).values())).to_json())["plane"]["levels"] == 20

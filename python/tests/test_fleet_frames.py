"""Fleets in frames of Dask and of a local Spark: rows in any order, over several partitions."""

import doctest
import importlib
import os
import shutil
import sys

import numpy as np
import pytest
from test_fleet import OPTIONS, record

from pyhysteron import RecordingError, fleet

pandas = pytest.importorskip("pandas")
pyarrow = pytest.importorskip("pyarrow")
parquet = pytest.importorskip("pyarrow.parquet")

COLUMNS = {"by": "id", **OPTIONS}


class OnDask:
    """Its workers are other processes, as on a cluster."""

    def __init__(self):
        distributed = pytest.importorskip("distributed")
        pytest.importorskip("dask.dataframe")
        from pyhysteron.fleet import dask

        self.cluster = distributed.LocalCluster(2, threads_per_worker=1, dashboard_address=None)
        self.client = distributed.Client(self.cluster)
        self.fit = dask.fit

    def close(self):
        self.client.close()
        self.cluster.close()

    def frame(self, samples):
        from dask import dataframe

        return dataframe.from_pandas(samples, npartitions=4, sort=False)

    def table(self, models):
        return pyarrow.Table.from_pandas(models.compute(), preserve_index=False)

    def partitions(self, models):
        return models.npartitions

    def write(self, models, folder):
        models[models["failed"].isna()].to_parquet(folder)


class OnSpark:
    def __init__(self):
        from pyspark.sql import SparkSession

        from pyhysteron.fleet import spark

        # Its workers take the Python and the folders of this process.
        os.environ["PYSPARK_PYTHON"] = sys.executable
        os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, sys.path))
        builder = SparkSession.builder.master("local[2]").config("spark.ui.enabled", "false")
        builder = builder.config("spark.sql.shuffle.partitions", "4")
        self.session = builder.config("spark.log.level", "ERROR").getOrCreate()
        self.fit = spark.fit

    def close(self):
        self.session.stop()

    def frame(self, samples):
        samples = pyarrow.Table.from_pandas(samples, preserve_index=False)
        return self.session.createDataFrame(samples).repartition(4)

    def table(self, models):
        return models.toArrow()

    def partitions(self, models):
        return models.rdd.getNumPartitions()

    def write(self, models, folder):
        models.where("failed is null").write.parquet(str(folder))


def without_spark():
    """Why the tests do not run on Spark."""
    try:
        import pyspark  # noqa: F401
    except ImportError:
        return "there is no pyspark: `./check all` installs it"
    if not shutil.which("java") and "JAVA_HOME" not in os.environ:
        return "Spark needs Java (Debian: apt-get install default-jre-headless)"
    return None


@pytest.mark.skipif(without_spark() is not None, reason=f"the frames of Spark: {without_spark()}")
def test_spark_is_there():
    """Said once, not by each of the tests below."""


ENGINES = [OnDask] if without_spark() else [OnDask, OnSpark]


@pytest.fixture(scope="module", params=ENGINES, ids=lambda engine: engine.__name__)
def engine(request):
    engine = request.param()
    yield engine
    engine.close()


def samples(name="a{:03}".format, actuators=12):
    """Those of all actuators, sorted. The last half of each has another load."""
    each = []
    for n in range(actuators):
        x, y = record(n)
        loads = np.repeat([1.0, 2.0], len(x) // 2)
        columns = {"id": name(n), "t": 0.1 * np.arange(len(x)), "x": x, "y": y * loads}
        each.append(pandas.DataFrame({**columns, "load": loads, "word": "up"}))
    return pandas.concat(each, ignore_index=True).sort_values(["id", "t"])


def shuffled(rows):
    return rows.sample(frac=1, random_state=1)


def of_one_process(rows, folder, **options):
    """The table of `fit_fleet`, and what could not be fitted."""
    data = folder / "samples.parquet"
    parquet.write_table(pyarrow.Table.from_pandas(rows, preserve_index=False), data)
    found = fleet.fit_fleet([data], folder / "models.parquet", **options)
    return parquet.read_table(folder / "models.parquet"), found.failed


def same(frame, table):
    """Whether models of a frame, which has no files, are the rows of a table, to the last bit."""
    assert frame["file"].unique().to_pylist() == [""]
    columns = [name for name in table.column_names if name != "file"]
    assert frame.column_names == [*table.column_names, "failed"]
    frame, table = (rows.select(columns).sort_by("id") for rows in (frame, table))
    return frame.cast(table.schema).equals(table)


@pytest.mark.parametrize(
    "name", ["a{:03}".format, int, lambda n: n / 4], ids=["text", "integer", "number"]
)
def test_the_bits_are_those_of_one_process(engine, tmp_path, name):
    rows = samples(name)
    table, _ = of_one_process(rows, tmp_path, **COLUMNS)
    models = engine.fit(engine.frame(shuffled(rows)), order="t", partitions=3, **COLUMNS)
    assert engine.partitions(models) == 3
    models = engine.table(models)
    assert models["id"].null_count == 0 and models["failed"].null_count == 12
    assert same(models, table)


@pytest.mark.parametrize(
    "more",
    [{"time": "t"}, {"load": "load", "order": "t"}, {"time": "t", "load": "load"}],
    ids=lambda more: "+".join(more),
)
def test_time_and_load(engine, tmp_path, more):
    rows = samples(actuators=6)
    known = {name: column for name, column in more.items() if name != "order"}
    table, _ = of_one_process(rows, tmp_path, **COLUMNS, **known)
    assert same(engine.table(engine.fit(engine.frame(shuffled(rows)), **COLUMNS, **more)), table)


def test_a_partition_has_pilots_of_its_own(engine, tmp_path):
    options = {**COLUMNS, "start": "auto"}
    rows = samples(actuators=24)
    table, _ = of_one_process(rows, tmp_path, **options)
    assert '"fleet_choice"' in table["model"][0].as_py()
    frame = engine.frame(shuffled(rows))
    together = engine.fit(frame, order="t", partitions=1, **options)
    assert same(engine.table(together), table)
    # Fewer than 24 choose each for itself.
    alone = engine.table(engine.fit(frame, order="t", partitions=8, **options))
    assert not any('"fleet_choice"' in model for model in alone["model"].to_pylist())


def test_what_failed_has_a_row_with_its_reason(engine, tmp_path):
    rows = samples(int)
    rows.loc[rows["id"] == 3, "x"] = 7.0
    rows.loc[rows["id"] == 5, "y"] = np.nan
    rows = rows[(rows["id"] != 8) | (rows["t"] < 0.05)]
    table, failed = of_one_process(rows, tmp_path, **COLUMNS)
    assert set(failed) == {"3", "5", "8"}
    models = engine.fit(engine.frame(shuffled(rows)), order="t", partitions=2, **COLUMNS)
    models = engine.table(models)
    assert sorted(models["id"].to_pylist(), key=int) == [str(n) for n in range(12)]
    lost = [row for row in models.to_pylist() if row["failed"] is not None]
    assert {row["id"] for row in lost} == set(failed)
    for row in lost:
        assert {name for name, value in row.items() if value is not None} == {"id", "failed"}
        # The rows of a partition have other numbers, and nobody has its file.
        assert row["failed"].startswith("recording") and str(os.sep) not in row["failed"]
    assert next(row["failed"] for row in lost if row["id"] == "3") == failed["3"]
    whole = models.filter(pyarrow.compute.is_null(models["failed"]))
    assert same(whole, table)


def test_partitions_may_be_empty(engine, tmp_path):
    rows = samples(actuators=3)
    table, _ = of_one_process(rows, tmp_path, **COLUMNS)
    models = engine.fit(engine.frame(shuffled(rows)), order="t", partitions=16, **COLUMNS)
    assert engine.partitions(models) == 16
    assert same(engine.table(models), table)
    nothing = engine.table(engine.fit(engine.frame(rows[:0]), order="t", **COLUMNS))
    assert len(nothing) == 0 and nothing.column_names == [*table.column_names, "failed"]


def test_written_it_is_joined_to_a_table_of_models(engine, tmp_path):
    rows = samples()
    rows.loc[rows["id"] == "a003", "x"] = 7.0
    table, _ = of_one_process(rows, tmp_path, **COLUMNS)
    models = engine.fit(engine.frame(shuffled(rows)), order="t", partitions=3, **COLUMNS)
    engine.write(models, tmp_path / "parts")
    parts = sorted((tmp_path / "parts").glob("*.parquet"))
    assert len(parts) > 1
    joined = tmp_path / "joined.parquet"
    assert fleet.join_fleets(parts, joined) == len(table) == 11
    of_no_failure = pyarrow.nulls(11, pyarrow.string())
    assert same(parquet.read_table(joined).append_column("failed", of_no_failure), table)
    assert fleet.read_fleet(joined) == fleet.read_fleet(tmp_path / "models.parquet")
    assert "11 models" in repr(fleet.prior_of_fleet(joined))


@pytest.mark.parametrize(
    "wrong, error, message",
    [
        ({"input": "X"}, KeyError, "no column `X`"),
        ({"by": "idd"}, KeyError, "Did you mean `id`"),
        ({"time": "time"}, KeyError, "no column `time`"),
        ({"order": "T"}, KeyError, "no column `T`"),
        ({"order": None}, TypeError, "`order` is needed"),
        ({"smoth": 0.0}, TypeError, "`smooth`"),
        ({"levels": "many"}, TypeError, "`levels` is 'many'"),
        ({"target": "models.parquet"}, TypeError, "`?target`?"),
        ({"prior": object()}, TypeError, "`prior` cannot be sent"),
        ({"input": "word"}, RecordingError, "no column `word`"),
        ({"output": "x"}, RecordingError, "`x` is named twice"),
    ],
    ids=lambda value: "".join(value) if isinstance(value, dict) else "",
)
def test_what_is_wrong_is_raised_by_the_call(engine, wrong, error, message):
    with pytest.raises(error, match=message):
        engine.fit(engine.frame(samples(actuators=1)), **{**COLUMNS, "order": "t", **wrong})


def test_what_is_assumed_is_logged(engine, caplog):
    rows = samples(actuators=1).rename(columns={"t": "t [ms]"})
    engine.fit(engine.frame(rows), time="t [ms]", **COLUMNS)
    assert "the time in column `t [ms]` is in ms" in caplog.text


def test_the_example_runs():
    pytest.importorskip("dask.dataframe")
    from pyhysteron.fleet import dask

    found = doctest.testmod(dask, extraglobs={"np": np})
    assert found.attempted > 5 and not found.failed


@pytest.mark.parametrize("name, package", [("spark", "pyarrow"), ("dask", "dask")])
def test_a_missing_extra_is_named(monkeypatch, name, package):
    monkeypatch.setitem(sys.modules, package, None)
    monkeypatch.delitem(sys.modules, f"pyhysteron.fleet.{name}", raising=False)
    with pytest.raises(ImportError, match=rf"pip install 'pyhysteron\[{name}\]'"):
        importlib.import_module(f"pyhysteron.fleet.{name}")

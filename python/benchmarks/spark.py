"""A fleet in one process against Spark on the same machine.

    python python/benchmarks/spark.py

Actuators as in `fleet.py`. *Parts*: a task fits a table of 250 actuators, and `join_fleets` puts the tables together. *Groups*: `applyInPandas` fits one actuator after the other. Weights must be the same bits. Needs Java, `pyspark`, pandas and PyArrow.
"""

import os
import sys
import tempfile
from pathlib import Path

import numpy as np
import pandas
from fleet import EACH, OPTIONS, seconds, table
from pyspark.sql import SparkSession

import pyhysteron
from pyhysteron import fleet

ONE = {key: value for key, value in OPTIONS.items() if key not in ("by", "input", "output")}


def fit_part(part, folder):
    made = f"{folder}/{Path(part).stem}.parquet"
    fleet.fit_fleet([part], made, force=True, **OPTIONS)
    return made


def fit_parts(spark, parts, folder, target):
    """The tables of all parts, made by the executors, as one."""
    tasks = spark.sparkContext.parallelize(parts, len(parts))
    fleet.join_fleets(tasks.map(lambda part: fit_part(part, folder)).collect(), target, force=True)


def fit_group(samples):
    """The model of one actuator as a row. Spark does not keep the order of the samples."""
    samples = samples.sort_values("t")
    recording = pyhysteron.Recording(samples["x"].to_numpy(), samples["y"].to_numpy())
    model = pyhysteron.fit(recording, **ONE)
    return pandas.DataFrame({"id": [str(samples["id"].iloc[0])], "model": [model.to_json()]})


def fit_groups(spark, parts, target):
    """The models of all actuators as JSON, in a folder of Parquet files."""
    samples = spark.read.parquet(*parts)
    models = samples.groupBy("id").applyInPandas(fit_group, "id string, model string")
    models.write.mode("overwrite").parquet(target)


def main():
    random, cores = np.random.default_rng(1), os.cpu_count()
    # The workers of Spark need this Python, and the folder of `fleet`.
    os.environ |= {"PYSPARK_PYTHON": sys.executable, "PYTHONPATH": str(Path(__file__).parent)}
    os.environ["PYTHONWARNINGS"] = "ignore"
    builder = SparkSession.builder.master(f"local[{cores}]").config("spark.ui.enabled", "false")
    spark = builder.config("spark.log.level", "ERROR").getOrCreate()
    print(f"{cores} cores; seconds\n\n| actuators | one process | parts | groups |\n| ---: | ---: | ---: | ---: |")
    with tempfile.TemporaryDirectory() as folder:
        parts = [f"{folder}/part-{n}.parquet" for n in range(40)]
        for n, part in enumerate(parts):
            table(part, n, random)
        one, many, groups = (f"{folder}/{name}" for name in ("one.parquet", "many.parquet", "groups"))
        tables = Path(folder, "tables")
        tables.mkdir()
        for count in (2, 20, 40):
            local = seconds(lambda: fleet.fit_fleet(parts[:count], one, force=True, **OPTIONS))
            by_parts = seconds(lambda: fit_parts(spark, parts[:count], tables, many))
            by_groups = seconds(lambda: fit_groups(spark, parts[:count], groups))
            assert Path(one).read_bytes() == Path(many).read_bytes()
            models = pandas.read_parquet(groups).set_index("id")["model"]
            for name, model in fleet.read_fleet(one).items():
                alone = pyhysteron.Model.from_json(models[name])
                assert np.array_equal(alone.weights, model.weights, equal_nan=True), name
            print(f"| {count * EACH} | {local:.1f} | {by_parts:.1f} | {by_groups:.1f} |", flush=True)
    spark.stop()


if __name__ == "__main__":
    main()

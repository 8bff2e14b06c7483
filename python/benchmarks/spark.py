"""A fleet in one process against a Spark frame on the same machine.

    python python/benchmarks/spark.py

Actuators as in `fleet.py`; `spark.fit` of all samples, written as Parquet. The models must have the same bits. Needs Java and the extra `spark`.
"""

import os
import sys
import tempfile
from pathlib import Path

import numpy as np
from fleet import EACH, OPTIONS, same, seconds, table
from pyspark.sql import SparkSession

from pyhysteron import fleet
from pyhysteron.fleet import spark


def main():
    random, cores = np.random.default_rng(1), os.cpu_count()
    # The workers of Spark need this Python. As many of them work as there are cores.
    os.environ |= {"PYSPARK_PYTHON": sys.executable, "RAYON_NUM_THREADS": "1"}
    builder = SparkSession.builder.master(f"local[{cores}]").config("spark.ui.enabled", "false")
    session = builder.config("spark.log.level", "ERROR").getOrCreate()
    del os.environ["RAYON_NUM_THREADS"]
    print(f"{cores} cores; seconds\n\n| actuators | one process | Spark |\n| ---: | ---: | ---: |")
    with tempfile.TemporaryDirectory() as folder:
        parts = [f"{folder}/part-{n}.parquet" for n in range(40)]
        for n, part in enumerate(parts):
            table(part, n, random)
        one, many = f"{folder}/one.parquet", f"{folder}/many"
        for count in (2, 20, 40):
            local = seconds(lambda: fleet.fit_fleet(parts[:count], one, force=True, **OPTIONS))
            models = spark.fit(session.read.parquet(*parts[:count]), order="t", **OPTIONS)
            of_frame = seconds(lambda: models.write.mode("overwrite").parquet(many))
            assert same(Path(many), one)
            print(f"| {count * EACH} | {local:.1f} | {of_frame:.1f} |", flush=True)
    session.stop()


if __name__ == "__main__":
    main()

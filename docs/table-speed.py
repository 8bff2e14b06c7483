#!/usr/bin/env python3
"""CPU of `simulate` and `invert` on tables, beside peers and the limit of the system.

    python docs/table-speed.py target/release/hysteron

Prints Markdown. `mawk` and PyArrow are needed. All programs run in turn, several times, and the least
CPU (user and system) of each counts: other load only adds to it.
"""
import json
import math
import os
import random
import resource
import subprocess
import sys
import tempfile

ROWS = 1_000_000
ROUNDS = 15
LEVELS = 20
HEAD = """# CPU of tables

This page is printed by

    cargo build --release
    python docs/table-speed.py target/release/hysteron > docs/measured/table-speed.md

A table of {rows:,} rows: time, temperature, displacement and a column of words; the CSV has
{csv:.0f} MB. The model has {levels} levels. Figures are CPU seconds of the whole process, user and
system, the least of {rounds} runs in turn. The *limit* is `dd`, which copies the result and flushes it
to the disk, as the command does.

Before the run the load of the machine was {load:.1f} on {cores} processors. The command reads,
computes and writes on three threads; their CPU is added up.

- CSV: the peer is `mawk`, which copies the table with a column added: `{{print $0, $2*2}}`. It
  writes 6 digits and does not flush.
- Parquet and Arrow: the peer is PyArrow, which reads the file and writes it again, without a column
  added. Arrow files are not compressed. The time of starting Python and importing PyArrow is taken
  off.
"""


def table(path):
    """A slow swing in temperature with noise."""
    rng = random.Random(1)
    with open(path, "w") as file:
        file.write("time,temperature,displacement,note\n")
        for n in range(ROWS):
            t = n * 0.01
            x = 50 + 30 * math.sin(t * 0.37) * math.cos(t * 0.011) + rng.gauss(0, 0.01)
            file.write(f"{t:.2f},{x:.4f},{0.1 + 0.01 * x:.5f},run {n % 7}\n")


def model(path, levels):
    weights = [1 / levels**2] * (levels * (levels + 1) // 2)
    about = {
        "format": "hysteron-model", "version": 1, "operator": "mkp",
        "plane": {"min": 20.0, "max": 80.0, "levels": levels},
        "input": {"name": "temperature"},
        "output": {"name": "displacement", "offset": 0.0, "sign": 1}, "weights": weights,
    }
    with open(path, "w") as file:
        json.dump(about, file)


def cpu(command, out=None):
    """CPU seconds of a process."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with open(out or os.devnull, "wb") as file:
        subprocess.run(command, stdout=file, stderr=subprocess.DEVNULL, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def measure(program):
    """Size of the CSV in MB, and the CPU seconds of ours, the peer and the limit by command and
    format."""
    with tempfile.TemporaryDirectory() as folder:
        at = lambda name: os.path.join(folder, name)
        table(at("in.csv"))
        model(at("model.json"), LEVELS)
        import pyarrow.csv
        import pyarrow.feather
        import pyarrow.parquet
        read = pyarrow.csv.read_csv(at("in.csv"))
        pyarrow.parquet.write_table(read, at("in.parquet"))
        pyarrow.feather.write_feather(read, at("in.arrow"), compression="uncompressed")
        start = "import pyarrow.parquet as p, pyarrow.feather as f, sys"
        copy = {
            "parquet": "; p.write_table(p.read_table(sys.argv[1]), sys.argv[2])",
            "arrow": "; f.write_feather(f.read_table(sys.argv[1]), sys.argv[2], 'uncompressed')",
        }
        ours = {}
        for kind in ["csv", *copy]:
            source, result = at("in." + kind), at("out." + kind)
            for command, column in [
                ("simulate", "--input=temperature"),
                ("invert", "--target=displacement"),
            ]:
                ours[command, kind] = [
                    program, command, at("model.json"), source, column, "-o", result, "--force",
                ]
        add_column = ["mawk", "-F,", "-v", "OFS=,", "{print $0, $2*2}", at("in.csv")]
        least = {}

        def keep(name, seconds):
            least[name] = min(seconds, least.get(name, math.inf))
        for _ in range(ROUNDS):
            for (command, kind), words in ours.items():
                keep((command, kind), cpu(words))
                dd = ["dd", f"if={at('out.' + kind)}", f"of={at('copy')}", "bs=64k", "conv=fsync"]
                keep((command, kind, "limit"), cpu(dd))
            keep("csv", cpu(add_column, at("peer.csv")))
            keep("start", cpu([sys.executable, "-c", start]))
            for kind, work in copy.items():
                files = [at("in." + kind), at("peer." + kind)]
                keep(kind, cpu([sys.executable, "-c", start + work, *files]))
        size = os.path.getsize(at("in.csv")) / 1e6
        peer = {"csv": least["csv"], **{kind: least[kind] - least["start"] for kind in copy}}
        return size, {
            (command, kind): (least[command, kind], peer[kind], least[command, kind, "limit"])
            for command, kind in ours
        }


def main(program):
    load, cores = os.getloadavg()[0], os.cpu_count()
    size, found = measure(program)
    about = {"rows": ROWS, "levels": LEVELS, "rounds": ROUNDS, "csv": size}
    print(HEAD.format(**about, load=load, cores=cores))
    print("| command | ours, s | peer, s | limit, s | ours / peer | ours / limit |")
    print("| --- | ---: | ---: | ---: | ---: | ---: |")
    for (command, kind), (own, peer, limit) in found.items():
        name = "CSV" if kind == "csv" else kind.capitalize()
        print(
            f"| `{command}`, {name} | {own:.3f} | {peer:.3f} | {limit:.3f} "
            f"| {own / peer:.2f} | {own / limit:.1f} |"
        )


if __name__ == "__main__":
    main(sys.argv[1])

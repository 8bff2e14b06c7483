#!/usr/bin/env python3
"""What the project is measured by, in one table: ours, a peer, a limit, and the aim.

    python docs/peers.py target/release/hysteron

Prints Markdown. `cargo`, `mawk`, `/usr/bin/time`, NumPy, SciPy and PyArrow are needed.
"""
import json
import os
import re
import runpy
import subprocess
import sys
import tempfile
import time

import numpy as np
from scipy.optimize import nnls

HERE = os.path.dirname(os.path.abspath(__file__))
FITS = runpy.run_path(os.path.join(HERE, "fit-command.py"))
TABLES = runpy.run_path(os.path.join(HERE, "table-speed.py"))
ACTUATORS, ROWS = 10_000, 500
HEAD = """# Ours beside peers

This page is printed by

    cargo build --release
    python docs/peers.py target/release/hysteron > docs/measured/peers.md

Ours and the peer run in turn on the same machine, and the ratio is ours to the peer's. A *limit* is
a program that only moves the same data. Times of processes are CPU seconds, user and system, if
nothing else is said; memory is the most of a process. An aim in bold is missed. Where none stands
there is none.

Commands that fit look first for rows that disagree with the others. In a fleet without a choice
that takes most of the time: the small model of an actuator, whose start it has to find, takes three
times as long as its fit. `inspect` looks for such rows, too.

| what | ours | peer | limit | ratio | aim |
| --- | ---: | --- | --- | ---: | ---: |"""


def row(what, ours, peer, limit, ratio, aim):
    """`aim` bounds the ratio from above, where there is one."""
    told = "" if aim is None else f"{aim:g}" if ratio <= aim else f"**{aim:g}**"
    print(f"| {what} | {ours} | {peer} | {limit} | {ratio:.2f} | {told} |", flush=True)


def cpu(command):
    """Seconds, and CPU seconds."""
    begin = time.perf_counter()
    used = TABLES["cpu"](command)
    return time.perf_counter() - begin, used


def fits(program, folder):
    out = os.path.join(folder, "fit.json")
    data = FITS["recording"](program, folder, 20, 10**6)
    fit = [program, "fit", data, *FITS["COLUMNS"], "-o", out, "--levels", "20"]
    read = [program, "inspect", data, *FITS["COLUMNS"][:4]]
    for name, options in [("smoothness chosen", []), ("no choice", FITS["PLAIN"])]:
        ours, alone, limit = (
            min(cpu(command)[1] for _ in range(3))
            for command in ([*fit, *options], [*fit, *options, "--bootstrap", "0"], read)
        )
        row(f"`fit`, 1e6 rows, K = 20, {name}, with confidence", f"{ours:.2f} s",
            f"without: {alone:.2f} s", f"`inspect`: {limit:.2f} s", ours / alone, 3)
    data = FITS["recording"](program, folder, 40, 10**4)
    fit = [program, "fit", data, *FITS["COLUMNS"], "-o", out, "--levels", "40", *FITS["PLAIN"],
           *"--bootstrap 0 --ridge 0 --robust off --start off --sign positive".split()]
    ours = min(cpu(fit)[1] for _ in range(5))
    x, y = np.loadtxt(data, delimiter=",", skiprows=1, unpack=True)
    phi = FITS["regressor"](40, x)
    begin = time.process_time()
    nnls(phi - phi.mean(axis=0), y - y.mean(), maxiter=30 * phi.shape[1])
    peer = time.process_time() - begin
    row("`fit`, 1e4 rows, K = 40, the same minimum", f"{ours:.3f} s",
        f"SciPy `nnls`: {peer:.2f} s", "", ours / peer, 1)


def tables(program):
    _, found = TABLES["measure"](program)
    for (command, kind), (ours, peer, limit) in found.items():
        name, who, aim = {
            "csv": ("CSV", "`mawk`", 0.25),
            "parquet": ("Parquet", "PyArrow", 1),
            # It copies blocks that are in memory as they are in the file.
            "arrow": ("Arrow", "PyArrow", None),
        }[kind]
        row(f"`{command}`, 1e6 rows, {name}", f"{ours:.3f} s", f"{who}: {peer:.3f} s",
            f"`dd`: {limit:.3f} s", ours / peer, aim)


def core():
    """Rows of the bench: `A / B`, its aim, and the nanoseconds of both."""
    bench = ["cargo", "bench", "--locked", "--package", "hysteron-core", "--bench", "speed"]
    done = subprocess.run(bench, check=True, capture_output=True, text=True)
    line = re.compile(r"^(.*?)  +([\d.]+) +≤ ([\d.]+) .*? ([\d.]+) +([\d.]+)$")
    for found in filter(None, map(line.match, done.stdout.splitlines())):
        name, ratio, aim, ours, peer = found.groups()
        row(name, f"{ours} ns", f"{peer} ns", "", float(ratio), float(aim))


def actuators(path):
    """Loops of random actuators: five plays of random widths and weights each."""
    import pyarrow
    import pyarrow.parquet
    rng = np.random.default_rng(1)
    phase = np.linspace(0, 6 * np.pi, ROWS)
    x = 50 + 30 * np.linspace(1, 0.4, ROWS) * np.sin(phase)
    width = rng.uniform(2, 20, (ACTUATORS, 5))
    weight = rng.uniform(0.1, 1, (ACTUATORS, 5))
    play = np.full((ACTUATORS, 5), x[0])
    y = np.empty((ACTUATORS, ROWS))
    for n, now in enumerate(x):
        play = np.clip(play, now - width, now + width)
        y[:, n] = (weight * play).sum(axis=1)
    y += 0.01 * rng.standard_normal(y.shape)
    columns = {
        "id": np.repeat(np.arange(ACTUATORS), ROWS), "x": np.tile(x, ACTUATORS), "y": y.ravel(),
    }
    pyarrow.parquet.write_table(pyarrow.table(columns), path, row_group_size=100 * ROWS)
    return x, y


def fleet(program, folder):
    data, out = (os.path.join(folder, name) for name in ("fleet.parquet", "models.parquet"))
    x, y = actuators(data)
    options = ["--input", "x", "--output", "y", "--levels", "20", *FITS["PLAIN"], "--force"]
    options += "--bootstrap 0 --robust off --start off".split()
    command = [program, "fleet", "fit", data, "--by", "id", *options, "-o", out]
    (wall, used), *_ = sorted(cpu(command) for _ in range(2))
    one, model = (os.path.join(folder, name) for name in ("one.csv", "one.json"))
    each, apart, some = 0.0, 0.0, range(0, ACTUATORS, ACTUATORS // 20)
    for n in some:
        np.savetxt(one, np.c_[x, y[n]], delimiter=",", header="x,y", comments="", fmt="%.17g")
        each += cpu([program, "fit", one, *options, "-o", model])[1]
        extracted = os.path.join(folder, "extracted.json")
        subprocess.run([program, "fleet", "extract", out, str(n), "-o", extracted, "--force"],
                       check=True, stdout=subprocess.DEVNULL)
        alone, member = (np.array(json.load(open(file))["weights"]) for file in (model, extracted))
        apart = max(apart, np.abs(alone - member).max() / alone.sum())
    each *= ACTUATORS / len(some)
    read = "import pyarrow.parquet as p, sys; p.read_table(sys.argv[1])"
    limit = cpu([sys.executable, "-c", read, data])[1]
    row(f"`fleet fit`, {ACTUATORS:,} recordings of {ROWS} rows, K = 20, no choice", f"{used:.1f} s",
        f"a process each (of {len(some)}): {each:.0f} s", f"PyArrow reads: {limit:.2f} s",
        used / each, 1)
    cores = os.cpu_count()
    row(f"the same, seconds on {cores} cores", f"{wall:.1f} s", "1 s", "", wall, 6)
    row("the same, largest difference of a weight from `fit` alone, of their sum, in 1e-9",
        f"{apart / 1e-9:.2g}", "1", "", apart / 1e-9, 1)


def memory(program, folder):
    """The most memory of whole processes on ten million rows of two columns."""
    import pyarrow
    import pyarrow.csv
    data, model, out = (os.path.join(folder, name) for name in ("long.csv", "long.json", "out.csv"))
    n = np.arange(10**7)
    x = 50 + 29 * np.sin(1e-3 * n) * np.cos(1.7e-5 * n)
    y = 0.1 * x + 1e-3 * np.random.default_rng(1).uniform(-0.5, 0.5, n.size)
    columns = {"x": x.round(4), "y": y.round(6)}
    pyarrow.csv.write_csv(pyarrow.table(columns), data)

    def highest(command):
        """In MB. `ru_maxrss` would count this script."""
        told = ["/usr/bin/time", "-f", "%M", *command]
        done = subprocess.run(told, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        return int(done.stderr.split()[-1]) * 1024 / 1e6

    read = "import pyarrow.csv, sys; pyarrow.csv.read_csv(sys.argv[1])"
    peer = highest([sys.executable, "-c", read, data])
    both = ["--input", "x", "--output", "y"]
    options = "--bootstrap 0 --robust off --start off --levels 20".split()
    fit = [program, "fit", data, *both, *FITS["PLAIN"], *options, "-o", model]
    for name, command in [
        ("`fit`, 1e7 rows, K = 20, no choice", fit),
        ("`evaluate`, 1e7 rows", [program, "evaluate", model, data, *both]),
    ]:
        ours = highest(command)
        row(f"{name}, memory", f"{ours:.0f} MB", f"PyArrow reads: {peer:.0f} MB",
            f"two columns: {16e-6 * n.size:.0f} MB", ours / peer, None)
    limit = highest([program, "--version"])
    for command, column in [("simulate", "--input=x"), ("invert", "--target=y")]:
        ours = highest([program, command, model, data, column, "-o", out, "--force"])
        row(f"`{command}`, 1e7 rows, CSV, memory", f"{ours:.1f} MB", "1 MB",
            f"`--version`: {limit:.1f} MB", ours, 7)


def main(program):
    print(HEAD)
    with tempfile.TemporaryDirectory() as folder:
        fits(program, folder)
        tables(program)
        core()
        fleet(program, folder)
        memory(program, folder)


if __name__ == "__main__":
    main(os.path.abspath(sys.argv[1]))

#!/usr/bin/env python3
"""Runs hostile cases through the command, and prints a table: class, cases, faults.

    fuzz/hostile.py [CASES] [--seed N] [--only CLASS] [--hysteron COMMAND]

By default there are 200 cases of each class, and the command is target/release/hysteron.

A fault is one of these:

- a panic, a signal, more than SECONDS or MEMORY, an exit code that does not exist;
- a failure without a message, or one that leaves something behind;
- another file changed;
- success with a result that is not whole.

Calls of the core and of the C interface are drawn by their fuzz targets (fuzz/run builds them).
"""

import argparse
import csv
import json
import os
import random
import re
import resource
import signal
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

import cases
from studio import Studio

SECONDS = 60
MEMORY = 4 << 30
TARGETS = ("core_walk", "inverse", "c_calls")


def limited(limits):
    """Limits of the process: its memory, and a full disk where the case says so."""

    def start():
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if "file_size" in limits:
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (limits["file_size"],) * 2)

    return start


def contents(folder):
    """Everything below a folder, links as what they point to."""
    found = {}
    for path in sorted(folder.rglob("*")):
        name = str(path.relative_to(folder))
        found[name] = (
            os.readlink(path)
            if path.is_symlink()
            else path.read_bytes()
            if path.is_file()
            else None
        )
    return found


def not_whole_table(hysteron, path):
    """What a table lacks that a command has written."""
    if path.suffix in (".xlsx", ".mat"):
        return "a format that is not written"
    if path.suffix in (".parquet", ".arrow"):
        read = subprocess.run([hysteron, "inspect", path], capture_output=True, check=False)
        return None if read.returncode == 0 else f"a copy that is damaged: {read.stderr.decode()}"
    with path.open(newline="", encoding="utf-8", errors="replace") as text:
        rows = list(csv.reader(text))
    if not rows or any(len(row) != len(rows[0]) for row in rows):
        return "rows of different length"
    added = [n for n, name in enumerate(rows[0]) if name in ("output_model", "input_model")]
    if added and any(row[added[-1]] in ("NaN", "inf", "-inf", "") for row in rows[1:]):
        return "a result that is no number"
    return None


def not_whole(hysteron, command, path):
    """The same for any result."""
    if command in ("simulate", "invert", "prepare"):
        return not_whole_table(hysteron, path)
    if command == "fit":
        try:
            json.loads(path.read_text())
        except ValueError:
            return "JSON that is not whole"
    return None


def fault(hysteron, case, done, before, folder):
    """What is wrong with how a case ended, or None."""
    if done.returncode < 0:
        return f"signal {-done.returncode}"
    if done.returncode not in (0, 1, 2) or b"panicked" in done.stderr:
        return f"exit code {done.returncode}"
    after = contents(folder)
    changed = [name for name in before if after.get(name, ...) != before[name]]
    if changed:
        return f"{changed[0]} changed"
    new = [name for name in after if name not in before]
    # Where standard output is full, the last words fail. What was made before them stays, whole.
    if done.returncode == 0 or case.stdout:
        if case.out and case.out not in new:
            return "success, and no result"
        if done.returncode != 0 and not done.stderr.strip():
            return "a failure without words"
        broken = [
            not_whole(hysteron, case.arguments[0], folder / name)
            for name in new
            if after[name] is not None
        ]
        return next(filter(None, broken), None)
    if not done.stderr.strip():
        return "a failure without words"
    return f"{new[0]} left behind" if new else None


def run(hysteron, case):
    """A case in a folder of its own: the fault, or None."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        case.set_up(folder)
        before = contents(folder)
        if case.arguments[0] == "studio":
            return visited(hysteron, case, before, folder)
        with open(case.stdout or os.devnull, "wb") as stdout:
            try:
                done = subprocess.run(
                    [hysteron, *case.arguments],
                    cwd=folder,
                    stdin=subprocess.DEVNULL,
                    stdout=stdout,
                    stderr=subprocess.PIPE,
                    timeout=SECONDS,
                    preexec_fn=limited(case.limits),
                    check=False,
                )
            except subprocess.TimeoutExpired:
                return f"more than {SECONDS} s"
        return fault(hysteron, case, done, before, folder)


def visited(hysteron, case, before, folder):
    """A studio that opens a session: what is in it is asked for, and its commands are run by a shell
    in which there is no program. The fault, or None."""
    try:
        studio = Studio(hysteron, case.arguments[1:], folder, limited(case.limits))
    except ValueError as error:
        return str(error)
    problem = None
    if studio.address:
        try:
            problem = "words that a shell runs" if not studio.quotes(folder) else None
        except (OSError, ValueError) as error:
            problem = f"no answer: {error}"
    code, stderr = studio.end(SECONDS)
    if code not in (0, 1, 2) or b"panicked" in stderr:
        return f"exit code {code}"
    if not studio.address and (code == 0 or not stderr.strip()):
        return "a failure without words"
    return problem or next((f"{n} changed" for n in before if contents(folder).get(n, ...) != before[n]), None)


def through_the_command(title, generate, count, seed, hysteron):
    """A row of the table; what went wrong on standard error."""
    rng = random.Random(f"{title} {seed}")
    generator = generate(rng)
    faults = Counter()
    for _ in range(count):
        case = next(generator)
        problem = run(hysteron, case)
        if problem:
            if not faults[problem]:
                print(
                    f"{title}: {problem}: {' '.join(case.arguments)[:200]} {case.limits or ''}",
                    file=sys.stderr,
                )
            faults[problem] += 1
    return title, count, faults.total()


def through_a_target(name, count, seed, target):
    """The same by a fuzz target, which was built before."""
    found = sorted(target.glob(f"fuzz/*/release/{name}"))
    if not found:
        why = f"hostile cases of {name}: its fuzz target is not built (fuzz/run)"
        subprocess.run([cases.ROOT / "tools/skipped", why], check=True)
        return None
    with tempfile.TemporaryDirectory() as artifacts:
        # libFuzzer takes a seed of 0 for any.
        flags = [f"-runs={count}", f"-seed={seed + 1}", f"-artifact_prefix={artifacts}/"]
        done = subprocess.run(
            [found[0], *flags, cases.ROOT / f"fuzz/corpus/{name}"],
            capture_output=True,
            text=True,
            cwd=artifacts,
            check=False,
        )
    if done.returncode != 0:
        print(f"{name}: {done.stderr[-2000:]}", file=sys.stderr)
    executions = re.search(r"Done (\d+) runs", done.stderr)
    return name, int(executions[1]) if executions else 0, int(done.returncode != 0)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("cases", type=int, nargs="?", default=200)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", metavar="CLASS", help="cases of this class alone")
    parser.add_argument("--hysteron", type=Path)
    given = parser.parse_args()
    count, seed = given.cases, given.seed
    told = subprocess.run([cases.ROOT / "tools/target"], capture_output=True, text=True, check=True)
    target = Path(told.stdout.strip())
    hysteron = (given.hysteron or target / "release/hysteron").resolve()
    if not hysteron.exists():
        sys.exit(f"{hysteron} is missing: cargo build --release, or name the command")
    fixtures = {
        "Parquet": (
            "none.parquet",
            "snappy.parquet",
            "gzip.parquet",
            "zstd.parquet",
            "lz4.parquet",
        ),
        "Arrow": ("none.arrow", "zstd.arrow", "lz4.arrow", "kinds.arrow", "stream.arrows"),
        "MAT v5": ("v5.mat",),
        "MAT v7": ("v7.mat",),
        "MAT v7.3": ("v73.mat",),
    }
    classes = {
        "delimited text": cases.text,
        **{title: cases.binary(*names) for title, names in fixtures.items()},
        "Parquet, copied": cases.copies(*fixtures["Parquet"], "kinds.parquet"),
        "Arrow, copied": cases.copies(*fixtures["Arrow"]),
        "studio sessions": cases.sessions(Studio.session(hysteron, cases.recording())),
        "model files": cases.model_files,
        "scenarios": cases.scenarios,
        "arguments": cases.arguments(hysteron),
        "file system": cases.situations,
    }
    rows = [
        through_the_command(title, generate, count, seed, hysteron)
        for title, generate in classes.items()
        if given.only in (None, title)
    ]
    # A call in the same process is a thousand times as quick.
    targets = [name for name in TARGETS if given.only in (None, name)]
    rows += [through_a_target(name, 1000 * count, seed, target) for name in targets]
    print("| class | cases | faults |\n| --- | ---: | ---: |")
    for title, number, faults in filter(None, rows):
        print(f"| {title} | {number:,} | {faults} |")
    sys.exit(any(row and row[2] for row in rows))


main()

#!/usr/bin/env python3
"""Where the time of a default fit goes: seconds of CPU by part, for programs of several versions.

    python docs/fit-profile.py earlier=PROGRAM now=PROGRAM

Prints Markdown. It needs Linux, `perf`, NumPy, SciPy, and programs with frame pointers and symbols:

    RUSTFLAGS=-Cforce-frame-pointers=yes CARGO_PROFILE_RELEASE_STRIP=none cargo build --release
"""
import os
import re
import runpy
import subprocess
import sys
import tempfile
from collections import Counter

HERE = os.path.dirname(os.path.abspath(__file__))
FITS = runpy.run_path(os.path.join(HERE, "fit-command.py"))
SAMPLES = 10**4, 10**6
# A line of `perf script`: address, name, offset and program.
FRAME = re.compile(r"^\s*[0-9a-f]+ (.*?)(\+0x[0-9a-f]+)? \(.*$")
HEAD = """# Where the time of a default fit goes

This page is printed by

    python docs/fit-profile.py earlier=PROGRAM now=PROGRAM > docs/measured/fit-profile.md

*Earlier* is commit b69cf406, before the start of a recording became a history. It runs the choice
for each kind of start. Both programs run `hysteron fit` without an option on one thread, on the
material of 20 levels of [the page on the command](fit-command.md). `perf` samples them 1000 times a
second of CPU. A sample counts for the first part in the table that any of its functions belongs to;
in the second table, for the innermost function that has a row."""
# What a part is, and functions below which all belongs to it.
PARTS = [
    ("rows that disagree, advice", r"hysteron::prepare::|hysteron::advice"),
    ("confidence, with the bootstrap", r"identify::(doubt|confidence|bootstrap)"),
    ("outliers", r"identify::outliers"),
    ("start", r"choose::start|identify::rest|usual_start"),
    ("spacing and other stages", r"stages::spacing|stages::search|stages::after|identify::spacing"),
    ("choice of levels and smoothness", r"choose::|cross_validat|sums::Reduced"),
    ("the fit itself", r"identify::"),
    ("reading and checking the file", r"hysteron::data::|hysteron_files|hysteron::recording"),
]
REST = "all else"
# The same time by what is computed, from the innermost function outwards.
KERNELS = [
    ("sparse factors", r"corner_system|grid_factor|supernodal|simplicial|symbolic_cholesky|amd_"),
    ("dense algebra", r"^(faer|pulp|private_gemm|nano_gemm|gemm)|matmul|cholesky|triangular_solve"),
    ("products and searches of the weights",
     r"weights::(solve|pivoting|nnls|nested|gram|corner_gram)"),
    ("sums over the samples", r"weights::(sparse|regressor|sums|rows|units|unit_sums|experiment)"),
    ("operators", r"hysteron_core::"),
]


def stacks(text):
    """The stacks of `perf script`, each from the innermost function outwards."""
    for block in text.split("\n\n"):
        lines = [line for line in block.splitlines() if line.startswith("\t")]
        names = [FRAME.sub(r"\1", line) for line in lines]
        if names:
            yield names


def first(names, kinds):
    """The first of the kinds that any of the names is of."""
    return next((kind for kind, words in kinds if any(re.search(words, n) for n in names)), REST)


def inner(names):
    """The kind of the innermost name that has one."""
    return next((k for k in (first([n], KERNELS) for n in names) if k != REST), REST)


def profile(program, data, folder):
    """CPU seconds of a default fit, by part and by kernel."""
    record, model = (os.path.join(folder, name) for name in ("perf.data", "model.json"))
    fit = [program, "fit", data, *FITS["COLUMNS"], "-o", model]
    subprocess.run(["perf", "record", "-q", "-F", "1000", "--call-graph", "fp", "-o", record, *fit],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                   env={**os.environ, "RAYON_NUM_THREADS": "1"})
    text = subprocess.run(["perf", "script", "-i", record], capture_output=True, text=True,
                          check=True).stdout
    parts, kernels = Counter(), Counter()
    for names in stacks(text):
        parts[first(names, PARTS)] += 1e-3
        kernels[inner(names)] += 1e-3
    return parts, kernels


def table(title, kinds, found):
    columns = [f"{name}, {samples:.0e} samples".replace("e+0", "e") for name, samples in found]
    print(f"\n| {title} | {' | '.join(columns)} |\n| --- |{' ---: |' * len(columns)}")
    for kind in [*(kind for kind, _ in kinds), REST]:
        print(f"| {kind} | {' | '.join(f'{one[kind]:.2f} s' for one in found.values())} |")
    print(f"| together | {' | '.join(f'{sum(one.values()):.2f} s' for one in found.values())} |")


def main(programs):
    print(HEAD)
    with tempfile.TemporaryDirectory() as folder:
        found = {}
        for samples in SAMPLES:
            for name, program in programs:
                data = FITS["recording"](programs[-1][1], folder, 20, samples)
                found[name, samples] = profile(program, data, folder)
        table("part", PARTS, {key: parts for key, (parts, _) in found.items()})
        table("what is computed", KERNELS, {key: kernels for key, (_, kernels) in found.items()})


if __name__ == "__main__":
    main([argument.split("=", 1) for argument in sys.argv[1:]])

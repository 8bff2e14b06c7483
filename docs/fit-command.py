#!/usr/bin/env python3
"""Time and memory of `hysteron fit` by rows and levels, and peers at the same optimum.

    python docs/fit-command.py target/release/hysteron [MOST [EARLIER]]

MOST is the largest number of samples. EARLIER is a program of another version, whose default fits
stand beside. Prints Markdown. Peers that are not installed are left out: SciPy, scikit-learn, OSQP, quadprog.
Instructions are counted by callgrind, where Valgrind is installed.
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

import numpy as np
from scipy.optimize import lsq_linear, nnls

LOW, HIGH = 20.0, 80.0
COLUMNS = ["--input", "temperature", "--output", "displacement", "--force"]
PLAIN = ["--smooth", "off", "--spacing", "uniform"]
HEAD = """# Time and memory of the command `fit`

This page is printed by

    cargo build --release
    python docs/fit-command.py target/release/hysteron 1e7 > docs/measured/fit-command.md

`hysteron fit` as a whole process, with reading the file. The last argument is the largest number of
samples. CPU is that of all threads, memory the highest of the process. By default there is a
bootstrap up to 44 levels. Before each fit the command looks for rows that disagree with the others,
by a few small models of at most 10,000 rows, and by some fifteen more where a stretch of rows may
do harm."""
# Longer runs are given up.
PATIENCE = 300


def recording(program, folder, levels, samples):
    """A material with two hills of density, driven over the whole plane, with noise of 1 %."""
    name = os.path.join(folder, f"{levels}-{samples}.csv")
    if os.path.exists(name):
        return name
    rng = np.random.default_rng(1)
    j, i = np.tril_indices(levels)
    i, j = (i + 1) / levels, (j + 1) / levels
    hill = lambda a, b, width: np.exp(-((i - a) ** 2 + (j - b) ** 2) / width**2)
    density = hill(0.3, 0.6, 0.1) + 0.4 * hill(0.5, 0.8, 0.07)
    weights = np.where(density > 0.01, density / levels**2, 0.0)
    model = {
        "format": "hysteron-model", "version": 1, "operator": "mkp",
        "plane": {"min": LOW, "max": HIGH, "levels": levels},
        "input": {"name": "temperature"},
        "output": {"name": "displacement", "offset": 1.0, "sign": 1},
        "weights": weights.tolist(),
    }
    model_file = os.path.join(folder, "model.json")
    with open(model_file, "w") as file:
        json.dump(model, file)
    step = (HIGH - LOW) / (levels - 1)
    turns = [0]
    for level in range(1, levels + 1):
        turns += [level, 0]
    turns += rng.integers(0, levels + 1, levels).tolist()
    turns = LOW - step + step * np.array(turns)
    path = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(turns)))])
    moves = np.concatenate([[True], np.diff(path) > 0])
    x = np.interp(np.linspace(0, path[-1], samples), path[moves], turns[moves])
    inputs, outputs = (os.path.join(folder, file) for file in ("in.csv", "out.csv"))
    np.savetxt(inputs, x, header="temperature", comments="", fmt="%.17g")
    command = ["simulate", model_file, inputs, "--input", "temperature", "-o", outputs, "--force"]
    subprocess.run([program, *command], check=True, stderr=subprocess.DEVNULL)
    y = np.loadtxt(outputs, delimiter=",", skiprows=1, usecols=1)
    y += 0.01 * (y.max() - y.min()) * rng.standard_normal(samples)
    np.savetxt(name, np.c_[x, y], header="temperature,displacement", comments="", delimiter=",",
               fmt="%.9g")
    return name


def run(program, data, options, out):
    """Seconds, seconds of CPU and MiB of a fit; None if it takes too long."""
    command = [program, "fit", data, *COLUMNS, *options, "-o", out]
    start = time.perf_counter()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    memory = 0
    while True:
        memory = max(memory, highest(child.pid))
        pid, status, usage = os.wait4(child.pid, os.WNOHANG)
        if pid:
            break
        if time.perf_counter() - start > PATIENCE:
            child.kill()
            os.wait4(child.pid, 0)
            return None
        time.sleep(0.002)
    wall = time.perf_counter() - start
    if status:
        raise SystemExit(f"{' '.join(command)} failed")
    return wall, usage.ru_utime + usage.ru_stime, memory / 1024


def highest(pid):
    """The most memory that a process has had so far, in KiB. `ru_maxrss` would count this script."""
    try:
        with open(f"/proc/{pid}/status") as file:
            found = re.search(r"VmHWM:\s+(\d+)", file.read())
    except OSError:
        return 0
    return int(found.group(1)) if found else 0


def instructions(program, data, options, out):
    """Millions of instructions on one thread, or None."""
    if shutil.which("valgrind") is None:
        return None
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, "fit",
               data, *COLUMNS, *options, "-o", out]
    environment = {**os.environ, "RAYON_NUM_THREADS": "1"}
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    found = re.search(r"Collected : (\d+)", done.stderr)
    return int(found.group(1)) / 1e6 if found else None


def growth(program, folder, most):
    print("\n| levels | samples | options | CPU | time | memory |")
    print("| ---: | ---: | --- | ---: | ---: | ---: |")
    every = [
        ("no choice, no bootstrap", [*PLAIN, "--bootstrap", "0"]),
        ("no choice, default bootstrap", PLAIN),
        ("smoothness 1e-8, no bootstrap",
         ["--smooth", "1e-8", "--spacing", "uniform", "--bootstrap", "0"]),
    ]
    for levels, samples in [(20, 10**4), (20, 10**5), (20, 10**6), (20, 10**7), (40, 10**5),
                            (100, 10**4), (100, 10**5), (200, 10**5), (400, 10**5)]:
        if samples > most:
            continue
        data = recording(program, folder, levels, samples)
        own = [(name, ["--levels", str(levels), *options]) for name, options in every]
        if levels == 100 and samples == 10**4:
            smooth = ["--smooth", "auto", "--spacing", "uniform", "--bootstrap", "0"]
            own.append(("smoothness left to the data", ["--levels", str(levels), *smooth]))
        for name, options in own:
            found = run(program, data, options, os.path.join(folder, "x.json"))
            figures = "| " + f"over {PATIENCE} s | | |"
            if found:
                wall, cpu, memory = found
                figures = f"| {cpu:.2f} s | {wall:.2f} s | {memory:.0f} MiB |"
            print(f"| {levels} | {samples} | {name} {figures}", flush=True)


def defaults(program, folder, most, earlier):
    """Fits without any option, of this program and of an earlier one."""
    print("\nAll left to the data: `hysteron fit` without an option, on the material of 20 levels. "
          "*Left out* is\nthe error on branches left out, in percent of the range.\n")
    print("| samples | version | CPU | time | memory | levels | left out |")
    print("| ---: | --- | ---: | ---: | ---: | ---: | ---: |")
    for samples in [10**3, 10**4, 10**5, 10**6, 10**7]:
        if samples > most:
            continue
        data = recording(program, folder, 20, samples)
        for version, own in [("before", earlier), ("now", program)]:
            if own is None:
                continue
            out = os.path.join(folder, "x.json")
            found = run(own, data, [], out)
            if found is None:
                print(f"| {samples} | {version} | over {PATIENCE} s | | | | |", flush=True)
                continue
            wall, cpu, memory = found
            with open(out) as file:
                model = json.load(file)
            error = model["fit"]["validation"]["nrmse_percent"]
            print(f"| {samples} | {version} | {cpu:.2f} s | {wall:.2f} s | {memory:.0f} MiB "
                  f"| {model['plane']['levels']} | {error:.3f} % |", flush=True)


def regressor(levels, samples):
    """The states of all MKP operators at every sample, from all off."""
    step = (HIGH - LOW) / (levels - 1)
    j, i = np.tril_indices(levels)
    x = np.clip((samples - LOW) / step + 1.0, 0.0, levels)
    phi = np.empty((len(x), len(i)))
    gamma = np.zeros(len(i))
    for n, position in enumerate(x):
        ridge = np.clip(position - np.arange(levels), 0.0, 1.0)
        gamma = np.maximum(ridge[j], np.minimum(gamma, ridge[i]))
        phi[n] = gamma
    return phi


def peers():
    """Solvers of min |phi x + offset - y|², x >= 0, as functions of phi and y."""
    def centred(phi, y):
        return phi - phi.mean(axis=0), y - y.mean()

    found = {
        "SciPy `nnls`": lambda phi, y: nnls(*centred(phi, y), maxiter=30 * phi.shape[1])[0],
        "SciPy `lsq_linear`": lambda phi, y: lsq_linear(
            *centred(phi, y), bounds=(0, np.inf), tol=1e-12, max_iter=1000).x,
    }
    try:
        from sklearn.linear_model import LinearRegression
        found["scikit-learn `LinearRegression(positive=True)`"] = (
            lambda phi, y: LinearRegression(positive=True).fit(phi, y).coef_)
    except ImportError:
        pass
    try:
        import quadprog

        def dual(phi, y):
            a, b = centred(phi, y)
            gram = a.T @ a + 1e-11 * np.trace(a.T @ a) / a.shape[1] * np.eye(a.shape[1])
            return quadprog.solve_qp(gram, a.T @ b, np.eye(len(gram)), np.zeros(len(gram)))[0]

        found["quadprog, Gram matrix"] = dual
    except ImportError:
        pass
    try:
        import osqp
        import scipy.sparse as sparse

        def splitting(phi, y):
            a, b = centred(phi, y)
            solver = osqp.OSQP()
            count = a.shape[1]
            solver.setup(sparse.csc_matrix(np.triu(a.T @ a)), -(a.T @ b),
                         sparse.identity(count, format="csc"), np.zeros(count),
                         np.full(count, np.inf), eps_abs=1e-9, eps_rel=1e-9, max_iter=400_000,
                         polishing=True, verbose=False)
            return np.maximum(solver.solve().x, 0.0)

        found["OSQP, Gram matrix"] = splitting
    except ImportError:
        pass
    return found


def compare(program, folder):
    print("\n| levels | samples | solver | time | ratio | squared error, relative to the least |")
    print("| ---: | ---: | --- | ---: | ---: | ---: |")
    for levels in [20, 40]:
        data = recording(program, folder, levels, 10**4)
        x, y = np.loadtxt(data, delimiter=",", skiprows=1).T
        out = os.path.join(folder, "x.json")
        options = ["--levels", str(levels), "--range", f"{LOW},{HIGH}", *PLAIN, "--ridge", "0",
                   "--robust", "off", "--start", "off", "--sign", "positive", "--bootstrap", "0"]
        best = min(run(program, data, options, out)[0] for _ in range(5))
        with open(out) as file:
            model = json.load(file)
        start = time.perf_counter()
        phi = regressor(levels, x)
        built = time.perf_counter() - start
        squares = lambda weights: float(np.var(y - phi @ np.array(weights)) * len(y))
        rows = [("`hysteron fit`, whole process", best, squares(model["weights"]))]
        for name, solve in peers().items():
            start = time.perf_counter()
            weights = solve(phi, y)
            rows.append((f"{name}", time.perf_counter() - start, squares(weights)))
        rows.append(("(dense regressor, in addition to each peer)", built, None))
        least = min(row[2] for row in rows if row[2] is not None)
        for name, seconds, error in rows:
            error = "" if error is None else f"{error / least - 1:.1e}"
            print(f"| {levels} | 10000 | {name} | {seconds:.3f} s | {seconds / best:.1f} | {error} |",
                  flush=True)


def counts(program, folder):
    data = recording(program, folder, 20, 10**4)
    print("\n| levels | samples | options | millions of instructions |")
    print("| ---: | ---: | --- | ---: |")
    for name, options in [
        ("no choice, no bootstrap", [*PLAIN, "--bootstrap", "0"]),
        ("no choice, default bootstrap", PLAIN),
    ]:
        found = instructions(program, data, ["--levels", "20", *options],
                             os.path.join(folder, "x.json"))
        print(f"| 20 | 10000 | {name} | {'–' if found is None else f'{found:.0f}'} |", flush=True)


def main():
    program = os.path.abspath(sys.argv[1])
    most = int(float(sys.argv[2])) if len(sys.argv) > 2 else 10**7
    earlier = os.path.abspath(sys.argv[3]) if len(sys.argv) > 3 else None
    with tempfile.TemporaryDirectory() as folder:
        print(HEAD)
        defaults(program, folder, most, earlier)
        growth(program, folder, most)
        print("\nThe same minimum by others, which take the dense regressor: weights from zero on, a "
              "free offset,\nno prior. Their time is that of the solver alone.")
        compare(program, folder)
        print("\nInstructions, which do not depend on the neighbours, on one thread (callgrind).")
        counts(program, folder)


if __name__ == "__main__":
    main()

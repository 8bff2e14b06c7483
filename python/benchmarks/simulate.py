"""What a sample takes in Python and in Rust, on the same machine in the same run; and what the package weighs.

    python python/benchmarks/simulate.py

With cargo and this repository the Rust figure is measured as well. The package has to be built with optimisation
(``pip install .``); `maturin develop` alone does not.
"""

import argparse
import pathlib
import statistics
import subprocess
import sys
import tempfile
import zlib

import numpy as np
from timing import best

import pyhysteron
from pyhysteron import _hysteron

ROOT = pathlib.Path(__file__).resolve().parents[2]
SAMPLES = 1_000_000
RUNS = 50


def inputs(plane):
    """Slow swings, as actuators are driven, and noise, in which every sample turns."""
    low, high = plane[0] - 3, plane[-1] + 3
    t = np.linspace(0, 200, SAMPLES)
    middle, half = (low + high) / 2, (high - low) / 2
    yield "swings", middle + half * np.sin(t) * np.cos(0.013 * t)
    yield "noise", np.random.default_rng(0).uniform(low, high, SAMPLES)


def rust(model, input):
    """Nanoseconds a sample of `Model::run`, or None without cargo."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        model.save(folder / "model.json")
        input.astype("<f8").tofile(folder / "samples")
        command = "cargo run --release --quiet --package hysteron-measure -- simulate-speed"
        command = [*command.split(), folder / "model.json", folder / "samples"]
        try:
            done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
        except FileNotFoundError:
            return None
    return float(done.stdout)


def importing():
    """Milliseconds that `import pyhysteron` takes, alone and with NumPy after it, median of several processes."""
    alone, whole = [], []
    for _ in range(9):
        code = (
            "import time; a = time.perf_counter(); import pyhysteron; b = time.perf_counter(); "
            "import numpy; c = time.perf_counter(); print(b - a, c - a)"
        )
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        for times, text in zip((alone, whole), done.stdout.split()):
            times.append(1e3 * float(text))
    return statistics.median(alone), statistics.median(whole)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--most", type=float, help="fail where Python takes more than this many times Rust's time")
    most = parser.parse_args().most
    levels = 20
    model = pyhysteron.Model(np.full(levels * (levels + 1) // 2, 0.01), (20, 80))
    print(f"{SAMPLES} samples, {levels} levels; best of {RUNS} runs.\n")
    print("| input | Rust, ns a sample | Python `simulate` | ratio | `State.step` in a loop |")
    print("| --- | ---: | ---: | ---: | ---: |")
    for name, input in inputs(model.plane):
        simulated = 1e9 * best(lambda: model.simulate(input), RUNS)[0] / SAMPLES
        reference = rust(model, input)
        some = input[:100_000].tolist()
        state = model.start()

        def loop():
            step = state.step
            for x in some:
                step(x)

        stepped = 1e9 * best(loop, RUNS)[0] / len(some)
        ratio = None if reference is None else simulated / reference
        shown = "" if reference is None else f"{reference:.2f}"
        print(f"| {name} | {shown} | {simulated:.2f} | {'' if ratio is None else f'{ratio:.2f}'} | {stepped:.0f} |")
        if most is not None and (ratio is None or ratio > most):
            sys.exit(f"{name}: the ratio is {ratio}, not {most} at most")
    alone, whole = importing()
    print(f"\n`import pyhysteron` takes {alone:.0f} ms; NumPy, which comes with the first array, makes it {whole:.0f} ms.")
    library = pathlib.Path(_hysteron.__file__).read_bytes()
    packed = len(zlib.compress(library, 9))
    print(f"The library is {len(library) / 2**20:.1f} MiB large, {packed / 2**20:.1f} MiB in a wheel.")


if __name__ == "__main__":
    main()

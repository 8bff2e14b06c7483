#!/usr/bin/env python3
"""Checks exported FMUs from outside.

FMPy validates and simulates them; a C program drives their binaries.

    fmu/check.py [HYSTERON]     the command, by default target/release/hysteron

Needs FMPy (pip install fmpy). Uses a C compiler, valgrind, mingw and wine if they are installed. It
prints what it skips, and fails then if HYSTERON_NO_SKIP is 1. It prints size and time per step as
a Markdown table.
"""

import copy
import csv
import json
import math
import os
import re
import shutil
import sys
import tempfile
import zipfile
from pathlib import Path
from urllib.request import pathname2url

from common import HYSTERON, ROOT, SKIPPED, Fmu, check, fmpy, has, np, run, step, vectors
from fmpy.validation import validate_fmu


def core(folder, model, run_, inverse):
    """The command's own numbers; None for a run with headings: the command looks ahead itself."""
    if inverse and any(run_["heading"]):
        return None
    table, out = folder / "in.csv", folder / "out.csv"
    column = "target" if inverse else "input"
    table.write_text("\n".join([column, *map(repr, run_[column])]) + "\n")
    if inverse:
        run(
            HYSTERON,
            "invert",
            model,
            table,
            "--target",
            column,
            "--tolerance",
            run_["tolerance"],
            "-o",
            out,
        )
    else:
        run(HYSTERON, "simulate", model, table, "--input", column, "-o", out)
    with out.open() as rows:
        return np.array(
            [
                float(row["input_model" if inverse else "output_model"])
                for row in csv.DictReader(rows)
            ]
        )


def staged_run(fmu, vector, run_):
    """A run of a model with stages, step by step; the number of its samples."""
    if "drive_range" in run_:
        return 0  # a block has the model's own limits
    wanted, signal = ("input", "target") if fmu.inverse else ("output", "input")
    steps = run_.get("dt", [0.0] + [1.0] * (len(run_[signal]) - 1))
    if 0.0 in steps[1:]:
        return 0  # FMI has no step without length
    references = {variable.name: variable.valueReference for variable in fmu.description.modelVariables}
    columns = {references[fmu.signal]: run_[signal]}
    if "load" in run_:
        columns[references[vector["model"]["load"]["name"]]] = run_["load"]
    if any(run_.get("heading", [])):
        return 0  # `held` sets real numbers only
    found = fmu.held(np.cumsum(steps), list(columns), list(zip(*columns.values())))
    error = np.max(np.abs(np.array(found) - run_[wanted]))
    check(error <= vector["tolerance"][wanted], f"{fmu.path.name}, {run_['name']}: off by {error}")
    return len(found)


def every_vector(folder, fmus):
    samples = exact = 0
    for name, vector in vectors().items():
        model = folder / f"{name}.json"
        model.write_text(json.dumps(vector["model"]))
        inverse = vector["kind"] == "inverse"
        wanted = "input" if inverse else "output"
        for fmi in (2, 3):
            fmu = fmus[name, fmi] = Fmu(folder, model, inverse, fmi)
            problems = validate_fmu(str(fmu.path))
            check(not problems, f"{fmu.path.name}: {problems}")
            for run_ in vector["runs"]:
                if vector["version"] == 2:
                    samples += staged_run(fmu, vector, run_)
                    continue
                found, flags = fmu.simulate(run_)
                error = np.max(np.abs(found - run_[wanted]))
                check(
                    error <= vector["tolerance"][wanted], f"{name}, {run_['name']}: off by {error}"
                )
                if inverse:
                    check(list(flags) == run_["status"], f"{name}, {run_['name']}: status")
                own = core(folder, model, run_, inverse)
                if own is not None:
                    check(
                        np.array_equal(found, own),
                        f"{name}, {run_['name']}: not the command's numbers",
                    )
                    exact += len(found)
                samples += len(found)
    print(f"   {samples} samples within the vectors' tolerances")
    print(f"   {exact} of them compared with the command's: equal bit for bit")


BUILD = """
import sys
from fmpy.build import build_platform_binary
strict = {"CMAKE_C_FLAGS:STRING": "-Werror"}
build_platform_binary(sys.argv[1], all_warnings=True, cmake_options=strict)
"""


def compiled(fmus):
    """The sources, compiled by FMPy, give what the binary gives."""
    if not (has("cc", "gcc") and has("cmake", "cmake")):
        return
    samples = 0
    for (name, fmi), fmu in fmus.items():
        if vectors()[name]["version"] == 2:
            check(not (fmu.folder / "sources").exists(), f"{name}: sources with a fixed sample time")
            continue
        own = copy.copy(fmu)
        own.folder = fmu.folder.with_suffix(".own")
        shutil.copytree(fmu.folder, own.folder)
        shutil.rmtree(own.folder / "binaries")
        # What CMake prints is not for here, so in a process of its own.
        run(sys.executable, "-c", BUILD, own.folder)
        for run_ in vectors()[name]["runs"]:
            found, wanted = own.simulate(run_), fmu.simulate(run_)
            for ours, theirs in zip(found, wanted):
                check(np.array_equal(ours, theirs), f"{name}, FMI {fmi}: other digits")
            samples += len(found[0])
    print(f"   {samples} samples, all equal to the binary's bit for bit")


def series(fmus, folder):
    """Both blocks in series return the reference."""
    for fmi in (2, 3):
        model = folder / "inverse-mkp-20.json"
        inverse, forward = fmus["inverse-mkp-20", fmi], Fmu(folder, model, False, fmi)
        a, b = inverse.instance(), forward.instance()
        reach = sum(vectors()["inverse-mkp-20"]["model"]["weights"])
        worst = 0
        for n in range(1000):
            target = reach * (0.5 - 0.5 * (1 - n / 1200) * np.cos(n * 0.05))
            worst = max(worst, abs(forward.next(b, n, inverse.next(a, n, target)) - target))
        for slave in (a, b):
            slave.terminate()
            slave.freeInstance()
        # The bound that the inverse itself is tested with.
        check(worst <= 1e-12 * reach, f"in series: off by {worst}")
        print(f"   FMI {fmi}: largest error {worst / reach:.1e} of the range")


def stages(folder):
    """Models with a body, a load, spacing, creep and lag: the command's numbers, bit for bit."""
    weights = [1.0, 0.5, 1.0, 0.0, 0.5, 1.0]
    constant = [{"offset": 3.5, "weights": weights}]
    by_load = [
        {"offset": offset, "weights": [factor * mu for mu in weights[::way]]}
        for offset, factor, way in [(3.5, 1.0, 1), (3.0, 1.25, -1), (4.25, 1.5, 1)]
    ]
    for name, parts in (("constant", constant), ("by_load", by_load)):
        (folder / name).mkdir()
        every_stage(folder / name, parts)


def every_stage(folder, parts):
    # The file's own weights and offset are those in the middle of the load: Bernstein polynomials.
    degree = len(parts) - 1
    middle = [math.comb(degree, k) / 2**degree for k in range(degree + 1)]
    weights = [
        sum(b * mu for b, mu in zip(middle, each))
        for each in zip(*(part["weights"] for part in parts))
    ]
    offset = sum(b * part["offset"] for b, part in zip(middle, parts))
    curves = {"loads": [0, 200], "shifts": [0, 8], "gains": [1, 1.2], "offsets": [0, 0.3]}
    model = folder / "every.json"
    model.write_text(
        json.dumps(
            {
                "format": "hysteron-model",
                "version": 2,
                "operator": "mkp",
                "plane": {"min": 1, "max": 3, "levels": 3},
                "input": {"name": "duty"},
                "output": {"name": "stroke", "offset": offset, "sign": -1},
                "weights": weights,
                "thermal": {
                    "kind": "first-order",
                    "ambient": 20,
                    "gain": 80,
                    "tau_heating": 0.4,
                    "tau_cooling": 0.9,
                },
                "drive": {"min": 0, "max": 1},
                "load": {
                    "name": "stress",
                    "unit": "MPa",
                    "min": 0,
                    "max": 200,
                    "parts": parts,
                    "curves": curves,
                },
                "spacing": [30, 50, 58, 80],
                "creep": [{"coefficient": 0.05, "tau": 2}],
                "lag": 0.05,
            }
        )
    )
    count, dt = 400, 0.03125  # times without rounding
    time = dt * np.arange(count)
    load = 100 + 80 * np.sin(0.3 * time)
    signals = {
        False: 0.5 - 0.6 * np.cos(1.7 * time),
        True: 1.6 - 2.2 * np.cos(1.1 * time),
    }
    for inverse, signal in signals.items():
        table, out = folder / "every.csv", folder / "out.csv"
        rows = zip(time.tolist(), signal.tolist(), load.tolist())
        table.write_text("t,x,stress\n" + "".join(f"{t!r},{x!r},{s!r}\n" for t, x, s in rows))
        names = ["--time", "t", "--load", "stress", "-o", out]
        names += ["--target", "x", "--preview", 0] if inverse else ["--input", "x"]
        run(HYSTERON, "invert" if inverse else "simulate", model, table, *names)
        with out.open() as rows:
            own = list(csv.DictReader(rows))
        column = "input_model" if inverse else "output_model"
        for fmi in (2, 3):
            fmu = Fmu(folder, model, inverse, fmi)
            problems = validate_fmu(str(fmu.path))
            check(not problems, f"{fmu.path.name}: {problems}")
            check("stress" in fmu.about["inputs"], "the load is an input")
            check("temperature" in fmu.about["outputs"], "the temperature is an output")
            found = fmu.held(time, [1, 7], list(zip(signal, load)))
            check(
                found == [float(row[column]) for row in own],
                f"{fmu.path.name}: not the command's numbers",
            )
    print(f"   {4 * count} samples: equal to the command's bit for bit")


def late(folder):
    """A model with a dead time: the command's numbers, bit for bit."""
    vector = vectors()["forward-mkp-20"]
    model = folder / "late.json"
    late_model = vector["model"] | {"version": 4, "delay": {"samples": 3, "interval_s": 1.0}}
    model.write_text(json.dumps(late_model))
    for fmi in (2, 3):
        fmu, run_ = Fmu(folder, model, False, fmi), vector["runs"][0]
        own = core(folder, model, run_, False)
        check(np.array_equal(fmu.simulate(run_)[0], own), f"FMI {fmi}: another dead time")
        check(not np.array_equal(own, run_["output"]), "a dead time that changes nothing")


def controller(folder):
    """The third block in a loop with the first: it follows, by hand and by itself, and gives up."""
    model = folder / "loop.json"
    model.write_text(json.dumps(vectors()["forward-mkp-20"]["model"]))
    reach = sum(vectors()["forward-mkp-20"]["model"]["weights"])
    options = ["--controller", "--dt", 0.1, "--drive-range", "0,80", "--gains", "0.1,1,0"]
    for fmi in (2, 3):
        fmu = Fmu(folder, model, options=options, fmi=fmi)
        problems = validate_fmu(str(fmu.path))
        check(not problems, f"{fmu.path.name}: {problems}")
        two = fmi == 2
        references = {v.name: v.valueReference for v in fmu.description.modelVariables}
        plant = Fmu(folder, model, False, fmi).instance()
        loop = fmu.instance()
        real = loop.setReal if two else loop.setFloat64
        flag = loop.getInteger if two else loop.getInt32
        now, drive, worst = 0.0, 0.0, 0.0

        def sample(reference, reading):
            nonlocal now, drive
            real([references[fmu.signal], references["measured"]], [reference, reading])
            loop.doStep(currentCommunicationPoint=now, communicationStepSize=0.1)
            now += 0.1
            drive = (loop.getReal if two else loop.getFloat64)([references[fmu.result]])[0]
            return flag([references["status"]])[0]

        for n in range(400):
            output = Fmu.next(fmu, plant, n, drive)
            wanted = reach * (0.5 - 0.3 * np.cos(n * 0.03))
            check(not sample(wanted, output) & (4 | 8 | 16), f"FMI {fmi}: a fault without one")
            if n > 50:
                worst = max(worst, abs(output - wanted))
        check(worst < 0.03 * reach, f"FMI {fmi}: the loop misses by {worst / reach}")
        for n in range(10):
            status = sample(wanted, math.nan)
        check(status & 16 and drive == 0.0, f"FMI {fmi}: not safe without readings, {status}")
        loop.setBoolean([references["manual"]], [True])
        real([references["manual_drive"]], [33.0])
        check(not sample(wanted, 0.0) & 16 and drive == 33.0, f"FMI {fmi}: not by hand")
        loop.setBoolean([references["manual"]], [False])
        check(not sample(wanted, 0.0) & 16, f"FMI {fmi}: given up for ever")
        for slave in (plant, loop):
            slave.terminate()
            slave.freeInstance()
        print(f"   FMI {fmi}: largest error in the loop {worst / reach:.1%} of the range")


def states(fmus):
    """Two instances; save, restore, bytes and reset in the middle of a run."""
    run_ = vectors()["forward-mkp-20"]["runs"][1]["input"]
    for fmi in (2, 3):
        fmu = fmus["forward-mkp-20", fmi]
        plain = fmu.instance("plain")
        wanted = [fmu.next(plain, n, value) for n, value in enumerate(run_)]
        one, other = fmu.instance("one"), fmu.instance("other")
        get, put, free = (
            (one.getFMUstate, one.setFMUstate, one.freeFMUstate)
            if fmi == 2
            else (one.getFMUState, one.setFMUState, one.freeFMUState)
        )
        pack, unpack = (
            (one.serializeFMUstate, one.deSerializeFMUstate)
            if fmi == 2
            else (one.serializeFMUState, one.deserializeFMUState)
        )
        for n, value in enumerate(run_):
            if n % 5 == 2:
                state = get()
                for astray in range(3):
                    fmu.next(one, n + astray, run_[astray])
                if n % 2:
                    data = pack(state)
                    free(state)
                    state = unpack(data)
                put(state)
                free(state)
            check(fmu.next(one, n, value) == wanted[n], f"FMI {fmi}: saving changed sample {n}")
            fmu.next(other, n, run_[-1 - n])
        one.reset()
        fmu.start(one)
        check(
            [fmu.next(one, n, value) for n, value in enumerate(run_)] == wanted,
            "a reset begins anew",
        )
        for slave in (plain, one, other):
            slave.terminate()
            slave.freeInstance()


def corrupted(folder, fmus):
    """A corrupted model gives an error and a message."""
    for fmi in (2, 3):
        source = fmus["forward-mkp-20", fmi].path
        for change, expected in {
            "cut": "model.txt, line",
            "flipped": "model.txt, line",
            "version": "`hysteron-fmu 9`",
            "missing": "model.txt",
            "guid": "GUID",
        }.items():
            broken = folder / f"{change}-{fmi}.fmu"
            with zipfile.ZipFile(source) as old, zipfile.ZipFile(broken, "w") as new:
                for item in old.namelist():
                    data = old.read(item)
                    if item == "resources/model.txt":
                        data = {
                            "cut": data[:-100],
                            "flipped": data[:500] + bytes([data[500] ^ 1]) + data[501:],
                            "version": data.replace(b"fmu 1", b"fmu 9"),
                        }.get(change, data)
                        if change == "missing":
                            continue
                    if item == "modelDescription.xml" and change == "guid":
                        data = data.replace(b"{", b"{0")
                    new.writestr(item, data)
            messages = []
            try:
                fmpy.simulate_fmu(str(broken), logger=lambda *args: messages.append(str(args)))
                check(False, f"{broken.name}: it ran")
            except Exception as error:
                check("nstantiate" in str(error), f"{broken.name}: {error}")
            check(any(expected in message for message in messages), f"{broken.name}: {messages}")


def driven(folder, fmus):
    """The binaries without Python: replayed, misused, under valgrind and wine."""
    headers = Path(fmpy.__file__).parent / "c-code"
    source = Path(__file__).parent / "driver.c"
    flags = [
        "-std=c99",
        "-O2",
        "-g",
        "-Wall",
        "-Wextra",
        "-D_POSIX_C_SOURCE=200809L",
        "-ffp-contract=off",
        f"-I{headers}",
    ]
    if not has("cc", "gcc"):
        return None
    driver = folder / "driver"
    run("cc", *flags, source, "-o", driver, "-ldl", "-lm")
    replays = [
        (fmus[name, 2], vector)
        for name, vector in vectors().items()
        if name in ("forward-mkp-20", "forward-relay-5", "inverse-mkp-5-negative")
    ]

    def replay(command, binary, location):
        for fmu, vector in replays:
            for run_ in vector["runs"][:2]:
                if run_.get("tolerance"):
                    continue  # the C program does not set `tolerance`
                signal = run_["target" if fmu.inverse else "input"]
                rows, out = folder / "rows.txt", folder / "out.txt"
                headings = run_["heading"] if fmu.inverse else [9] * len(signal)
                rows.write_text(
                    "".join(f"{value!r} {way}\n" for value, way in zip(signal, headings))
                )
                run(*command, "replay", binary(fmu), location(fmu), fmu.about["token"], rows, out)
                bits = np.array(
                    [int(line.split()[0], 16) for line in out.read_text().splitlines()],
                    dtype=np.uint64,
                )
                check(
                    np.array_equal(bits.view(float), fmu.simulate(run_)[0]),
                    f"{command}: other numbers",
                )

    def on_linux(fmu):
        return fmu.driven()[0]

    replay([driver], lambda fmu: fmu.binary, on_linux)
    for fmu in (fmus["forward-mkp-20", 2], fmus["inverse-mkp-20", 2]):
        run(driver, "misuse", fmu.binary, *fmu.driven())
    if has("valgrind", "valgrind"):
        valgrind = ["valgrind", "--quiet", "--error-exitcode=9", "--leak-check=full", driver]
        replay(valgrind, lambda fmu: fmu.binary, on_linux)
        fmu = fmus["forward-mkp-2", 2]
        run(*valgrind, "misuse", fmu.binary, *fmu.driven())
        print("   valgrind: no errors, no leaks")
    mingw = has("x86_64-w64-mingw32-gcc", "gcc-mingw-w64-x86-64")
    wine = shutil.which("wine64") or has("wine", "wine64")
    if mingw and wine:
        windows = folder / "driver.exe"
        run(mingw, *flags, source, "-o", windows)
        os.environ["WINEDEBUG"] = "-all"

        def on_windows(fmu):
            return "file:///Z:" + pathname2url(str(fmu.folder / "resources"))

        def library(fmu):
            return f"Z:{fmu.folder}/binaries/win64/{fmu.about['name']}.dll"

        replay([wine, windows], library, on_windows)
        fmu = fmus["forward-mkp-2", 2]
        run(wine, windows, "misuse", library(fmu), on_windows(fmu), fmu.about["token"])
        print("   wine: the Windows library gives the same numbers and refuses the same")
    cross = has("aarch64-linux-gnu-gcc", "gcc-aarch64-linux-gnu")
    emulator = has("qemu-aarch64-static", "qemu-user-static")
    if cross and emulator:
        arm = folder / "driver-arm"
        run(cross, *flags, source, "-o", arm, "-ldl", "-lm")
        on_arm = [emulator, "-L", "/usr/aarch64-linux-gnu", arm]

        def of_arm(fmu):
            return fmu.folder / f"binaries/aarch64-linux/{fmu.about['name']}.so"

        replay(on_arm, of_arm, on_linux)
        fmu = fmus["forward-mkp-2", 2]
        run(*on_arm, "misuse", of_arm(fmu), *fmu.driven())
        print("   qemu: the library for ARM gives the same numbers and refuses the same")
    return driver


def measured(folder, driver):
    lines = [
        "| K | FMU | set, step, get | plain loop in C | FMU / plain loop |",
        "| ---: | ---: | ---: | ---: | ---: |",
    ]
    for levels in (10, 20, 40, 100):
        weights = [1 + n % 7 for n in range(levels * (levels + 1) // 2)]
        model = folder / f"k{levels}.json"
        model.write_text(
            json.dumps(
                {
                    "format": "hysteron-model",
                    "version": 1,
                    "operator": "mkp",
                    "plane": {"min": 20, "max": 80, "levels": levels},
                    "weights": [w / len(weights) for w in weights],
                }
            )
        )
        fmu = Fmu(folder, model)
        plane = folder / "plane.txt"
        plane.write_text(
            " ".join(map(repr, [20.0, 80.0, levels, *(w / len(weights) for w in weights)]))
        )
        ratio, own, plain = map(
            float, run(driver, "time", fmu.binary, *fmu.driven(), plane).split()
        )
        size = fmu.about["bytes"] / 1024
        lines.append(f"| {levels} | {size:.0f} KiB | {own:.0f} ns | {plain:.0f} ns | {ratio:.2f} |")
    print("\n".join(lines))


def page(folder):
    """The example of docs/fmu.md."""
    example = re.search(r"```python\n(.*?)```", (ROOT / "docs/fmu.md").read_text(), re.S)[1]
    model = json.loads((folder / "forward-mkp-20.json").read_text())
    model["input"]["name"] = "temperature"
    (folder / "spring.json").write_text(json.dumps(model))
    run(HYSTERON, "export", "fmu", folder / "spring.json", "-o", folder / "sf_MKP.fmu")
    test = "\nassert len(result) == 101 and result['output'].max() > 0"
    run(sys.executable, "-c", example + test, cwd=folder)


def main():
    check(HYSTERON.exists(), f"{HYSTERON} is missing: cargo build --release, or name the command")
    with tempfile.TemporaryDirectory() as name:
        folder, fmus = Path(name), {}
        step("every vector through FMPy, FMI 2.0 and 3.0, all descriptions valid")
        every_vector(folder, fmus)
        step("the sources, compiled")
        compiled(fmus)
        step("both blocks in series")
        series(fmus, folder)
        step("a model with every stage")
        stages(folder)
        step("a dead time")
        late(folder)
        step("the controller in a loop")
        controller(folder)
        step("two instances, states, reset")
        states(fmus)
        step("a corrupted model")
        corrupted(folder, fmus)
        step("the example in docs/fmu.md")
        page(folder)
        step("the binaries from C")
        driver = driven(folder, fmus)
        if driver:
            step("size, and time per step (medians of 21 runs in one process)")
            measured(folder, driver)
    if SKIPPED and os.environ.get("HYSTERON_NO_SKIP") == "1":
        sys.exit(f"failed: missing {', '.join(SKIPPED)}")
    step("all is well")


main()

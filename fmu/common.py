"""What the checks share: running the command, and an FMU through FMPy."""

import json
import shutil
import subprocess
import sys
from pathlib import Path
from urllib.request import pathname2url

try:
    import fmpy
    import numpy as np
    from fmpy.fmi2 import FMU2Slave
    from fmpy.fmi3 import FMU3Slave
except ImportError:
    sys.exit("FMPy is needed: pip install fmpy")

ROOT = Path(__file__).resolve().parent.parent
HYSTERON = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "target/release/hysteron").resolve()
SKIPPED = []


def step(text):
    print(f"== {text}", flush=True)


def check(condition, text):
    if not condition:
        sys.exit(f"failed: {text}")


def run(*command, **options):
    done = subprocess.run(
        [str(word) for word in command], capture_output=True, text=True, **options
    )
    check(
        done.returncode == 0, f"{command}: exit code {done.returncode}\n{done.stdout}{done.stderr}"
    )
    return done.stdout


def has(tool, package):
    found = shutil.which(tool)
    if not found:
        run(
            ROOT / "tools/skipped",
            f"fmu/check.py: there is no `{tool}` (apt-get install {package})",
        )
        SKIPPED.append(tool)
    return found


class Fmu:
    """An exported FMU: its file, description and unpacked folder."""

    def __init__(self, folder, model, inverse=False, fmi=2, options=()):
        self.inverse, self.fmi = inverse, fmi
        kind = "controller" if options else "inverse" if inverse else "forward"
        self.path = folder / f"{model.stem}-{kind}-{fmi}.fmu"
        options = [*options, *["--inverse"] * inverse, "--fmi", fmi]
        self.about = json.loads(
            run(HYSTERON, "export", "fmu", model, "-o", self.path, "--json", *options)
        )
        self.description = fmpy.read_model_description(str(self.path))
        self.folder = Path(fmpy.extract(str(self.path), unzipdir=str(self.path.with_suffix(""))))
        self.signal, self.result = self.about["inputs"][0], self.about["outputs"][0]
        self.flag = self.about["outputs"][1]

    def simulate(self, run_):
        """Steps through a run of a vector with FMPy; outputs and flags for each sample."""
        signal = run_["target" if self.inverse else "input"]
        names, formats = ["time", self.signal], [float, float]
        columns = [np.arange(len(signal)), signal]
        start = {}
        if self.inverse:
            names, formats, columns = (
                [*names, "heading"],
                [*formats, int],
                [*columns, run_["heading"]],
            )
            start = {"tolerance": run_["tolerance"]}
        table = np.array(list(zip(*columns)), dtype=list(zip(names, formats)))
        result = fmpy.simulate_fmu(
            str(self.folder),
            model_description=self.description,
            input=table,
            start_values=start,
            stop_time=len(signal),
            step_size=1,
            output_interval=1,
            output=[self.result, self.flag],
        )
        # The start follows from the first input; row 1 is the first step, with that input again.
        rows = np.arange(len(signal) + 1) != 1
        return result[self.result][rows], result[self.flag][rows]

    def instance(self, name="spring", logger=None):
        """An instance past initialisation, through FMPy's raw interface."""
        kind = FMU2Slave if self.fmi == 2 else FMU3Slave
        slave = kind(
            guid=self.description.guid,
            unzipDirectory=str(self.folder),
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName=name,
        )
        slave.instantiate()
        self.start(slave)
        return slave

    def start(self, slave):
        if self.fmi == 2:
            slave.setupExperiment()
        slave.enterInitializationMode()
        slave.exitInitializationMode()

    def next(self, slave, n, value):
        """The output after a step."""
        two = self.fmi == 2
        (slave.setReal if two else slave.setFloat64)([1], [value])
        slave.doStep(currentCommunicationPoint=n, communicationStepSize=1)
        return (slave.getReal if two else slave.getFloat64)([2])[0]

    def held(self, time, references, values):
        """The output at each time, after a step over which the values of that row were held. The
        first row is the start."""
        two = self.fmi == 2
        kind = FMU2Slave if two else FMU3Slave
        slave = kind(
            guid=self.description.guid,
            unzipDirectory=str(self.folder),
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName="held",
        )
        slave.instantiate()
        put, get = (slave.setReal, slave.getReal) if two else (slave.setFloat64, slave.getFloat64)
        if two:
            slave.setupExperiment()
        slave.enterInitializationMode()
        found = []
        for n, row in enumerate(values):
            put(references, list(row))
            if n == 0:
                slave.exitInitializationMode()
            else:
                size = time[n] - time[n - 1]
                slave.doStep(currentCommunicationPoint=time[n - 1], communicationStepSize=size)
            found.append(get([2])[0])
        slave.terminate()
        slave.freeInstance()
        return found

    @property
    def binary(self):
        return self.folder / f"binaries/linux64/{self.about['name']}.so"

    def driven(self):
        """Arguments for the C program."""
        return "file://" + pathname2url(str(self.folder / "resources")), self.about["token"]


def vectors():
    return {
        path.stem: json.loads(path.read_text())
        for path in sorted((ROOT / "vectors").glob("*.json"))
    }

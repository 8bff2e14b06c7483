import os
import pathlib
import subprocess

import numpy as np
import pytest

import pyhysteron

os.environ["MPLBACKEND"] = "Agg"  # figures need no screen

SKIPPED = []


def pytest_runtest_logreport(report):
    """Tells `./check` of each test that is skipped."""
    if report.skipped and not hasattr(report, "wasxfail"):
        SKIPPED.append(f"{report.nodeid}: {report.longrepr[2]}")
        if "HYSTERON_SKIPPED" in os.environ:
            root = pathlib.Path(__file__).resolve().parents[2]
            subprocess.run([root / "tools" / "skipped", SKIPPED[-1]], check=True)


pytest_collectreport = pytest_runtest_logreport  # a whole file


def pytest_sessionfinish(session):
    """What is missing is skipped, or fails where nothing may be."""
    if SKIPPED and os.environ.get("HYSTERON_NO_SKIP") == "1":
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


@pytest.fixture(scope="session")
def truth():
    """A model with every kind of operator in it."""
    weights = np.full((12, 12), np.nan)
    for i in range(12):
        for j in range(i, 12):
            weights[i, j] = 0.1 * np.exp(-((j - i - 4) ** 2) / 8)
    return pyhysteron.Model(weights, (25, 80), offset=3, input="temperature [degC]", output="lift [mm]")


@pytest.fixture(scope="session")
def swings():
    """An input that visits the whole plane: swings that shrink."""
    t = np.linspace(0, 60, 3000)
    return 50 - 30 * np.cos(t) * np.exp(-t / 60)


@pytest.fixture(scope="session")
def recording(truth, swings):
    noise = 0.01 * np.random.default_rng(0).normal(size=len(swings))
    return pyhysteron.Recording(
        swings,
        truth.simulate(swings) + noise,
        time=0.1 * np.arange(len(swings)),
        input_name="temperature [degC]",
        output_name="lift [mm]",
    )


@pytest.fixture(scope="session")
def model(recording):
    """Fitted to the recording, with a prediction band."""
    return pyhysteron.fit(recording, levels=12, bootstrap=50)


@pytest.fixture
def drawn():
    """Draws what the test has made, and closes it."""
    plt = pytest.importorskip("matplotlib.pyplot")
    yield
    for number in plt.get_fignums():
        plt.figure(number).canvas.draw()
    plt.close("all")

"""The package itself: its version, its submodules, and names that are almost right."""

import importlib.metadata
import subprocess
import sys

import numpy as np
import pytest

import pyhysteron
from pyhysteron.control import Controller

MODEL = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
INPUT = np.linspace(0, 1, 5)


def python(code):
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    return done.stdout.strip() + done.stderr


def test_version():
    assert pyhysteron.__version__ == importlib.metadata.version("pyhysteron")


def test_submodules_are_imported_when_they_are_used():
    code = "import pyhysteron, sys; print({'matplotlib', 'sklearn', 'control', 'pandas'} & set(sys.modules))"
    assert python(code) == "set()"
    pytest.importorskip("matplotlib")
    assert python("import pyhysteron; print(pyhysteron.plot.loops.__name__)") == "loops"
    assert {"plot", "sklearn", "blocks", "control", "errors", "results"} <= set(dir(pyhysteron))


@pytest.mark.parametrize("name, package, extra", [("plot", "matplotlib", "plot"), ("sklearn", "sklearn", "sklearn"), ("blocks", "control", "control")])
def test_a_missing_extra_is_named(name, package, extra):
    printed = python(f"import sys; sys.modules[{package!r}] = None; import pyhysteron; pyhysteron.{name}")
    assert f"pip install 'pyhysteron[{extra}]'" in printed and "ImportError" in printed


def test_there_is_no_such_attribute():
    with pytest.raises(AttributeError, match="no attribute 'plotting'"):
        pyhysteron.plotting
    with pytest.raises(AttributeError, match="Did you mean 'Recording'"):
        pyhysteron.recording


@pytest.mark.parametrize(
    "call, error, meant",
    [
        (lambda: pyhysteron.fit(INPUT, INPUT, lvels=3), TypeError, "`levels`"),
        (lambda: pyhysteron.fit(INPUT, INPUT, boostrap=3), TypeError, "`bootstrap`"),
        (lambda: pyhysteron.fit(INPUT, INPUT, solver="nls"), ValueError, "'nnls'"),
        (lambda: pyhysteron.fit(INPUT, INPUT, start="unknow"), ValueError, "'unknown'"),
        (lambda: pyhysteron.left_out(INPUT, INPUT, smoth=3), TypeError, "`smooth`"),
        (lambda: pyhysteron.prepare(INPUT, INPUT, lowpass=3), TypeError, "`low_pass`"),
        (lambda: pyhysteron.adapt(MODEL, INPUT, INPUT, forgeting=3), TypeError, "`forgetting`"),
        (lambda: pyhysteron.Adaptive(MODEL, method="incremnets"), ValueError, "'increments'"),
        (lambda: pyhysteron.Adaptive(MODEL, gian=0.1), TypeError, "`gain`"),
        (lambda: pyhysteron.Model([1.0, 2.0, 4.0], (0, 1), ofset=1), TypeError, "`offset`"),
        (lambda: pyhysteron.Model([1.0, 2.0, 4.0], (0, 1), operator="mpk"), ValueError, "'mkp'"),
        (lambda: pyhysteron.SpringPlant(lod_n=3), TypeError, "`load_n`"),
        (lambda: pyhysteron.PreisachPlant().disturb(stuk=True), TypeError, "`stuck`"),
        (lambda: MODEL.inverse().run(INPUT, tolerence=1), TypeError, "`tolerance`"),
        (lambda: MODEL.inverse().run(INPUT, policy="anticipat"), ValueError, "'anticipate'"),
        (lambda: MODEL.inverse().step(MODEL.start(), 1.0, heading="raising"), ValueError, "'rising'"),
        (lambda: pyhysteron.read("a.csv", input="T", output="y", repiar=True), TypeError, "`repair`"),
        (lambda: pyhysteron.design((0, 1), 5, heating_rate=1, cooling_rate=1, budgt=1), TypeError, "`budget`"),
        (lambda: pyhysteron.Recording(INPUT, INPUT, inputname="T"), TypeError, "`input_name`"),
        (lambda: MODEL.evaluate(INPUT, INPUT, strat="on"), TypeError, "`start`"),
        (lambda: Controller(0.1, (0, 1), polcy="hold"), TypeError, "`policy`"),
    ],
)
def test_did_you_mean(call, error, meant):
    with pytest.raises(error) as raised:
        call()
    assert f"Did you mean {meant}?" in str(raised.value)


def test_nothing_similar_nothing_meant():
    with pytest.raises(ValueError) as raised:
        pyhysteron.Adaptive(MODEL, method="magic")
    assert "Did you mean" not in str(raised.value)


def test_in_the_python_half_too():
    pytest.importorskip("matplotlib")
    plot = pyhysteron.plot
    with pytest.raises(ValueError, match="Did you mean 'marks'"):
        plot.weights(MODEL, kind="mark")
    with pytest.raises(TypeError, match="Did you mean `kind`"):
        plot.weights(MODEL, knd="marks")

"""The type stubs say what the module has. They and the results are what `python/stubs` and `python/results` write."""

import pathlib
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.mark.parametrize("script", ["stubs", "results"])
def test_they_are_written_by_the_script(script):
    done = subprocess.run([sys.executable, ROOT / "python" / script, "--check"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_stubs():
    pytest.importorskip("mypy")
    allowed = ROOT / "python/tests/stubtest.txt"  # what scikit-learn adds to every estimator
    command = [sys.executable, "-m", "mypy.stubtest", "pyhysteron", "--mypy-config-file", ROOT / "pyproject.toml"]
    done = subprocess.run([*command, "--allowlist", allowed], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr

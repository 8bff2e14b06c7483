"""The code of the first page, of the README and of docs/python.md runs word for word in an empty folder."""

import pathlib
import re
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCS = ROOT / "python" / "docs"


def blocks(page, fence="python"):
    """Those that a reader sees."""
    found = re.findall(rf"^```{re.escape(fence)}\n(.*?)^```$", page.read_text("utf-8"), re.MULTILINE | re.DOTALL)
    return [block for block in found if not block.startswith(":tags: [remove-cell]")]


def run(code, folder, saved):
    done = subprocess.run([sys.executable, "-c", "\n".join(code)], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert [path.name for path in folder.iterdir()] == [saved]
    return done.stdout


@pytest.mark.parametrize("page", ["README.md", "docs/python.md"])
def test_page(page, tmp_path):
    code = blocks(ROOT / page)
    assert len(code) == 1
    assert float(run(code, tmp_path, "actuator.json")) < 2


def test_start(tmp_path):
    pytest.importorskip("matplotlib")
    code = blocks(DOCS / "start.md", "{code-cell} python")
    assert len(code) >= 5
    assert run(code, tmp_path, "spring.json").count("%") == 1

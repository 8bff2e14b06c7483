"""The code of the pages and the package's types go together: `mypy --strict` finds nothing."""

import os
import pathlib
import re
import subprocess
import sys

import pytest
from test_docs import DOCS, ROOT, blocks

#: The README, the first page and the notebooks.
PAGES = {
    "README.md": (ROOT / "README.md", "python"),
    **{str(page.relative_to(DOCS)): (page, "{code-cell} python") for page in [DOCS / "start.md", *sorted(DOCS.glob("gallery/[0-9]*.md"))]},
}
#: A notebook's functions have no annotations, and its other packages need no stubs.
NOTEBOOK = ["--allow-untyped-defs", "--allow-untyped-calls", "--disable-error-code=import-untyped"]
#: Of options in a dictionary no type checker knows which is which.
OF_A_DICTIONARY = re.compile(r'incompatible type "\*\*dict\[|Argument after \*\* must be a mapping')


@pytest.fixture(scope="session")
def cache(tmp_path_factory):
    return tmp_path_factory.mktemp("mypy")


@pytest.mark.parametrize("page", PAGES)
def test_mypy_finds_nothing(page, tmp_path, cache):
    pytest.importorskip("mypy")
    path, fence = PAGES[page]
    # Lines for IPython, and the semicolon that hides a value.
    code = "\n".join(blocks(path, fence))
    lines = [line for line in code.splitlines() if not line.startswith(("%", ":tags:"))]
    (tmp_path / "example.py").write_text("\n".join(lines) + "\n", "utf-8")
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", cache, "--config-file", ROOT / "pyproject.toml", "example.py"]
    source = pathlib.Path(__import__("pyhysteron").__file__).parents[1]
    # From its source folder a package is checked itself; installed, it is not.
    extra = [] if "site-packages" in source.parts else ["--follow-imports=silent"]
    environment = {**os.environ, **({"MYPYPATH": str(source)} if extra else {})}
    done = subprocess.run([*command, *extra, *([] if page == "README.md" else NOTEBOOK)], cwd=tmp_path, capture_output=True, text=True, env=environment)
    errors = [line for line in done.stdout.splitlines() if " error: " in line]
    if page != "README.md":
        errors = [line for line in errors if not OF_A_DICTIONARY.search(line)]
    assert not errors and not done.stderr, done.stdout + done.stderr

"""The documentation site: `sphinx-build -W --keep-going python/docs target/python-docs`.

The recordings are looked for in the folder that `HYSTERON_DATA` names, or in `../shared/data` seen from the repository's root; notebooks on
absent ones are left out.
"""

import os
import subprocess
from pathlib import Path

from docutils.nodes import SkipNode
from docutils.utils.math.latex2mathml import tex2mathml

HERE = Path(__file__).resolve().parent

project = "pyhysteron"
copyright = "the authors of hysteron"
extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
]
html_theme = "furo"
html_title = "pyhysteron"
html_theme_options = {"light_css_variables": {"code-font-size": "var(--font-size--small--2)"}}
html_static_path = ["static"]
html_css_files = ["site.css"]
html_math_renderer = "mathml"  # browsers draw it themselves: no script from elsewhere
exclude_patterns = ["_build", "**.ipynb_checkpoints", "jupyter_execute"]

napoleon_google_docstring = False
napoleon_use_rtype = False
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # the docstrings have them
default_role = "code"

myst_enable_extensions = ["amsmath", "dollarmath"]
myst_heading_anchors = 2

nb_execution_mode = "force"
nb_execution_in_temp = True  # what they save does not stay
nb_execution_raise_on_error = True
nb_execution_timeout = 300
nb_merge_streams = True

DATA = Path(os.environ.get("HYSTERON_DATA", HERE.parents[1] / "../shared/data")).resolve()
os.environ["HYSTERON_DATA"] = str(DATA)  # the notebooks' kernels have another folder
os.environ.pop("MPLBACKEND", None)  # any other than the notebooks' own would leave the figures out
if not DATA.is_dir():
    absent = [page for page in sorted(HERE.glob("gallery/*.md")) if "HYSTERON_DATA" in page.read_text("utf-8")]
    for page in absent:
        what = f"the notebook {page.name}: there are no recordings in {DATA}"
        subprocess.run([HERE.parents[1] / "tools/skipped", what], check=True)
        exclude_patterns.append(f"gallery/{page.name}")


def inline_math(self, node):
    self.body.append(tex2mathml(node.astext()))
    raise SkipNode


def block_math(self, node):
    self.body.append(f'<div class="math">{tex2mathml(node.astext().strip(), as_block=True)}</div>')
    raise SkipNode


def plain(app, what, name, thing, options, lines):
    """Napoleon takes what stands before a colon in an attribute's first line for its type."""
    if what in ("attribute", "property") and ":" in "".join(lines[:1]):
        lines.insert(0, "\\ ")


def setup(app):
    app.add_html_math_renderer("mathml", (inline_math, None), (block_math, None))
    app.connect("autodoc-process-docstring", plain, priority=400)

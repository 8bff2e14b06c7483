"""The documentation as one site, with a search: `site/build`.

Its pages are those that stand in the repository, where they stand: the README, docs, the folders of Octave and of the vectors, and the
Python package's. Their contents page is docs/README.md. What links to other files of the repository leads to its web page.

The recordings are looked for in the folder that `HYSTERON_DATA` names, or in `../shared/data` seen from the repository's root; notebooks on
absent ones are left out.
"""

import os
import re
import subprocess
import tomllib
from pathlib import Path

from docutils.nodes import SkipNode
from docutils.utils.math.latex2mathml import tex2mathml

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = tomllib.loads((ROOT / "Cargo.toml").read_text("utf-8"))["workspace"]["package"]
REPOSITORY = PACKAGE["repository"]

project = "hysteron"
version = release = PACKAGE["version"]
root_doc = "docs/README"
copyright = "the authors of hysteron"
extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
]
html_theme = "furo"
html_title = "hysteron"
html_theme_options = {"light_css_variables": {"code-font-size": "var(--font-size--small--2)"}}
html_static_path = ["static"]
html_css_files = ["site.css"]
html_math_renderer = "mathml"  # browsers draw it themselves: no script from elsewhere
include_patterns = [
    "README.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "docs/**.md",
    "octave/README.md",
    "vectors/README.md",
    "python/docs/**.md",
]
# Folders that need not be looked through.
exclude_patterns = ["target", ".*", "crates", "fuzz", "firmware", "**.ipynb_checkpoints", "**jupyter_execute"]

napoleon_google_docstring = False
napoleon_use_rtype = False
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # the docstrings have them
default_role = "code"

myst_enable_extensions = ["amsmath", "dollarmath"]
myst_heading_anchors = 4

nb_execution_mode = "force"
nb_execution_in_temp = True  # what they save does not stay
nb_execution_raise_on_error = True
nb_execution_timeout = 300
nb_merge_streams = True

DATA = Path(os.environ.get("HYSTERON_DATA", ROOT / "../shared/data")).resolve()
os.environ["HYSTERON_DATA"] = str(DATA)  # the notebooks' kernels have another folder
os.environ.pop("MPLBACKEND", None)  # any other than the notebooks' own would leave the figures out
if not DATA.is_dir():
    absent = [page for page in sorted(ROOT.glob("python/docs/gallery/*.md")) if "HYSTERON_DATA" in page.read_text("utf-8")]
    for page in absent:
        what = f"the notebook {page.name}: there are no recordings in {DATA}"
        subprocess.run([ROOT / "tools/skipped", what], check=True)
        exclude_patterns.append(f"python/docs/gallery/{page.name}")


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


LINK = re.compile(r"(\]\()([^)#:]+)(#[^)]*)?(\))")
TABLE_LINK = re.compile(r"^\| \[[^]]+\]\(([^)]+)\.md\)", re.MULTILINE)


def toctree(caption, pages):
    """A part of the menu."""
    return "\n".join(["", "```{toctree}", ":hidden:", f":caption: {caption}", "", *pages, "```", ""])


def menu(text):
    """The menu of a page of contents: each of its tables, below its heading."""
    parts = [part.split("\n", 1) for part in re.split(r"^## ", text, flags=re.MULTILINE)[1:]]
    found = [(heading, TABLE_LINK.findall(part)) for heading, part in parts]
    return [(heading, pages) for heading, pages in found if pages]


def one_site(app, page, source):
    """Adds the menu to the pages of contents, and leads links to files that are no pages to the repository."""
    folder = ROOT / Path(page).parent

    def lead(match):
        before, target, heading, after = match.groups()
        path = Path(os.path.normpath(folder / target))
        if not path.is_relative_to(ROOT) or not path.exists() or path.suffix in (".svg", ".png"):
            return match[0]
        inside = path.relative_to(ROOT)
        if inside.with_suffix("").as_posix() in app.env.found_docs:
            return match[0]
        kind = "tree" if path.is_dir() else "blob"
        return f"{before}{REPOSITORY}/{kind}/main/{inside.as_posix()}{heading or ''}{after}"

    text = source[0]
    if page == "docs/README":
        parts = [("The project", ["../README", "../CHANGELOG", "../CONTRIBUTING", "releasing"])]
        parts = [*menu(text), ("The Python package", ["../python/docs/index"]), *parts]
        text += "".join(toctree(*part) for part in parts)
    elif page == "docs/measured/README":
        text += toctree("What was measured", TABLE_LINK.findall(text))
    elif page == "docs/rust":
        text += '\n<p><a href="../rust/hysteron/index.html">Reference of the library</a></p>\n'
    source[0] = LINK.sub(lead, text)


def setup(app):
    app.connect("source-read", one_site)
    app.add_html_math_renderer("mathml", (inline_math, None), (block_math, None))
    app.connect("autodoc-process-docstring", plain, priority=400)

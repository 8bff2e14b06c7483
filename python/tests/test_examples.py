"""Everything public has a docstring with what NumPy's style asks for, and an example that runs."""

import ast
import doctest
import importlib
import inspect
import pathlib
import re

import numpy as np
import pytest

import pyhysteron

MODULES = [pyhysteron, pyhysteron.control]
for name, needed in {"blocks": "control", "plot": "matplotlib", "sklearn": "sklearn"}.items():
    if importlib.util.find_spec(needed):
        MODULES.append(importlib.import_module(f"pyhysteron.{name}"))

#: What nobody makes, and whose example shows it: the call that gives it.
SHOWN_BY = {
    "pyhysteron.Adapted": "pyhysteron.adapt",
    "pyhysteron.Comparison": "pyhysteron.track",
    "pyhysteron.Comparison.to_csv": "pyhysteron.track",
    "pyhysteron.Design": "pyhysteron.design",
    "pyhysteron.Learning": "pyhysteron.Adaptive.step",
    "pyhysteron.SimulatedPlant": "pyhysteron.SpringPlant",
    "pyhysteron.control.Action": "pyhysteron.control.Controller.step",
    "pyhysteron.control.Trace": "pyhysteron.control.Controller.run",
}


def documented():
    """Modules, functions, classes, methods and properties by their full names."""
    for module in MODULES:
        yield module.__name__, module
        for name in module.__all__:
            thing = getattr(module, name)
            if inspect.ismodule(thing) or isinstance(thing, dict):
                continue
            yield f"{module.__name__}.{name}", thing
            if inspect.isclass(thing):
                for member in vars(thing):
                    # scikit-learn adds `set_score_request` to what inherits from it.
                    if not member.startswith("_") and not member.endswith("_request"):
                        yield f"{module.__name__}.{name}.{member}", getattr(thing, member)


DOCUMENTED = dict(documented())
CALLED = [name for name, thing in DOCUMENTED.items() if callable(thing)]


def text_of(name):
    return inspect.getdoc(DOCUMENTED[name]) or ""


def sections(name):
    """The lines of each section below the summary."""
    parts = re.split(r"^(\w+)\n-+\n", text_of(name), flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2]))


def explained(name):
    """The arguments that the docstring explains: `a, b : float` begins a line, what it says of them does not."""
    found = re.findall(r"^(\S.*?)(?: :.*)?$", sections(name).get("Parameters", ""), re.MULTILINE)
    return {argument.strip("* ") for line in found for argument in line.split(",")}


def give_nothing():
    """Methods of which the stubs say that they return None."""
    stubs = pathlib.Path(pyhysteron.__file__).with_name("_hysteron.pyi").read_text("utf-8")
    for part in ast.parse(stubs).body:
        for method in part.body if isinstance(part, ast.ClassDef) else []:
            if isinstance(method, ast.FunctionDef) and ast.unparse(method.returns) == "None":
                yield [part.name, method.name]


NOTHING = list(give_nothing())


@pytest.mark.parametrize("name", DOCUMENTED)
def test_docstring(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert text_of(name)
    names = {"pyhysteron": pyhysteron, "np": np}
    example = doctest.DocTestParser().get_doctest(text_of(name), names, name, None, 0)
    assert doctest.DocTestRunner().run(example).failed == 0


@pytest.mark.parametrize("name", CALLED)
def test_there_is_an_example(name):
    assert (">>>" in text_of(name)) != (name in SHOWN_BY), "an example of its own is needed, or the call whose example shows it"
    assert ">>>" in text_of(SHOWN_BY.get(name, name))


@pytest.mark.parametrize("name", [name for name in CALLED if name not in SHOWN_BY])
def test_arguments_and_what_is_returned_are_explained(name):
    thing = DOCUMENTED[name]
    assert explained(name) == set(inspect.signature(thing).parameters) - {"self"}
    if not inspect.isclass(thing):
        returns = sections(name).keys() & {"Returns", "Yields"}
        assert bool(returns) != (name.split(".")[-2:] in NOTHING)

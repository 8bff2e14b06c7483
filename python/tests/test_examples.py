"""The examples in the docstrings run, and every public thing has a docstring."""

import doctest
import importlib
import inspect

import numpy as np
import pytest

import hysteron

MODULES = [hysteron, hysteron.control]
for name, needed in {"blocks": "control", "plot": "matplotlib", "sklearn": "sklearn"}.items():
    if importlib.util.find_spec(needed) and importlib.util.find_spec(f"hysteron.{name}"):
        MODULES.append(importlib.import_module(f"hysteron.{name}"))


def documented():
    for module in MODULES:
        for name in module.__all__:
            thing = getattr(module, name)
            if isinstance(thing, dict):
                continue
            yield f"{module.__name__}.{name}", thing
            if inspect.isclass(thing):
                for member, value in vars(thing).items():
                    if not member.startswith("_"):
                        yield f"{module.__name__}.{name}.{member}", value


@pytest.mark.parametrize("name, thing", list(documented()), ids=lambda value: value if isinstance(value, str) else "")
def test_docstring(name, thing):
    text = inspect.getdoc(thing)
    if text is None:
        assert not callable(thing), f"{name} has no docstring"
        return
    names = {"hysteron": hysteron, "np": np}
    example = doctest.DocTestParser().get_doctest(text, names, name, None, 0)
    assert doctest.DocTestRunner().run(example).failed == 0


@pytest.mark.parametrize("name", ["fit", "left_out", "prepare"])
def test_a_signature_written_by_hand_has_the_real_names(name):
    function = getattr(hysteron, name)
    shown = inspect.signature(function)
    with pytest.raises(TypeError) as error:
        function([1.0, 2.0], [1.0, 2.0], not_an_option=1)
    assert "not_an_option" in str(error.value)
    values = {"levels": 2, "smooth": 0.0, "operator": "mkp", "solver": "nnls", "start": "off", "load_degree": 1}
    named = {
        name: values.get(name, parameter.default)
        for name, parameter in shown.parameters.items()
        if parameter.kind is inspect.Parameter.KEYWORD_ONLY
    }
    input = 50 - 30 * np.cos(np.linspace(0, 20, 200))
    function(input, 0.5 * input, **named)

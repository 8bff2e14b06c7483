"""Results are frozen dataclasses with documented fields, and plain data when that is asked for."""

import dataclasses
import json
import pickle
import re
import typing

import numpy as np
import pytest

import pyhysteron
from pyhysteron import results

CLASSES = [getattr(results, name) for name in results.__all__]


@pytest.fixture(scope="module")
def found(model, recording):
    """One of each result that a function returns."""
    adapted = pyhysteron.adapt(model, recording)
    return [
        model.fit,
        model.confidence,
        model.summary(),
        model.evaluate(recording),
        recording.summary(),
        pyhysteron.prepare(recording)[1],
        pyhysteron.left_out(recording, levels=5),
        adapted.comparison,
    ]


@pytest.mark.parametrize("cls", CLASSES, ids=lambda cls: cls.__name__)
def test_each_field_is_documented(cls):
    assert dataclasses.is_dataclass(cls) or typing.is_typeddict(cls)
    summary, _, section = cls.__doc__.partition("Attributes\n    ----------\n")
    assert summary.strip()
    described = re.findall(r"^    (\w+) : .+\n        \S", section, re.MULTILINE)
    assert described == list(typing.get_type_hints(cls))


def test_all_are_exported():
    own = [name for name, thing in vars(results).items() if isinstance(thing, type) and thing.__module__ == results.__name__]
    assert sorted(name for name in own if not name.startswith("_")) == sorted(results.__all__)


def test_they_are_frozen_equal_to_copies_and_short(found):
    for result in found:
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(result, dataclasses.fields(result)[0].name, 1)
        again = pickle.loads(pickle.dumps(result))
        assert again == result and again is not result
        assert result != 1 and repr(result).startswith(type(result).__name__)
        assert len(repr(result)) < 3000


def test_other_values_differ(model, recording):
    one, other = model.evaluate(recording), model.evaluate(recording, start="on")
    assert one != other and one.forward == model.evaluate(recording).forward


def test_plain_data(found):
    for result in found:
        plain = result.to_dict()
        assert list(plain) == [field.name for field in dataclasses.fields(result)]
        np.testing.assert_equal(plain, dataclasses.asdict(result))
    summary = found[2].to_dict()
    assert json.loads(json.dumps(summary))["confidence"]["rank"] == found[2].confidence.rank


def test_the_types_are_those_of_the_hints(found):
    def check(result):
        for name, hint in typing.get_type_hints(type(result)).items():
            value = getattr(result, name)
            kinds = [typing.get_origin(part) or part for part in typing.get_args(hint) or [hint]]
            if dataclasses.is_dataclass(value):
                assert type(value) in kinds
                check(value)
            elif hint in (int, float, str, bool):
                assert type(value) is hint
            elif typing.get_origin(hint) is tuple:
                assert isinstance(value, tuple)

    for result in found:
        check(result)


def test_what_a_model_file_says_beside_is_kept():
    model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    input = np.linspace(0, 1, 50)
    adapted = pyhysteron.adapt(model, input, model.simulate(input)).model
    assert adapted.fit.other["adapted"]["method"] == "auto"
    assert pyhysteron.Model.from_json(adapted.to_json()).fit == adapted.fit


def test_the_summary_of_a_late_model_says_how_late():
    time = 0.1 * np.arange(400)
    swing = 1 - np.cos(time)
    recording = pyhysteron.Recording(swing, np.roll(swing, 3), time=time)
    late = pyhysteron.fit(recording, levels=5, delay=3, bootstrap=0)
    assert late.summary().delay_s == pytest.approx(0.3)
    assert pyhysteron.fit(recording, levels=5, delay=0, bootstrap=0).summary().delay_s is None

"""Models beside each other, and what they have seen."""

import numpy as np
import pytest

import pyhysteron


@pytest.fixture(scope="module")
def models(recording):
    return {k: pyhysteron.fit(recording, levels=k, bootstrap=0) for k in (4, 12)}


def test_each_model_runs_as_it_does_alone(models, recording):
    found = pyhysteron.compare(models, recording)
    assert [run.name for run in found] == ["4", "12"]
    for run, model in zip(found, models.values()):
        alone = model.evaluate(recording)
        assert run.errors == alone.forward
        np.testing.assert_array_equal(run.output_model, alone.output_model)
        np.testing.assert_array_equal(run.residual, recording.output - run.output_model)
    assert found[1].errors.rmse < found[0].errors.rmse


def test_one_model_a_list_and_arrays(models, recording):
    some = list(models.values())
    named = pyhysteron.compare(some, recording)
    assert [run.name for run in named] == ["model 1", "model 2"]
    arrays = pyhysteron.compare(tuple(some), recording.input, recording.output, time=recording.time)
    assert [run.errors for run in arrays] == [run.errors for run in named]
    (one,) = pyhysteron.compare(some[0], recording, start="on")
    assert one.errors == some[0].evaluate(recording, start="on").forward
    assert pyhysteron.compare([], recording) == []


@pytest.mark.parametrize("models", [3, "model.json", [3], {"a": 3}, None])
def test_what_is_no_model_is_refused(models, recording):
    with pytest.raises(TypeError, match="`models` is .*a Model"):
        pyhysteron.compare(models, recording)


def test_what_a_model_has_seen_is_known(tmp_path, recording):
    files = {}
    for n, name in enumerate(["first", "second", "repeat", "new"]):
        files[name] = tmp_path / f"{name}.csv"
        rows = np.column_stack([recording.input, recording.output + 0.01 * n])
        np.savetxt(files[name], rows, delimiter=",", header="x,y", comments="")
    read = {name: pyhysteron.read(file, input="x", output="y") for name, file in files.items()}
    options = dict(levels=6, bootstrap=10, repeats=read["repeat"])
    model = pyhysteron.fit([read["first"], read["second"]], **options)
    assert [seen.file for seen in model.fit.repeats] == [str(files["repeat"])]
    assert len(model.fit.other_sha256) == 1
    for name, recorded in read.items():
        (run,) = pyhysteron.compare(model, recorded)
        judged = model.evaluate(recorded)
        assert run.was_fitted == judged.was_fitted == (name in ("first", "second"))
        assert run.seen_for_band == judged.seen_for_band == (name == "repeat")

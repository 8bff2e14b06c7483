import threading

import numpy as np
import pytest

import pyhysteron

STAGED = pyhysteron.Model.from_json(
    """{"format": "hysteron-model", "version": 2, "operator": "mkp", "lag": 0.5,
    "plane": {"min": 0, "max": 1, "levels": 2}, "weights": [1, 2, 1],
    "load": {"min": 1, "max": 2, "parts": [{"offset": 0, "weights": [1, 2, 1]}],
        "curves": {"loads": [1, 2], "shifts": [0, 0.5]}}}"""
)


def model(rng):
    levels = rng.integers(2, 20)
    low = rng.uniform(-10, 10)
    operator = rng.choice(["mkp", "kp", "relay"])
    weights = rng.uniform(size=levels * (levels + 1) // 2)
    return pyhysteron.Model(weights, (low, low + rng.uniform(1, 30)), operator=operator, sign=int(rng.choice([-1, 1])))


@pytest.mark.parametrize("seed", range(30))
def test_every_lane_is_its_model_alone(seed):
    rng = np.random.default_rng(seed)
    models = [model(rng) for _ in range(seed % 12)]
    batch, alone = pyhysteron.BatchModel(models), [model.start() for model in models]
    assert len(batch) == len(models) and batch.models == models
    for samples in (rng.integers(0, 300), 1):
        inputs = np.cumsum(rng.uniform(-5, 5, (len(models), samples)), axis=1)
        expected = np.array([state.run(row) for state, row in zip(alone, inputs)]).reshape(inputs.shape)
        # Rows need not be next to each other in memory.
        outputs = batch.run(np.asfortranarray(inputs) if seed % 2 else inputs)
        assert outputs.dtype == np.float64 and outputs.flags.c_contiguous
        np.testing.assert_array_equal(outputs, expected)
    for found, expected in zip(batch.states, alone):
        np.testing.assert_array_equal(found.turning_points, expected.turning_points)
        assert found.input == expected.input
    if models:
        batch.reset()
        np.testing.assert_array_equal(batch.step(inputs[:, 0]), [m.start().step(row[0]) for m, row in zip(models, inputs)])


def test_states_are_copies():
    batch = pyhysteron.BatchModel(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)), 2)
    state = batch.states[0]
    assert state.step(1.0) == 7.0
    np.testing.assert_array_equal(batch.step([0.5, 0.5]), [4.0, 4.0])


def test_stages_and_plain_models_in_one_batch():
    rng = np.random.default_rng(1)
    models = [STAGED, pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)), STAGED]
    batch = pyhysteron.BatchModel(models)
    inputs, load = rng.uniform(0, 2, (3, 50)), rng.uniform(1, 2, (3, 50))
    time = np.cumsum(rng.uniform(0, 1, 50))
    of = [load[0], None, load[2]]
    expected = [m.simulate(u, time=time, load=s) for m, u, s in zip(models, inputs, of)]
    np.testing.assert_array_equal(batch.run(inputs, time=time, load=load), expected)
    batch.reset()
    for n in range(50):
        dt = time[n] - time[max(n - 1, 0)]
        found = batch.step(inputs[:, n], dt=dt, load=load[:, n])
        np.testing.assert_array_equal(found, np.array(expected)[:, n])
    batch.reset()
    one = batch.run(inputs, time=time, load=1.5)
    np.testing.assert_array_equal(one[0], STAGED.simulate(inputs[0], time=time, load=1.5))


def test_an_error_names_its_lane_and_nothing_moves():
    model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    batch = pyhysteron.BatchModel([model, model, STAGED])
    inputs, time = np.full((3, 4), 0.5), np.arange(4.0)
    inputs[1, 2] = np.nan
    with pytest.raises(pyhysteron.CoreError, match=r"lane number 1 .*sample number 2 ") as error:
        batch.run(inputs, time=time, load=1.5)
    assert error.value.code == 7
    with pytest.raises(pyhysteron.FitError, match="lane number 2 "):
        batch.run(np.full((3, 4), 0.5), time=time)
    with pytest.raises(pyhysteron.ThermalError, match="lane number 2 "):
        batch.run(np.full((3, 4), 0.5), load=1.5)
    with pytest.raises(pyhysteron.FitError, match="2 inputs for 3 lanes"):
        batch.step([0.5, 0.5])
    assert all(state.turning_points[-1] == 0.0 for state in batch.states)


def test_what_does_not_fit_is_refused():
    model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    for arguments in [(model,), ([model], 2), ([model, 3],), (7,)]:
        with pytest.raises(TypeError):
            pyhysteron.BatchModel(*arguments)
    for count in (-1, 10**30):
        with pytest.raises(ValueError, match="`count`"):
            pyhysteron.BatchModel(model, count)
    with pytest.raises(pyhysteron.FitError, match="lanes"):
        pyhysteron.BatchModel(model, 2**40)
    batch = pyhysteron.BatchModel(model, 2)
    for inputs in ([0.5, 0.5], [[0.5], [0.5], [0.5]], [[[0.5]], [[0.5]]]):
        with pytest.raises(ValueError, match="`inputs`"):
            batch.run(inputs)
    with pytest.raises(TypeError):
        batch.run([["a"], ["b"]])
    with pytest.raises(pyhysteron.FitError):
        batch.run([[0.5], [0.5]], load=1.0)


def test_other_threads_run_meanwhile():
    """While a batch runs, Python goes on: the lock is released."""
    rng = np.random.default_rng(2)
    batch = pyhysteron.BatchModel(model(rng), 64)
    inputs = rng.uniform(-10, 30, (64, 100_000))
    begun, ticks = threading.Event(), []

    def run():
        begun.set()
        batch.run(inputs)

    thread = threading.Thread(target=run)
    thread.start()
    begun.wait()
    while thread.is_alive():
        ticks.append(None)
    thread.join()
    # With the lock held, only the few turns before and after the run would be left.
    assert len(ticks) > 1000

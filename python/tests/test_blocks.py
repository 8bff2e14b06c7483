"""Blocks of python-control against the same loops written out."""

import numpy as np
import pytest

import pyhysteron

control = pytest.importorskip("control")
from pyhysteron import blocks  # noqa: E402

DT = 0.1
TIME = DT * np.arange(200)


@pytest.fixture(params=[1, -1])
def model(request):
    weights = np.random.default_rng(5).uniform(0.1, 1.0, 36)
    return pyhysteron.Model(weights, (20, 80), offset=2.0, sign=request.param)


def reference(model):
    low, high = sorted(model.output_range)
    return low + (high - low) * (0.5 - 0.4 * np.cos(1.7 * TIME) * np.exp(-0.05 * TIME))


def test_model_is_simulate(model):
    temperature = 50 + 45 * np.sin(1.3 * TIME) * np.cos(0.31 * TIME)
    found = control.input_output_response(blocks.model_block(model, DT), TIME, temperature)
    assert np.array_equal(found.outputs, model.simulate(temperature))


@pytest.mark.parametrize("policy", ["hold", "anticipate"])
def test_inverse_and_model_return_the_reference(model, policy):
    wanted = reference(model)
    headings = pyhysteron.control.headings(wanted)
    signals = [wanted]
    if policy == "anticipate":
        signals.append([{None: 0, "rising": 1, "falling": -1}[h] for h in headings])
    inverse = blocks.inverse_block(model, DT, policy)
    series = control.interconnect(
        [inverse, blocks.model_block(model, DT)], inputs=inverse.input_labels, outputs=["output"]
    )
    found = control.input_output_response(series, TIME, np.array(signals))
    assert np.abs(found.outputs - wanted).max() < 1e-12 * np.abs(wanted).max()
    inputs = control.input_output_response(inverse, TIME, np.array(signals)).y[0]
    expected, _ = model.inverse().run(wanted, heading=headings if policy == "anticipate" else None)
    assert np.array_equal(inputs, expected)


@pytest.mark.parametrize("dt", [0, None, -0.1, np.nan, np.inf, False, "0.1"])
def test_a_time_between_samples_that_cannot_be(model, dt):
    for make in (blocks.model_block, blocks.inverse_block, lambda model, dt: blocks.adaptive_block(pyhysteron.Adaptive(model), dt)):
        with pytest.raises(ValueError, match=f"`dt` is {dt!r}"):
            make(model, dt)
    assert blocks.model_block(model, True).dt is True


@pytest.mark.parametrize("make", [blocks.model_block, blocks.inverse_block, blocks.adaptive_block, lambda m, dt: blocks.memory(m)])
def test_what_is_no_model_is_refused(make):
    with pytest.raises(TypeError, match=r"`(model|adaptive)` is 3: a pyhysteron\.(Model|Adaptive) is needed"):
        make(3, DT)


def test_the_functions_are_pure(model):
    block = blocks.model_block(model, DT)
    x = blocks.memory(model)
    for u in [70.0, 40.0, 60.0]:
        # Asked in between for other inputs, as an interconnection does.
        block.output(0, x, [25.0])
        block.dynamics(0, x, [79.0])
        x = block.dynamics(0, x, [u])
    assert block.output(0, x, [45.0])[0] == model.simulate([70.0, 40.0, 60.0, 45.0])[-1]


def test_memory_begins_where_a_state_is(model):
    state = model.start()
    state.run([75.0, 30.0, 55.0])
    found = control.input_output_response(blocks.model_block(model, DT), TIME[:2], [40.0, 60.0], blocks.memory(model, state))
    assert np.array_equal(found.outputs, state.run([40.0, 60.0]))


def test_the_memory_has_room_for_every_turning_point():
    model = pyhysteron.Model(np.full(6, 1.0), (20, 80))
    state, x, block = model.start(), blocks.memory(model), blocks.model_block(model, DT)
    # Loops that shrink within the cells: as many corners as can be.
    for n in range(400):
        u = 50 + (-1) ** n * 45 * 0.98**n
        state.step(u)
        x = block.dynamics(0, x, [u])
    assert np.array_equal(x, blocks.memory(model, state)) and x[0] < len(x) - 2


def test_a_closed_loop_with_a_pid(model):
    """A PI controller and a delay from python-control, and the same loop by hand."""
    gain, wanted = model.sign * 4.0, reference(model)
    pid = control.ss(control.tf([gain, -0.7 * gain], [1, -1], DT, inputs="error", outputs="command"))
    delay = control.ss(control.tf([1], [1, 0], DT, inputs="command", outputs="input"))
    error = control.summing_junction(["target", "-output"], "error")
    plant = blocks.model_block(model, DT)
    loop = control.interconnect([error, pid, delay, plant], inputs=["target"], outputs=["output", "input"])
    found = control.input_output_response(loop, TIME, wanted)

    state, delayed, command, last = model.start(), 0.0, 0.0, 0.0
    outputs, inputs = [], []
    for target in wanted:
        inputs.append(delayed)
        outputs.append(state.step(delayed))
        error = target - outputs[-1]
        command += gain * error - 0.7 * gain * last
        last, delayed = error, command
    # The state space of the PI rounds in another order; the model is continuous, so this stays small.
    assert np.abs(found.outputs[1] - inputs).max() < 1e-9 * np.abs(inputs).max()
    assert np.abs(found.outputs[0] - outputs).max() < 1e-9 * np.abs(outputs).max()
    assert np.ptp(outputs) > 0.5 * np.ptp(wanted), "the loop stands still"


def test_an_adaptive_loop(model):
    truth = pyhysteron.Model(1.4 * model.weights, model.range, offset=2.0, sign=model.sign)
    offline = pyhysteron.Adaptive(model, method="increments", gain=0.5)
    wanted = reference(model)
    block = blocks.adaptive_block(offline, DT)
    plant = blocks.model_block(truth, DT, inputs=["command"], outputs=["output"])
    same = control.ss([], [], [], [[1.0]], dt=DT, inputs=["command"], outputs=["input"])
    loop = control.interconnect([block, plant, same], inputs=["target"], outputs=["output"])
    found = control.input_output_response(loop, TIME, wanted).outputs

    adaptive, state, outputs = offline.copy(), truth.start(), []
    for target in wanted:
        command, _ = adaptive.solve(target)
        outputs.append(state.step(command))
        adaptive.step(command, outputs[-1])
    assert np.array_equal(found, outputs)
    errors = np.abs(found - wanted)
    assert errors[150:].max() < 0.5 * errors[:30].max()
    assert offline.output == model.start().step(model.range[0] - 100.0), "the one that was given has moved"
    again = control.input_output_response(loop, TIME, wanted).outputs
    assert np.array_equal(found, again)


def test_what_is_refused(model):
    with pytest.raises(ValueError, match="`policy` is 'guess': one of 'hold', 'anticipate'"):
        blocks.inverse_block(model, DT, "guess")
    negative = pyhysteron.Model([1.0, -1.0, 1.0], (0, 1))
    with pytest.raises(pyhysteron.CoreError):
        blocks.inverse_block(negative, DT)
    with pytest.raises(ValueError, match="not remembered"):
        blocks.adaptive_block(pyhysteron.Adaptive(model), DT).output(0, [999], [3.0, 3.0, 30.0])
    with pytest.raises(pyhysteron.CoreError, match="`input` is NaN"):
        blocks.model_block(model, DT).output(0, blocks.memory(model), [np.nan])


@pytest.mark.parametrize("count", [3.7, 1e9, -3, np.nan])
def test_a_memory_that_cannot_be_is_refused(count):
    model = pyhysteron.Model(np.ones(36), (20, 80))
    block = blocks.model_block(model, 0.1)
    vector = blocks.memory(model)
    vector[0] = count
    with pytest.raises(ValueError, match=r"memory\[0\]"):
        control.input_output_response(block, np.array([0, 0.1]), [30.0, 40.0], vector)
    with pytest.raises(pyhysteron.CoreError, match="another model"):
        blocks.memory(model, pyhysteron.Model(np.ones(210), (0, 1)).start(on=True))

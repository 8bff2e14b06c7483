"""Discrete blocks for python-control (``pip install pyhysteron[control]``).

A model, its inverse and an adaptive compensator as `control.NonlinearIOSystem`, to be connected and
simulated there.

python-control calls the functions of a block several times for a sample, with inputs that are not
final yet. So the state vector of model and inverse holds the whole memory: ``[count, input, turning
points…]``, and at its end the ``stages`` of `State.save` for a model that has stages. It is all zero
where the model starts. The output of a model follows its input without delay. A closed loop needs a
delay elsewhere, as any loop of python-control.

A model that depends on time steps with the block's sample time, and one that depends
on a load has an input for it.
"""

from __future__ import annotations

import numbers
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

try:
    import control
except ImportError as _missing:
    raise ImportError("pyhysteron.blocks needs python-control: pip install 'pyhysteron[control]'") from _missing

from ._convert import one_of
from ._hysteron import Adaptive, Model, State
from .errors import CoreError
from .results import SavedState

__all__ = ["adaptive_block", "inverse_block", "memory", "model_block"]

_HEADINGS = {1.0: "rising", -1.0: "falling"}
#: Numbers of `State.save` for the stages of a model.
_STAGES = 10
#: Estimators that an adaptive block remembers, beside the one that it began with.
_REMEMBERED = 64


def memory(model: Model, state: State | None = None) -> NDArray[np.float64]:
    """The state vector of a block for `model`: an initial value for a simulation.

    Parameters
    ----------
    model : Model
    state : State, optional
        By default where the model starts.

    Returns
    -------
    ndarray, shape (4 K + 8,), or (4 K + 15,) for a model with stages

    Raises
    ------
    CoreError
        For a state of another model.

    Examples
    --------
    >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    >>> pyhysteron.blocks.memory(model, model.start(on=True))[:4]
    array([1., 1., 2., 0.])
    """
    _needed("model", model, Model)
    if state is not None:
        _needed("state", state, State)
        if state.model != model:
            raise CoreError("`state` belongs to another model")
    saved = (model.start() if state is None else state).save()
    vector = np.zeros(4 * model.levels + 8 + (_STAGES if "stages" in saved else 0))
    if state is not None:
        points = saved["turning_points"]
        vector[0] = len(points)
        vector[1] = saved["input"]
        vector[2 : 2 + len(points)] = points
        if "stages" in saved:
            vector[-_STAGES:] = saved["stages"]
    return vector


def _needed(name: str, value: object, kind: type) -> None:
    if not isinstance(value, kind):
        raise TypeError(f"`{name}` is {value!r}: a pyhysteron.{kind.__name__} is needed")


def _state(model: Model, vector: np.ndarray) -> State:
    vector, stages = np.split(vector, [4 * model.levels + 8])
    if not (vector[0] == np.floor(vector[0]) and 0 <= vector[0] <= len(vector) - 2):
        raise ValueError(f"`memory[0]` is {vector[0]}: a whole number from 0 to {len(vector) - 2} is needed, see `memory`")
    count = int(vector[0])
    if count == 0:
        return model.start()
    saved = SavedState(turning_points=vector[2 : 2 + count], input=float(vector[1]))
    if len(stages):
        saved["stages"] = stages
    return model.restore(saved)


def _block(update, output, dt, kwargs, **usual):
    if dt is not True:
        if not (isinstance(dt, numbers.Real) and 0 < dt < np.inf):
            raise ValueError(f"`dt` is {dt!r}: a time above 0, or True, is needed")
        dt = float(dt)
    return control.NonlinearIOSystem(update, output, dt=dt, **{**usual, **kwargs})


def _time_step(model, dt):
    """What a sample needs besides its input, for a block with this sample time."""
    if not model.is_timed:
        return {}
    if dt is True:
        raise ValueError("the model depends on time: `dt` has to be the time between samples, s")
    return {"dt": dt}


def _load(model, signals):
    """The load, the last input of a block whose model depends on one."""
    return {} if model.load_range is None else {"load": signals[-1]}


def _inputs(model, *names):
    return [*names] if model.load_range is None else [*names, "load"]


def _states(model):
    return [f"memory[{n}]" for n in range(len(memory(model)))]


def model_block(model: Model, dt: float | Literal[True], **kwargs: Any) -> control.NonlinearIOSystem:
    """The model as a block, from its input to its output.

    Parameters
    ----------
    model : Model
    dt : float
        Time between samples, s; True for discrete time without a length, as in python-control. A
        model that depends on time needs the length.
    **kwargs
        To `control.NonlinearIOSystem`: 'name', 'inputs', 'outputs'.

    Returns
    -------
    control.NonlinearIOSystem
        Its state is `memory`. Of a model that depends on a load, the load is a second input.

    Examples
    --------
    >>> import control
    >>> block = pyhysteron.blocks.model_block(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)), 0.1)
    >>> control.input_output_response(block, np.array([0, 0.1, 0.2]), [0.5, 1.0, 0.5]).y
    array([[4., 7., 5.]])
    """

    _needed("model", model, Model)
    since = _time_step(model, dt)

    def step(x, u):
        state = _state(model, x)
        return state, state.step(u[0], **since, **_load(model, u))

    def update(t, x, u, params):
        return memory(model, step(x, u)[0])

    def output(t, x, u, params):
        return np.array([step(x, u)[1]])

    usual = {"name": "model", "inputs": _inputs(model, "input"), "outputs": ["output"], "states": _states(model)}
    return _block(update, output, dt, kwargs, **usual)


def inverse_block(
    model: Model,
    dt: float | Literal[True],
    policy: Literal["hold", "anticipate"] = "hold",
    *,
    tolerance: float = 0.0,
    drive_range: tuple[float, float] | None = None,
    horizon: float = 0.0,
    **kwargs: Any,
) -> control.NonlinearIOSystem:
    """The exact inverse as a block, from the wanted output to the input.

    Parameters
    ----------
    model : Model
    dt : float
        Time between samples, s; True for discrete time without a length, as in python-control. A
        model that depends on time needs the length.
    policy : {'hold', 'anticipate'}
        With 'anticipate' there is a second input, where the target goes next: 1 rising, -1 falling,
        0 not known.
    tolerance : float
        Reversals of the target up to this size are noise and not followed, in the output's unit.
    drive_range, horizon
        As for `Model.inverse`.
    **kwargs
        To `control.NonlinearIOSystem`: 'name', 'inputs', 'outputs'.

    Returns
    -------
    control.NonlinearIOSystem
        Its state is `memory`. Of a model that depends on a load, the load is the last input.

    Raises
    ------
    CoreError, FitError
        For a model that has no inverse.

    Examples
    --------
    >>> import control
    >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    >>> inverse, plant = pyhysteron.blocks.inverse_block(model, 0.1), pyhysteron.blocks.model_block(model, 0.1)
    >>> control.input_output_response(control.series(inverse, plant), np.array([0, 0.1, 0.2]), [4.0, 6.0, 5.0]).y
    array([[4., 6., 5.]])
    """
    one_of("policy", policy, "hold", "anticipate")
    _needed("model", model, Model)
    inverse = model.inverse(drive_range, horizon)
    names = ["target"] if policy == "hold" else ["target", "heading"]
    inputs = _inputs(model, *names)
    since = _time_step(model, dt)

    def solve(x, u):
        state = _state(model, x)
        heading = _heading(u[1 : len(names)])
        return state, inverse.step(state, u[0], **since, **_load(model, u), heading=heading, tolerance=tolerance)[0]

    def update(t, x, u, params):
        return memory(model, solve(x, u)[0])

    def output(t, x, u, params):
        return np.array([solve(x, u)[1]])

    usual = {"name": "inverse", "inputs": inputs, "outputs": ["input"], "states": _states(model)}
    return _block(update, output, dt, kwargs, **usual)


def _heading(signal) -> str | None:
    return _HEADINGS.get(float(np.sign(signal[0]))) if len(signal) else None


def adaptive_block(
    adaptive: Adaptive, dt: float | Literal[True], *, tolerance: float = 0.0, **kwargs: Any
) -> control.NonlinearIOSystem:
    """An adaptive compensator as a block: its inverse gives the input for a target, and it learns from what is measured.

    The input for a target comes from the weights learned up to the sample before, so that a reading
    does not act on it at once. The memory of an estimator is no vector: the block's state is the
    number of an estimator. The block keeps the first estimator (number 0) and the last ones, and
    refuses an older number.

    Parameters
    ----------
    adaptive : Adaptive
        The estimator at the start; it is copied.
    dt : float
        Time between samples, s; True for discrete time without a length, as in python-control.
    tolerance : float
        Reversals of the target up to this size are noise and not followed, in the output's unit.
    **kwargs
        To `control.NonlinearIOSystem`: 'name', 'inputs', 'outputs'.

    Returns
    -------
    control.NonlinearIOSystem
        From 'target', and 'output' and 'input' as measured on the actuator, to 'command'.

    Examples
    --------
    >>> import control
    >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    >>> block = pyhysteron.blocks.adaptive_block(pyhysteron.Adaptive(model), 0.1)
    >>> control.input_output_response(block, np.array([0, 0.1]), [[4.0, 4.0], [4.0, 4.0], [0.5, 0.5]]).y
    array([[0.5, 0.5]])
    """
    _needed("adaptive", adaptive, Adaptive)
    known = {0: adaptive.copy()}
    # What followed an estimator and its inputs: the same number for the same question.
    followed = {}
    count = 0

    def at(x):
        number = int(x[0])
        if number not in known:
            raise ValueError(f"the estimator number {number} is not remembered any more: begin again at 0, or go on from the last")
        return known[number].copy()

    def update(t, x, u, params):
        nonlocal count
        question = (int(x[0]), *map(float, u))
        if question not in followed:
            estimator = at(x)
            estimator.solve(u[0], tolerance=tolerance)
            estimator.step(u[2], u[1])
            count += 1
            known[count], followed[question] = estimator, count
            forgotten = count - _REMEMBERED
            if forgotten > 0:
                known.pop(forgotten, None)
                followed.pop(next(iter(followed)))
        return np.array([float(followed[question])])

    def output(t, x, u, params):
        return np.array([at(x).solve(u[0], tolerance=tolerance)[0]])

    usual = {"name": "adaptive", "inputs": ["target", "output", "input"], "outputs": ["command"], "states": ["estimator"]}
    return _block(update, output, dt, kwargs, **usual)

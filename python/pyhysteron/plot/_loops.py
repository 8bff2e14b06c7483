"""Output over input."""

from typing import Any, Literal

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from .._hysteron import Model, Recording
from ._style import DASHED, DOTTED, MODELLED, RECORDED, figure, label, single, source, untimed


@figure
def loops(
    recording: Recording,
    model: Model | None = None,
    *,
    start: Literal["fitted", "off", "on", "rest", "unknown"] = "fitted",
    ax: Axes | None = None,
) -> Axes:
    """Output over input, measured and modelled (Figs. 1 and 11).

    Parameters
    ----------
    recording : Recording
    model : Model, optional
        Driven with the recording's input.
    start : {'fitted', 'off', 'on', 'unknown'}
        Where the operators stand before the first sample.
    ax : matplotlib.axes.Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    TypeError
        For a `recording`, `model` or `ax` of another type.
    FitError, ThermalError
        For a model that needs a load or time, of a recording without them.

    Examples
    --------
    >>> from pyhysteron import plot
    >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1), output="lift [mm]")
    >>> ax = plot.loops(pyhysteron.Recording([0.5, 1.0, 0.5], [4.0, 7.0, 5.5]), model)
    >>> [line.get_label() for line in ax.get_lines()]
    ['measured', 'modelled']
    """
    modelled = None if model is None else model.evaluate(recording, start=start).output_model
    ax = single(ax)
    ax.plot(recording.input, recording.output, label=source(recording), **RECORDED)
    if modelled is not None:
        ax.plot(recording.input, modelled, label="modelled", **MODELLED)
    ax.set(xlabel=label(recording.input_name), ylabel=label(recording.output_name))
    ax.legend()
    return ax


@figure
def major_loops(model: Model, loads: Any = None, *, ax: Axes | None = None) -> Axes:
    """The loop between the ends of the plane, for a model that depends on a load at several loads (Fig. 2).

    Parameters
    ----------
    model : Model
    loads : float or array_like of shape (n,), optional
        In the load's unit; by default the ends of the range that the model was fitted on, and its
        middle.
    ax : matplotlib.axes.Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    FitError
        For a load outside that range, or of a model that depends on none.
    ValueError
        For `loads` without any, or a model that depends on time.
    TypeError
        For a `model`, `loads` or `ax` of another type.

    Examples
    --------
    >>> from pyhysteron import plot
    >>> ax = plot.major_loops(pyhysteron.Model([1.0, 2.0, 4.0], (20, 80), output="lift [mm]"))
    >>> ax.get_ylabel()
    'lift [mm]'
    >>> float(ax.get_lines()[0].get_ydata().max())
    7.0
    """
    untimed(model)
    if loads is None and model.load_range is None:
        path = _path([model])
        ax = single(ax)
        ax.plot(path, model.simulate(path, start="off"), **MODELLED)
    else:
        if loads is None:
            lowest, highest = model.load_range
            loads = np.linspace(lowest, highest, 3)
        else:
            loads = _numbers(loads)
        models = [model.at_load(load) for load in loads]
        path = _path(models)
        outputs = [loaded.simulate(path, start="off") for loaded in models]
        ax = single(ax)
        lines = ("-", DASHED, DOTTED, "-.")
        for k, (load, output) in enumerate(zip(loads, outputs)):
            shade = plt.get_cmap("viridis")(0.8 * k / max(len(loads) - 1, 1))
            ax.plot(path, output, color=shade, linestyle=lines[k % 4], linewidth=1.3, label=f"{load:g}")
        ax.legend(title=label(model.load_name))
    ax.set(xlabel=label(model.input), ylabel=label(model.output))
    return ax


def _path(models):
    """Up and down over the ranges in which the operators move."""
    lows, highs = zip(*(model.active_range for model in models))
    up = np.linspace(min(lows), max(highs), 400)
    return np.concatenate([up, up[::-1]])


def _numbers(loads):
    try:
        numbers = np.asarray(loads, float).ravel()
    except (TypeError, ValueError):
        raise TypeError(f"`loads` is {loads!r}: numbers are needed") from None
    if not len(numbers):
        raise ValueError(f"`loads` is {loads!r}: there is no load to show")
    return numbers

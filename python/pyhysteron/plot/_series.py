"""Series over time."""

from typing import Any, Literal

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from .._hysteron import Model, Recording
from ._style import CONTRAST, MODELLED, RECORDED, figure, label, one_of, several, single, source, unit, without_body


@figure
def over_time(
    recording: Recording,
    model: Model,
    *,
    of: Literal["output", "input"] = "output",
    start: Literal["fitted", "off", "on", "rest", "unknown"] = "fitted",
    axes: Any = None,
) -> NDArray[Any]:
    """Measured and modelled series over time, with the discrepancy below (Figs. 10 and 12, or 13 and 14).

    Parameters
    ----------
    recording : Recording
    model : Model
    of : {'output', 'input'}
        The output of the model for the recorded input; or the input of the inverse model for the
        recorded output, in which samples of a dead band, where the output stands still, are shaded.
    start : {'fitted', 'off', 'on', 'unknown'}
        Where the operators stand before the first sample.
    axes : sequence of two matplotlib.axes.Axes, optional

    Returns
    -------
    ndarray of matplotlib.axes.Axes, shape (2,)
        The series, and modelled less measured.

    Raises
    ------
    ValueError
        For the input of a model without inverse or with a thermal body, another word, or fewer axes.
    TypeError
        For a `recording`, `model` or `axes` of another type.

    Examples
    --------
    >>> from pyhysteron import plot
    >>> model = pyhysteron.Model([1.0, 2.0, 4.0], (0, 1))
    >>> series, difference = plot.over_time(pyhysteron.Recording([0.5, 1.0, 0.5], [4.0, 7.0, 5.5]), model)
    >>> difference.get_lines()[-1].get_ydata()
    array([ 0. ,  0. , -0.5])
    """
    one_of("of", of, "output", "input")
    if of == "input":
        without_body(model)
    found = model.evaluate(recording, start=start)
    time, when = _time(recording)
    inverse = None if of == "output" else _inverse(found)
    series, difference = _stack(axes, (3, 1.6))
    if inverse is None:
        name, measured = recording.output_name, recording.output
        modelled = {"modelled": (found.output_model, MODELLED)}
    else:
        name, measured = recording.input_name, recording.input
        modelled = _policies(inverse)
        for ax in (series, difference):
            _shade(ax, time, inverse.moving)
    series.plot(time, measured, label=source(recording), **RECORDED)
    difference.axhline(0, color="0.3", linewidth=0.8, zorder=1)
    for text, (values, style) in modelled.items():
        series.plot(time, values, label=text, **style)
        difference.plot(time, values - measured, **style)
    series.set_ylabel(label(name))
    difference.set(xlabel=when, ylabel=f"modelled −\n{source(recording)}{unit(name)}")
    _above(series)
    return np.array([series, difference])


@figure
def band(recording: Recording, model: Model, *, ax: Axes | None = None) -> Axes:
    """The recorded output and the model's 95 % prediction band over time.

    Parameters
    ----------
    recording : Recording
    model : Model
        Fitted with a bootstrap.
    ax : matplotlib.axes.Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    FitError
        For a model that was fitted without a bootstrap.
    TypeError
        For a `recording`, `model` or `ax` of another type.

    Examples
    --------
    >>> from pyhysteron import plot
    >>> input = 50 - 30 * np.cos(np.linspace(0, 20, 200))
    >>> noise = 0.01 * np.random.default_rng(1).normal(size=200)
    >>> recording = pyhysteron.Recording(input, np.sqrt(input) + noise)
    >>> plot.band(recording, pyhysteron.fit(recording, levels=5, bootstrap=30)).get_xlabel()
    'sample'
    """
    of = {"time": recording.time} if model.is_timed else {}
    if model.load_range is not None:
        of["load"] = recording.load
    low, high = model.band(recording.input, **of)
    ax = single(ax, wide=True)
    time, when = _time(recording)
    inside = 100 * np.mean((low <= recording.output) & (recording.output <= high))
    known = model.confidence
    name = known.band_name if known is not None else None
    ax.fill_between(time, low, high, color="0.78", linewidth=0, label=name, zorder=1)
    measured = dict(MODELLED, linewidth=0.9)
    ax.plot(time, recording.output, label=f"{source(recording)}, {inside:.1f} % inside", **measured)
    ax.set(xlabel=when, ylabel=label(recording.output_name))
    _above(ax)
    return ax


@figure
def dead_band(
    recording: Recording,
    model: Model,
    *,
    start: Literal["fitted", "off", "on", "rest", "unknown"] = "fitted",
    axes: Any = None,
) -> NDArray[Any]:
    """The dead band with the largest error of the inverse, close up (Fig. 15).

    After a turn the output rests while the input moves, so the inverse cannot follow. 'hold' rests
    until the output moves. 'anticipate' knows where the output goes next, and crosses the dead band
    at once. The shaded stretches are those where the output rests.

    Parameters
    ----------
    recording : Recording
    model : Model
    start : {'fitted', 'off', 'on', 'unknown'}
        Where the operators stand before the first sample.
    axes : sequence of two matplotlib.axes.Axes, optional

    Returns
    -------
    ndarray of matplotlib.axes.Axes, shape (2,)
        The recorded output, and the inputs.

    Raises
    ------
    ValueError
        For a model without inverse or with a thermal body, an output that never stands still, or fewer axes.
    TypeError
        For a `recording`, `model` or `axes` of another type.

    Examples
    --------
    >>> from pyhysteron import plot
    >>> model = pyhysteron.Model([0.0, 1.0, 0.0], (0, 1))
    >>> input = 1.5 * np.sin(np.linspace(0, 12, 100))
    >>> output, input = plot.dead_band(pyhysteron.Recording(input, model.simulate(input)), model)
    >>> [line.get_label() for line in input.get_lines()[1:]]
    ['measured', 'inverse, hold', 'inverse, anticipate']
    """
    without_body(model)
    inverse = _inverse(model.evaluate(recording, start=start))
    moving = inverse.moving
    if moving.all():
        raise ValueError("the output never stands still: there is no dead band to show")
    error = np.abs(inverse.hold.input_model - recording.input)
    worst = int(np.argmax(np.where(moving, -1, error)))
    first, last = next(stretch for stretch in _stretches(moving) if stretch[0] <= worst <= stretch[1])
    length = last - first + 1
    shown = slice(max(first - max(length * 3 // 4, 6), 0), last + 1 + max(length * 5 // 4, 10))
    time, when = _time(recording)
    output, input = _stack(axes, (2, 3))
    for ax in (output, input):
        _shade(ax, time[shown], moving[shown])
        ax.axvline(time[worst], color="0.3", linewidth=0.8, linestyle=":", zorder=1)
    output.plot(time[shown], recording.output[shown], **RECORDED)
    input.plot(time[shown], recording.input[shown], label=source(recording), **RECORDED)
    for text, (values, style) in _policies(inverse).items():
        input.plot(time[shown], values[shown], label=text, **style)
    output.set_ylabel(label(recording.output_name))
    input.set(xlabel=when, ylabel=label(recording.input_name))
    handles, labels = input.get_legend_handles_labels()
    _above(output, handles, labels)
    return np.array([output, input])


def _time(recording):
    if recording.time is None:
        return np.arange(len(recording)), "sample"
    return recording.time, "time [s]"


def _stack(axes, heights):
    if axes is not None:
        return several(axes, 2)
    return plt.subplots(2, sharex=True, height_ratios=heights, figsize=(7, 5.2), layout="constrained")[1]


def _above(ax, *legend):
    """The legend over the panel, where it hides nothing."""
    ax.legend(*legend, loc="lower left", bbox_to_anchor=(0, 1), ncols=3, frameon=False, borderaxespad=0.2)


def _inverse(found):
    if found.inverse is None:
        raise ValueError(f"the model has no inverse: {found.inverse_refused}")
    return found.inverse


def _policies(inverse):
    return {
        "inverse, hold": (inverse.hold.input_model, MODELLED),
        "inverse, anticipate": (inverse.anticipate.input_model, CONTRAST),
    }


def _stretches(moving):
    """First and last sample of each run that does not move."""
    turns = np.flatnonzero(np.diff(np.concatenate([[False], ~moving, [False]])))
    return list(zip(turns[::2], turns[1::2] - 1))


def _shade(ax, time, moving):
    for first, last in _stretches(moving):
        ax.axvspan(time[first], time[last], color="0.93", linewidth=0, zorder=0)

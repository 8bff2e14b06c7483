"""Figures of recordings and models with matplotlib, one call each: those of the chapter that show data and models.

Each function draws into axes of a new figure, or into those it is given, and returns them. Lines differ in lightness and dash as
well as in colour, so that they can be told apart in grey. Where a recording comes from a simulation, the legend says so.

>>> import numpy as np
>>> import hysteron
>>> from hysteron import plot
>>> temperature = 50 - 30 * np.cos(np.linspace(0, 20, 400))
>>> model = hysteron.Model(np.full(15, 0.2), (20, 80), input="temperature [degC]", output="lift [mm]")
>>> recording = hysteron.Recording(temperature, model.simulate(temperature), simulated=True)
>>> ax = plot.loops(recording, model)
>>> ax.figure.savefig("loops.png")
"""

import functools
import inspect
import re

import numpy as np

from . import _hysteron

try:
    import matplotlib.pyplot as plt
except ImportError as _missing:
    raise ImportError("hysteron.plot needs matplotlib: pip install 'hysteron[plot]'") from _missing

__all__ = ["band", "dead_band", "excitation", "loops", "major_loops", "over_time", "plane", "weights"]

_RECORDED = dict(color="0.68", linewidth=3.2, solid_capstyle="round", zorder=2)
_MODELLED = dict(color="#12355b", linewidth=1.1, zorder=3)
_ANTICIPATE = dict(color="#c8501e", linewidth=1.1, linestyle=(0, (5, 2)), zorder=4)
_ZERO = dict(color="0.3", linewidth=0.8, zorder=1)
_STILL = dict(color="0.93", linewidth=0, zorder=0)
_OUTLINE = dict(color="0.6", linewidth=0.8)
_SIGNS = {"degC": "°C", "degF": "°F", "deg": "°", "um": "µm", "uC/cm2": "µC/cm²"}

_KINDS = {"recording": _hysteron.Recording, "model": _hysteron.Model}


def _figure(draw):
    """Refuses what is no recording or model, by the name of the argument."""
    signature = inspect.signature(draw)

    @functools.wraps(draw)
    def checked(*args, **kwargs):
        given = signature.bind(*args, **kwargs).arguments
        for name, kind in _KINDS.items():
            value = given.get(name)
            optional = name in given and signature.parameters[name].default is None and value is None
            if name in given and not optional and not isinstance(value, kind):
                raise TypeError(f"`{name}` is of type {type(value).__name__}: a hysteron.{kind.__name__} is needed")
        return draw(*args, **kwargs)

    return checked


@_figure
def loops(recording, model=None, *, start="off", ax=None):
    """Output over input, measured and modelled (Figs. 1 and 11).

    Parameters
    ----------
    recording : Recording
    model : Model, optional
        Driven with the recording's input.
    start : {'off', 'on', 'unknown'}
        Where the operators stand before the first sample.
    ax : matplotlib.axes.Axes, optional

    Returns
    -------
    matplotlib.axes.Axes
    """
    ax = _single(ax)
    ax.plot(recording.input, recording.output, label=_recorded(recording), **_RECORDED)
    if model is not None:
        modelled = model.evaluate(recording, start=start)["output_model"]
        ax.plot(recording.input, modelled, label="modelled", **_MODELLED)
    ax.set(xlabel=_label(recording.input_name), ylabel=_label(recording.output_name))
    ax.legend()
    return ax


@_figure
def major_loops(model, loads=None, *, ax=None):
    """The loop between the ends of the plane, for a model that depends on a load at several loads (Fig. 2).

    Parameters
    ----------
    model : Model
    loads : array_like, optional
        By default the ends of the range that the model was fitted on, and its middle.
    ax : matplotlib.axes.Axes, optional

    Returns
    -------
    matplotlib.axes.Axes
    """
    ax = _single(ax)
    low, high = model.range
    margin = (high - low) / max(model.levels - 1, 1)  # the ridges start one step below their level
    up = np.linspace(low - margin, high, 400)
    path = np.concatenate([up, up[::-1]])
    if model.load_range is None:
        ax.plot(path, model.simulate(path), **_MODELLED)
    else:
        loads = np.linspace(*model.load_range, 3) if loads is None else np.atleast_1d(loads)
        lines = ("-", (0, (5, 2)), (0, (1, 1.2)), "-.")
        for k, load in enumerate(loads):
            shade = plt.get_cmap("viridis")(0.8 * k / max(len(loads) - 1, 1))
            output = model.at_load(load).simulate(path)
            ax.plot(path, output, color=shade, linestyle=lines[k % 4], linewidth=1.3, label=f"{load:g}")
        told = model.summary()["load"]
        ax.legend(title=_label(f"{told['name']} [{told['unit']}]" if told["unit"] else told["name"]))
    ax.set(xlabel=_label(model.input), ylabel=_label(model.output))
    return ax


@_figure
def over_time(recording, model, *, of="output", start="off", axes=None):
    """Measured and modelled series over time, with the discrepancy below (Figs. 10 and 12, or 13 and 14).

    Parameters
    ----------
    recording : Recording
    model : Model
    of : {'output', 'input'}
        The output of the model for the recorded input; or the input of the inverse model for the recorded output, in which
        samples of a dead band, where the output stands still, are shaded.
    start : {'off', 'on', 'unknown'}
        Where the operators stand before the first sample.
    axes : sequence of two matplotlib.axes.Axes, optional

    Returns
    -------
    ndarray of matplotlib.axes.Axes, shape (2,)
        The series, and modelled less measured.

    Raises
    ------
    ValueError
        For the input of a model without inverse.
    """
    if of not in ("output", "input"):
        raise ValueError(f"`of` is {of!r}: it must be 'output' or 'input'")
    found = model.evaluate(recording, start=start)
    time, when = _time(recording)
    inverse = None if of == "output" else _inverse(found)
    series, difference = _stack(axes, (3, 1.6))
    if inverse is None:
        name, measured = recording.output_name, recording.output
        modelled = {"modelled": (found["output_model"], _MODELLED)}
    else:
        name, measured = recording.input_name, recording.input
        modelled = _policies(inverse)
        for ax in (series, difference):
            _shade(ax, time, inverse["moving"])
    series.plot(time, measured, label=_recorded(recording), **_RECORDED)
    difference.axhline(0, **_ZERO)
    for label, (values, style) in modelled.items():
        series.plot(time, values, label=label, **style)
        difference.plot(time, values - measured, **style)
    series.set_ylabel(_label(name))
    difference.set(xlabel=when, ylabel=f"modelled −\n{_recorded(recording)}{_unit(name)}")
    _above(series)
    return np.array([series, difference])


@_figure
def weights(model, *, kind="marks", ax=None):
    """The weights on the plane: where they are not zero (Fig. 8a), or how large they are (Fig. 8b).

    Parameters
    ----------
    model : Model
    kind : {'marks', 'map'}
        ○ for a weight that is zero and × for one that is not; or a map, the darker the larger, in which negative weights,
        where there are any, bear a dash.
    ax : matplotlib.axes.Axes, optional

    Returns
    -------
    matplotlib.axes.Axes
    """
    if kind not in ("marks", "map"):
        raise ValueError(f"`kind` is {kind!r}: it must be 'marks' or 'map'")
    ax = _single(ax, square=True)
    mu, levels = model.weights, model.plane
    if kind == "map":
        _map(ax, model, mu, f"weight{_unit(model.output)}")
        i, j = np.nonzero(mu < -_zero(mu))
        ax.plot(levels[i], levels[j], "_", color="0.15", markersize=_size(model.levels))
    else:
        some = np.abs(mu) > _zero(mu)
        for chosen, marker, label in (((~np.isnan(mu)) & ~some, "o", "zero"), (some, "x", "not zero")):
            i, j = np.nonzero(chosen)
            ax.plot(
                levels[i],
                levels[j],
                marker,
                color="0.15" if marker == "x" else "0.55",
                markerfacecolor="none",
                markersize=_size(model.levels),
                markeredgewidth=0.9,
                label=f"{label} ({chosen.sum()})",
            )
        ax.legend(loc="lower right")
    _plane_axes(ax, model)
    return ax


@_figure
def excitation(model, input, *, ax=None):
    """What an input, or several, say about each operator of a model's plane.

    Parameters
    ----------
    model : Model
        Its plane and operator count; its weights do not.
    input : array_like of shape (n,), Recording, or list of these
    ax : matplotlib.axes.Axes, optional

    Returns
    -------
    matplotlib.axes.Axes
    """
    ax = _single(ax, square=True)
    classes = model.excitation(input)
    labels = ("never moves", "moves on one branch", "not told from others", "weight follows")
    shades = ("1", "0.86", "0.62", "#12355b")
    colours = plt.matplotlib.colors.ListedColormap(shades)
    edges = _edges(model.plane)
    ax.pcolormesh(edges, edges, classes.T, cmap=colours, vmin=-0.5, vmax=3.5, edgecolor="face", linewidth=0.2)
    ax.stairs(edges[:-1], edges, baseline=None, **_OUTLINE)
    patches = [
        plt.matplotlib.patches.Patch(facecolor=shade, edgecolor="0.6", label=f"{label} ({(classes == k).sum()})")
        for k, (shade, label) in enumerate(zip(shades, labels))
    ]
    ax.legend(handles=patches, loc="lower right")
    _plane_axes(ax, model)
    return ax


@_figure
def plane(model, input, *, at=None, start="off", axes=None):
    """Evolution of the plane: the operators' states at a few moments of a history (Figs. 6 and 7).

    ○ for an operator at 0, a filled square for one between 0 and 1, ● for one at 1. The dashed line is the present input: rising, it
    switches operators on below it; falling, it switches them off to its right.

    Parameters
    ----------
    model : Model
    input : array_like, shape (n,)
        The history, from its first sample on.
    at : sequence of int, optional
        The samples to show; by default the last before each of the first turns, six at most.
    start : {'off', 'on'}
        Where the operators stand before the first sample.
    axes : sequence of matplotlib.axes.Axes, optional
        As many as samples are shown.

    Returns
    -------
    ndarray of matplotlib.axes.Axes
    """
    if model.thermal is not None:
        raise ValueError("the model has a thermal body: its operators see the body's temperature, not the input")
    if start not in ("off", "on"):
        raise ValueError(f"`start` is {start!r}: it must be 'off' or 'on'")
    input = np.asarray(input, float)
    if at is None:
        branch = _hysteron.branches(input)
        at = np.append(np.flatnonzero(np.diff(branch)), len(input) - 1)[:6]
    at = [range(len(input))[k] for k in at]
    if axes is None:
        columns = min(len(at), 3)
        rows = -(-len(at) // columns)
        size = (2.8 * columns + 0.5, 3.0 * rows + 0.7)
        figure, grid = plt.subplots(rows, columns, figsize=size, squeeze=False, layout="compressed")
        axes = grid.ravel()
        for spare in axes[len(at) :]:
            spare.remove()
        inner = [k for k in range(len(at)) if k + columns < len(at)], [k for k in range(len(at)) if k % columns]
    else:
        figure, inner = axes[0].figure, ((), ())
    axes = np.asarray(axes, object).ravel()[: len(at)]
    name, unit = re.match(r"(.*?)\s*(?:\[(.*)\])?$", model.input).groups()
    for ax, sample in zip(axes, at):
        _states(ax, model, input[: sample + 1], on=start == "on")
        ax.set_title(f"{input[sample]:.4g} {_SIGNS.get(unit, unit or '')} at sample {sample}".replace("  ", " "), fontsize=9)
        _plane_axes(ax, model)
    for k in inner[0]:
        axes[k].set_xlabel("")
    for k in inner[1]:
        axes[k].set_ylabel("")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper left", ncols=4 if len(at) > 1 else 2, fontsize=9)
    return axes


@_figure
def band(recording, model, *, ax=None):
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
    """
    of = {} if model.thermal is None else {"time": recording.time}
    if model.load_range is not None:
        of["load"] = recording.load
    low, high = model.band(recording.input, **of)
    ax = _single(ax, wide=True)
    time, when = _time(recording)
    inside = 100 * np.mean((low <= recording.output) & (recording.output <= high))
    ax.fill_between(time, low, high, color="0.78", linewidth=0, label="95 % band of the model", zorder=1)
    measured = dict(_MODELLED, linewidth=0.9)
    ax.plot(time, recording.output, label=f"{_recorded(recording)}, {inside:.1f} % inside", **measured)
    ax.set(xlabel=when, ylabel=_label(recording.output_name))
    _above(ax)
    return ax


@_figure
def dead_band(recording, model, *, start="off", axes=None):
    """The dead band with the largest error of the inverse, close up (Fig. 15).

    After a turn the output stands still while the input travels, so that the inverse cannot follow: 'hold' rests
    until the output moves; 'anticipate', told where the output goes next, crosses the dead band at once. Shaded where the output stands still.

    Parameters
    ----------
    recording : Recording
    model : Model
    start : {'off', 'on', 'unknown'}
        Where the operators stand before the first sample.
    axes : sequence of two matplotlib.axes.Axes, optional

    Returns
    -------
    ndarray of matplotlib.axes.Axes, shape (2,)
        The recorded output, and the inputs.

    Raises
    ------
    ValueError
        For a model without inverse, or an output that never stands still.
    """
    inverse = _inverse(model.evaluate(recording, start=start))
    moving = inverse["moving"]
    if moving.all():
        raise ValueError("the output never stands still: there is no dead band to show")
    error = np.abs(inverse["hold"]["input_model"] - recording.input)
    worst = int(np.argmax(np.where(moving, -1, error)))
    first, last = next(stretch for stretch in _stretches(moving) if stretch[0] <= worst <= stretch[1])
    length = last - first + 1
    shown = slice(max(first - max(length * 3 // 4, 6), 0), last + 1 + max(length * 5 // 4, 10))
    time, when = _time(recording)
    output, input = _stack(axes, (2, 3))
    for ax in (output, input):
        _shade(ax, time[shown], moving[shown])
        ax.axvline(time[worst], color="0.3", linewidth=0.8, linestyle=":", zorder=1)
    output.plot(time[shown], recording.output[shown], **_RECORDED)
    input.plot(time[shown], recording.input[shown], label=_recorded(recording), **_RECORDED)
    for label, (values, style) in _policies(inverse).items():
        input.plot(time[shown], values[shown], label=label, **style)
    output.set_ylabel(_label(recording.output_name))
    input.set(xlabel=when, ylabel=_label(recording.input_name))
    handles, labels = input.get_legend_handles_labels()
    _above(output, handles, labels)
    return np.array([output, input])


def _label(name):
    """`temperature [degC]` with the signs of the units."""
    return re.sub(r"\[(.*)\]$", lambda found: f"[{_SIGNS.get(found[1], found[1])}]", name)


def _unit(name):
    found = re.search(r"\s*\[.*\]$", _label(name))
    return found[0] if found else ""


def _recorded(recording):
    return "simulated" if recording.simulated else "measured"


def _time(recording):
    if recording.time is None:
        return np.arange(len(recording)), "sample"
    return recording.time, "time [s]"


def _single(ax, *, square=False, wide=False):
    if ax is not None:
        return ax
    size = (5, 4.6) if square else (7, 3.4) if wide else (5.6, 4.2)
    return plt.subplots(figsize=size, layout="constrained")[1]


def _stack(axes, heights):
    if axes is not None:
        first, second = axes
        return first, second
    return plt.subplots(2, sharex=True, height_ratios=heights, figsize=(7, 5.2), layout="constrained")[1]


def _above(ax, *legend):
    """The legend over the panel, where it hides nothing."""
    ax.legend(*legend, loc="lower left", bbox_to_anchor=(0, 1), ncols=3, frameon=False, borderaxespad=0.2)


def _inverse(found):
    if found["inverse"] is None:
        raise ValueError(f"the model has no inverse: {found['inverse_refused']}")
    return found["inverse"]


def _policies(inverse):
    return {
        "inverse, hold": (inverse["hold"]["input_model"], _MODELLED),
        "inverse, anticipate": (inverse["anticipate"]["input_model"], _ANTICIPATE),
    }


def _stretches(moving):
    """First and last sample of each run that does not move."""
    turns = np.flatnonzero(np.diff(np.concatenate([[False], ~moving, [False]])))
    return list(zip(turns[::2], turns[1::2] - 1))


def _shade(ax, time, moving):
    for first, last in _stretches(moving):
        ax.axvspan(time[first], time[last], **_STILL)


def _zero(mu):
    """The magnitude up to which a weight is a solver's rounding."""
    return 1e-9 * np.nanmax(np.abs(mu))


def _size(levels):
    """Markers that do not touch in axes of some 280 points."""
    return float(np.clip(0.66 * 280 / (levels + 1), 1, 9))


def _edges(levels):
    step = levels[1] - levels[0] if len(levels) > 1 else 1.0
    return np.append(levels - step / 2, levels[-1] + step / 2)


def _map(ax, model, values, label):
    edges = _edges(model.plane)
    most = np.nanmax(np.abs(values)) or 1.0
    signed = np.nanmin(values) < -_zero(values)
    bounds = dict(cmap="PuOr", vmin=-most) if signed else dict(cmap="Blues", vmin=0)
    mesh = ax.pcolormesh(edges, edges, values.T, vmax=most, edgecolor="face", linewidth=0.2, **bounds)
    ax.stairs(edges[:-1], edges, baseline=None, **_OUTLINE)
    ax.figure.colorbar(mesh, ax=ax, label=label, shrink=0.85)


def _plane_axes(ax, model):
    edges = _edges(model.plane)
    unit = _unit(model.input)
    ax.set(xlabel=f"α{unit}", ylabel=f"β{unit}", xlim=(edges[0], edges[-1]), ylim=(edges[0], edges[-1]), aspect="equal")


def _states(ax, model, history, *, on):
    gamma, levels = _gamma(model, history, on=on), model.plane
    kinds = (
        (gamma <= 1e-9, "o", "none", "γ = 0"),
        ((gamma > 1e-9) & (gamma < 1 - 1e-9), "s", "0.55", "0 < γ < 1"),
        (gamma >= 1 - 1e-9, "o", "0.1", "γ = 1"),
    )
    size = 0.6 * _size(model.levels)
    for chosen, marker, face, label in kinds:
        i, j = np.nonzero(chosen)
        style = dict(color="0.35", markerfacecolor=face, markersize=size, markeredgewidth=0.6)
        ax.plot(levels[i], levels[j], marker, label=label, **style)
    now = np.clip(history[-1], *_edges(levels)[[0, -1]])
    moved = np.flatnonzero(history != history[-1])
    rising = not len(moved) or history[moved[-1]] < history[-1]
    bottom = _edges(levels)[0]
    line = ([bottom, now], [now, now]) if rising else ([now, now], [now, 2 * levels[-1]])
    ax.plot(*line, color="#c8501e", linestyle="--", linewidth=1.1, label="present input")


def _gamma(model, history, *, on=False):
    """The operators' states after a history, shape (K, K), NaN below the diagonal: equation (5), over what is remembered."""
    k = np.arange(1, model.levels + 1)
    low, high = model.range
    step = (high - low) / max(model.levels - 1, 1)
    gamma = np.full((model.levels, model.levels), float(on))
    for value in history[_hysteron.remembered(history)]:
        x = (value - low) / step + 1
        if model.operator == "relay":
            falling, rising = (x > k).astype(float), (x >= k).astype(float)
        else:
            falling = rising = np.clip(x - (k - 1), 0, 1)
        gamma = np.maximum(rising[None, :], np.minimum(gamma, falling[:, None]))
    gamma[np.tril_indices(model.levels, -1)] = np.nan
    return gamma

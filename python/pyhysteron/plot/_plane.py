"""The Preisach plane: its operators, their states, and how well an input determines them."""

import operator
from collections.abc import Sequence
from typing import Any, Literal

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch
from numpy.typing import ArrayLike, NDArray

from .._hysteron import Model, Recording, branches
from ._style import BLUE, ORANGE, amount, figure, levels_of, one_of, several, single, unit, untimed

_COLUMNS = 3
#: An input on a level leaves each operator at 0 or 1, up to rounding of some 1e-13.
_ROUNDING = 1e-9


@figure
def grid(model: Model, *, ax: Axes | None = None) -> Axes:
    """The discretised plane: a grid point s_ij = (α_i, β_j), i ≤ j, for each operator, and the levels (Fig. 3).

    Parameters
    ----------
    model : Model
        Its plane counts; its weights do not.
    ax : matplotlib.axes.Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    TypeError
        For a `model` or `ax` of another type.

    Examples
    --------
    >>> from pyhysteron import plot
    >>> ax = plot.grid(pyhysteron.Model([1.0, 2.0, 4.0], (20, 80)))
    >>> ax.get_lines()[0].get_xydata().tolist()
    [[20.0, 20.0], [20.0, 80.0], [80.0, 80.0]]
    """
    ax = single(ax, square=True)
    levels, count = levels_of(model), model.levels
    i, j = np.triu_indices(count)
    ax.plot(levels[i], levels[j], "o", color="0.15", markersize=0.5 * marker_size(count))
    plane_axes(ax, model)
    named = np.linspace(0, count - 1, min(count, 6)).round().astype(int)
    ax.set_xticks(levels[named], [f"$\\alpha_{{{k + 1}}}$\n{levels[k]:.4g}" for k in named])
    ax.set_yticks(levels[named], [f"{levels[k]:.4g} $\\beta_{{{k + 1}}}$" for k in named])
    one = (count - 1) // 2
    point = f"$s_{{{one + 1},{one + 2}}} = (\\alpha_{{{one + 1}}}, \\beta_{{{one + 2}}})$"
    ax.annotate(
        point,
        (levels[one], levels[one + 1]),
        (0.97, 0.36),
        textcoords="axes fraction",
        horizontalalignment="right",
        arrowprops=dict(arrowstyle="->", color=ORANGE, shrinkB=3),
    )
    sizes = f"$K$ = {count}\n$N$ = {len(i)}"
    if model.spacing is None:
        sizes += f"\n$\\Delta T$ = {amount(levels[1] - levels[0], model.input)}"
    ax.text(0.97, 0.04, sizes, transform=ax.transAxes, horizontalalignment="right", linespacing=1.5)
    return ax


@figure
def excitation(
    model: Model, input: ArrayLike | Recording | Sequence[ArrayLike | Recording], *, ax: Axes | None = None
) -> Axes:
    """What an input, or several, say about each operator of a model's plane.

    Parameters
    ----------
    model : Model
        Its plane and operator count; its weights do not.
    input : array_like of shape (n,), Recording, or list of these
        In the input's unit.
    ax : matplotlib.axes.Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    TypeError
        For a `model`, `input` or `ax` of another type.
    ValueError
        For an input that is NaN or infinite.

    Examples
    --------
    >>> from pyhysteron import plot
    >>> ax = plot.excitation(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)), [0.0, 1.0])
    >>> ax.get_legend().get_texts()[0].get_text()
    'never moves (1)'
    """
    classes = model.excitation(input)
    ax = single(ax, square=True)
    labels = ("never moves", "moves on one branch", "not told from others", "weight follows")
    shades = ("1", "0.86", "0.62", BLUE)
    colour_map(ax, model, classes, cmap=ListedColormap(shades), vmin=-0.5, vmax=3.5)
    patches = [
        Patch(facecolor=shade, edgecolor="0.6", label=f"{label} ({(classes == k).sum()})")
        for k, (shade, label) in enumerate(zip(shades, labels))
    ]
    ax.legend(handles=patches, loc="lower right")
    return ax


@figure
def plane(
    model: Model,
    input: ArrayLike,
    *,
    at: ArrayLike | None = None,
    start: Literal["off", "on"] = "off",
    axes: Any = None,
) -> NDArray[Any]:
    """Evolution of the plane: the operators' states at a few moments of a history (Figs. 6 and 7).

    ○ for an operator at 0, a filled square for one between 0 and 1, ● for one at 1. The dashed line
    is the present input: rising, it switches operators on below it; falling, it switches them off
    to its right.

    Parameters
    ----------
    model : Model
    input : array_like, shape (n,)
        The history, from its first sample on, in the input's unit.
    at : sequence of int, optional
        The samples to show; by default the last before each of the first turns, six at most.
    start : {'off', 'on'}
        Where the operators stand before the first sample.
    axes : sequence of matplotlib.axes.Axes, optional
        As many as samples are shown.

    Returns
    -------
    ndarray of matplotlib.axes.Axes, shape (m,)

    Raises
    ------
    ValueError
        For a model that depends on time, an input without samples or one that is NaN or infinite,
        `at` without samples, or fewer axes.
    IndexError
        For a sample that the input does not have.
    TypeError
        For a `model`, `input`, `at` or `axes` of another type.

    Examples
    --------
    >>> from pyhysteron import plot
    >>> axes = plot.plane(pyhysteron.Model([1.0, 2.0, 4.0], (0, 1)), [0.0, 1.0, 0.5], at=[1, 2])
    >>> [len(line.get_xdata()) for line in axes[1].get_lines()[:3]]  # at 0, between, at 1
    [0, 1, 2]
    """
    untimed(model)
    one_of("start", start, "off", "on")
    branch = branches(input)
    input = np.asarray(input, float)
    if not len(input):
        raise ValueError("`input` has no samples")
    if at is None:
        at = np.append(np.flatnonzero(np.diff(branch)), len(input) - 1)[:6]
    histories = [input[: sample + 1] for sample in _samples(at, len(input))]
    own = axes is None
    axes = _panels(len(histories)) if own else several(axes, len(histories))
    if model.load_range is not None:
        model = model.at_load(sum(model.load_range) / 2)
    for ax, history in zip(axes, histories):
        state = model.start(on=start == "on")
        state.run(history)
        _states(ax, model, state.operators)
        _present(ax, model, history)
        ax.set_title(f"{amount(history[-1], model.input)} at sample {len(history) - 1}", fontsize=9)
        plane_axes(ax, model)
    if own:  # labelled where no panel is below, or to the left
        for ax in axes[:-_COLUMNS]:
            ax.set_xlabel("")
        for ax in np.delete(axes, np.s_[::_COLUMNS]):
            ax.set_ylabel("")
    axes[0].legend(loc="lower right", fontsize=7)
    return axes


def plane_axes(ax, model):
    edges = _edges(levels_of(model))
    of = unit(model.input)
    ax.set(xlabel=f"α{of}", ylabel=f"β{of}", xlim=(edges[0], edges[-1]), ylim=(edges[0], edges[-1]), aspect="equal")


def colour_map(ax, model, values, **shades):
    """A square for each operator, shape (K, K), NaN below the diagonal."""
    edges = _edges(levels_of(model))
    mesh = ax.pcolormesh(edges, edges, values.T, edgecolor="face", linewidth=0.2, **shades)
    ax.stairs(edges[:-1], edges, baseline=None, color="0.6", linewidth=0.8)
    plane_axes(ax, model)
    return mesh


def marker_size(levels):
    """Markers that do not touch in axes of some 280 points."""
    return float(np.clip(0.66 * 280 / (levels + 1), 1, 9))


def _edges(levels):
    halves = np.diff(levels) / 2
    ends = levels[0] - halves[0], levels[-1] + halves[-1]
    return np.concatenate([ends[:1], levels[:-1] + halves, ends[1:]])


def _samples(at, count):
    """The samples that `at` names, counted from the first."""
    try:
        samples = [operator.index(sample) for sample in at]
    except TypeError:
        raise TypeError(f"`at` is {at!r}: a sequence of whole numbers is needed") from None
    if not samples:
        raise ValueError(f"`at` is {at!r}: there is no sample to show")
    for sample in samples:
        if not -count <= sample < count:
            raise IndexError(f"`at` has {sample}: the input's samples are 0 to {count - 1}")
    return [sample % count for sample in samples]


def _panels(count):
    columns = min(count, _COLUMNS)
    rows = -(-count // columns)
    size = (2.8 * columns + 0.5, 3.0 * rows + 0.3)
    panels = plt.subplots(rows, columns, figsize=size, squeeze=False, layout="compressed")[1].ravel()
    for spare in panels[count:]:
        spare.remove()
    return panels[:count]


def _states(ax, model, gamma):
    levels, size = levels_of(model), 0.6 * marker_size(model.levels)
    kinds = (
        (gamma <= _ROUNDING, "o", "none", "γ = 0"),
        ((gamma > _ROUNDING) & (gamma < 1 - _ROUNDING), "s", "0.55", "0 < γ < 1"),
        (gamma >= 1 - _ROUNDING, "o", "0.1", "γ = 1"),
    )
    for chosen, marker, face, label in kinds:
        i, j = np.nonzero(chosen)
        style = dict(color="0.35", markerfacecolor=face, markersize=size, markeredgewidth=0.6)
        ax.plot(levels[i], levels[j], marker, label=label, **style)


def _present(ax, model, history):
    edges = _edges(levels_of(model))
    now = np.clip(history[-1], edges[0], edges[-1])
    moved = np.flatnonzero(history != history[-1])
    rising = not len(moved) or history[moved[-1]] < history[-1]
    line = ([edges[0], now], [now, now]) if rising else ([now, now], [now, edges[-1]])
    ax.plot(*line, color=ORANGE, linestyle="--", linewidth=1.1, label="present input")

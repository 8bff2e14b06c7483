"""The weights over the plane."""

from typing import Literal

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from .._hysteron import Model
from ._plane import colour_map, marker_size, plane_axes
from ._style import figure, levels_of, one_of, single, unit


@figure
def weights(model: Model, *, kind: Literal["marks", "map", "bars"] = "marks", ax: Axes | None = None) -> Axes:
    """The weights on the plane: where they are not zero (Fig. 8a), or how large they are (Fig. 8b).

    Parameters
    ----------
    model : Model
    kind : {'marks', 'map', 'bars'}
        ○ for a weight that is zero and × for one that is not; a map, the darker the larger, in
        which negative weights, where there are any, bear a dash; or bars in three dimensions.
    ax : matplotlib.axes.Axes, optional
        For bars with ``projection='3d'``.

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ValueError
        For another kind, or bars in axes of two dimensions.
    TypeError
        For a `model` or `ax` of another type.

    Examples
    --------
    >>> from pyhysteron import plot
    >>> ax = plot.weights(pyhysteron.Model([1.0, 0.0, 4.0], (20, 80)))
    >>> [line.get_label() for line in ax.get_lines()]
    ['zero (1)', 'not zero (2)']
    """
    one_of("kind", kind, "marks", "map", "bars")
    return {"marks": _marks, "map": _map, "bars": _bars}[kind](model, ax)


def _marks(model, ax):
    ax = single(ax, square=True)
    mu, levels = model.weights, levels_of(model)
    some = np.abs(mu) > _zero(mu)
    for chosen, marker, label in (((~np.isnan(mu)) & ~some, "o", "zero"), (some, "x", "not zero")):
        i, j = np.nonzero(chosen)
        ax.plot(
            levels[i],
            levels[j],
            marker,
            color="0.15" if marker == "x" else "0.55",
            markerfacecolor="none",
            markersize=marker_size(model.levels),
            markeredgewidth=0.9,
            label=f"{label} ({chosen.sum()})",
        )
    ax.legend(loc="lower right")
    plane_axes(ax, model)
    return ax


def _map(model, ax):
    ax = single(ax, square=True)
    mu, levels = model.weights, levels_of(model)
    mesh = colour_map(ax, model, mu, **_shades(mu))
    ax.figure.colorbar(mesh, ax=ax, label=f"weight{unit(model.output)}", shrink=0.85)
    i, j = np.nonzero(mu < -_zero(mu))
    ax.plot(levels[i], levels[j], "_", color="0.15", markersize=marker_size(model.levels))
    return ax


def _bars(model, ax):
    if ax is None:
        ax = plt.subplots(figsize=(6, 4.8), layout="constrained", subplot_kw={"projection": "3d"})[1]
    elif ax.name != "3d":
        raise ValueError(f"`ax` has the projection {ax.name!r}: bars need '3d'")
    mu, levels = model.weights, levels_of(model)
    i, j = np.triu_indices(model.levels)
    width = 0.7 * np.diff(levels).min()
    shades = _shades(mu)
    colours = plt.get_cmap(shades["cmap"])(plt.Normalize(shades["vmin"], shades["vmax"])(mu[i, j]))
    ax.bar3d(levels[i] - width / 2, levels[j] - width / 2, 0, width, width, mu[i, j], color=colours, edgecolor="0.3", linewidth=0.3)
    plane_axes(ax, model)
    low, high = min(0, np.nanmin(mu)), max(0, np.nanmax(mu))
    ax.set(aspect="auto", zlabel=f"weight{unit(model.output)}", zlim=(low, high if high > low else 1))
    return ax


def _shades(mu):
    """Colours for weights of one sign, the darker the larger, or of both."""
    most = np.nanmax(np.abs(mu)) or 1.0
    if np.nanmin(mu) < -_zero(mu):
        return dict(cmap="PuOr", vmin=-most, vmax=most)
    return dict(cmap="Blues", vmin=0, vmax=most)


def _zero(mu):
    """The magnitude up to which a weight is a solver's rounding."""
    return 1e-9 * np.nanmax(np.abs(mu))

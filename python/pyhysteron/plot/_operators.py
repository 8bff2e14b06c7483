"""The elementary operators, and the model as a sum of them."""

from typing import Any, Literal

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

from .._hysteron import Model
from ._style import BLUE, CONTRAST, DASHED, DOTTED, MODELLED, figure, label, several, single, without_body


def operators(*, axes: Any = None) -> NDArray[Any]:
    """Output over input of one relay, one KP and one MKP operator (Fig. 5).

    Models with one weight, simulated: between the two bounding curves, the ridge functions of
    equation (4), the relay jumps, and KP and MKP operators keep their output where the input turns
    back.

    Parameters
    ----------
    axes : sequence of three matplotlib.axes.Axes, optional

    Returns
    -------
    ndarray of matplotlib.axes.Axes, shape (3,)

    Raises
    ------
    ValueError
        For fewer axes.
    TypeError
        For `axes` of another type.

    Examples
    --------
    >>> from pyhysteron import plot
    >>> [ax.get_title() for ax in plot.operators()]
    ['relay', 'KP', 'MKP']
    """
    if axes is None:
        axes = plt.subplots(1, 3, sharey=True, figsize=(9, 3), layout="constrained")[1]
    axes = several(axes, 3)
    weights = np.zeros((5, 5))
    weights[1, 3] = 1  # s_24 on the levels 0, 1, …, 4: ΔT = 1
    rising = np.linspace(-0.8, 3.8, 461)
    names: list[tuple[Literal["mkp", "kp", "relay"], str]] = [("relay", "relay"), ("kp", "KP"), ("mkp", "MKP")]
    for ax, (operator, name) in zip(axes, names):
        one = Model(weights, (0, 4), operator=operator)
        there, back = np.split(one.simulate(np.concatenate([rising, rising[::-1]])), 2)
        for input, output, text, dash in ((rising, there, "rising", "-"), (rising[::-1], back, "falling", DASHED)):
            ax.plot(input, output, label=text, **dict(MODELLED, linewidth=1.4, linestyle=dash))
            _head(ax, input, output)
        if name != "relay":
            halfway = np.linspace(2.5, 0.5, 201)  # from the middle of one bounding curve to that of the other
            turned = one.simulate(np.append(rising[rising < 2.5], halfway))[-201:]
            ax.plot(halfway, turned, label="turned back", **dict(CONTRAST, linewidth=1.6, linestyle=DOTTED))
        ax.set(title=name, xlabel="input $T$", ylim=(-1.25, 1.25), yticks=(-1, 0, 1))
        ax.set_xticks(range(4), [r"$\alpha_{i-1}$", r"$\alpha_i$", r"$\beta_{j-1}$", r"$\beta_j$"])
    axes[0].set_ylabel(r"output $\gamma_{s_{ij}}$")
    axes[2].legend(loc="lower right", fontsize=8)
    return axes


def _head(ax, input, output):
    """An arrow's head where the output passes the middle of its range, in the direction of the samples."""
    above = output > (output.min() + output.max()) / 2
    passing = np.flatnonzero(np.diff(above))[0]
    ends = np.column_stack([input, output])[passing : passing + 2]
    ax.annotate("", ends.mean(0), ends[0], arrowprops=dict(arrowstyle="-|>", color=BLUE, shrinkA=0, shrinkB=0, mutation_scale=14))


@figure
def structure(model: Model, *, ax: Axes | None = None) -> Axes:
    """The model as a parallel connection of operators, weighted and summed (Fig. 4, equation 2).

    Parameters
    ----------
    model : Model
    ax : matplotlib.axes.Axes, optional

    Returns
    -------
    matplotlib.axes.Axes

    Raises
    ------
    ValueError
        For a model with a thermal body.
    TypeError
        For a `model` or `ax` of another type.

    Examples
    --------
    >>> from pyhysteron import plot
    >>> ax = plot.structure(pyhysteron.Model([1.0, 2.0, 4.0], (20, 80), input="temperature [degC]"))
    >>> ax.texts[0].get_text()
    'temperature [°C]'
    """
    without_body(model)
    ax = single(ax, wide=True)
    arrow = dict(arrowstyle="-|>", color="0.15", linewidth=1, shrinkA=0)

    def wire(start, end, gap=0):
        ax.annotate("", end, start, arrowprops=dict(arrow, shrinkB=gap))

    def box(left, right, y, text):
        ax.add_patch(Rectangle((left, y - 0.3), right - left, 0.6, facecolor="1", edgecolor="0.15"))
        ax.text((left + right) / 2, y, text, ha="center", va="center")

    ax.text(0, 1.6, label(model.input), va="bottom")
    wire((0, 1.5), (2.3, 1.5))
    ax.plot([2.3, 2.3], [0, 3], color="0.15", linewidth=1)
    last = model.levels
    for y, i, j in ((3, 1, 1), (2, 1, 2), (0, last, last)):
        wire((2.3, y), (2.9, y))
        box(2.9, 3.9, y, f"$\\gamma_{{{i},{j}}}$")
        wire((3.9, y), (4.5, y))
        box(4.5, 6.6, y, f"$\\mu_{{{i},{j}}}$ = {model.weights[i - 1, j - 1]:.3g}")
        wire((6.6, y), (7.6, 1.5), gap=13)
    if last > 2:
        ax.text(3.4, 1, "⋮", ha="center", va="center")
        ax.text(5.55, 1, "⋮", ha="center", va="center")
    wire((7.6, 1.5), (10.6, 1.5))
    ax.text(7.6, 1.5, "Σ", ha="center", va="center", bbox=dict(boxstyle="circle", facecolor="1", edgecolor="0.15"))
    ax.text(10.6, 1.6, label(model.output), va="bottom", ha="right")
    ax.text(10.6, 1.4, f"= {model.offset:.3g} {'+' if model.sign > 0 else '−'} Σ", va="top", ha="right")
    ax.set(xlim=(-0.1, 10.8), ylim=(-0.5, 3.5))
    ax.set_axis_off()
    return ax

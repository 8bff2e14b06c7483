"""What the figures share: the look of lines, labels with units, axes, and the arguments that are refused."""

import functools
import inspect
import re
from collections.abc import Callable
from typing import Any, TypeVar, cast

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from .._convert import did_you_mean
from .._convert import one_of as one_of
from .._hysteron import Model, Recording

BLUE, ORANGE = "#12355b", "#c8501e"  # apart in grey too
DASHED, DOTTED = (0, (5, 2)), (0, (1, 1.2))
RECORDED: dict[str, Any] = dict(color="0.68", linewidth=3.2, solid_capstyle="round", zorder=2)
MODELLED: dict[str, Any] = dict(color=BLUE, linewidth=1.1, zorder=3)
CONTRAST: dict[str, Any] = dict(color=ORANGE, linewidth=1.1, linestyle=DASHED, zorder=4)

_SIGNS = {"degC": "°C", "degF": "°F", "deg": "°", "um": "µm", "uC/cm2": "µC/cm²"}
_KINDS = {
    "recording": (Recording, "a pyhysteron.Recording"),
    "model": (Model, "a pyhysteron.Model"),
    "ax": (Axes, "a matplotlib Axes"),
}


_Draw = TypeVar("_Draw", bound=Callable[..., Any])


def figure(draw: _Draw) -> _Draw:
    """Refuses what is no recording, model or axes, and unknown options, by the name of the argument."""
    signature = inspect.signature(draw)

    @functools.wraps(draw)
    def checked(*args, **kwargs):
        for name in kwargs:
            if name not in signature.parameters:
                meant = did_you_mean(name, signature.parameters, "`")
                raise TypeError(f"{draw.__name__}: there is no argument `{name}`{meant}")
        for name, value in signature.bind(*args, **kwargs).arguments.items():
            if name in _KINDS and not (value is None and signature.parameters[name].default is None):
                of_kind(name, value, *_KINDS[name])
        return draw(*args, **kwargs)

    return cast(_Draw, checked)


def of_kind(name, value, kind, needed):
    if not isinstance(value, kind):
        raise TypeError(f"`{name}` is of type {type(value).__name__}: {needed} is needed")


def without_body(model):
    if model.thermal is not None:
        raise ValueError("the model has a thermal body: its operators see the body's temperature, not the input")


def untimed(model):
    without_body(model)
    if model.is_timed:
        raise ValueError("the model has creep or a lag: its output depends on time, not on the input alone")


def levels_of(model):
    """The levels as inputs."""
    return model.plane if model.spacing is None else model.spacing[1:]


def single(ax, *, square=False, wide=False):
    """The axes given, or those of a new figure."""
    if ax is not None:
        return ax
    size = (5, 4.6) if square else (7, 3.4) if wide else (5.6, 4.2)
    return plt.subplots(figsize=size, layout="compressed")[1]


def several(axes, count):
    """As many of the axes given as are needed, shape (count,)."""
    axes = np.asarray(axes, object).ravel()
    if len(axes) < count:
        raise ValueError(f"`axes` has {len(axes)}: {count} are needed")
    for k, ax in enumerate(axes[:count]):
        of_kind(f"axes[{k}]", ax, *_KINDS["ax"])
    return axes[:count]


def label(name):
    """`temperature [degC]` with the signs of the units."""
    return re.sub(r"\[(.*)\]$", lambda found: f"[{_SIGNS.get(found[1], found[1])}]", name)


def unit(name):
    """` [°C]` of `temperature [degC]`, or nothing."""
    found = re.search(r"\s*\[.*\]$", label(name))
    return found[0] if found else ""


def amount(value, name):
    """`50 °C`, a value of what `name` names."""
    return f"{value:.4g} {unit(name).strip(' []')}".rstrip()


def source(recording):
    return "simulated" if recording.simulated else "measured"

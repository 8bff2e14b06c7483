"""Figures of recordings and models with matplotlib, one call each.

Each function draws into axes of a new figure, or into those it is given, and returns them. Lines
differ in lightness and dash as well as in colour, so that they differ in grey too. Where a
recording comes from a simulation, the legend says so.

>>> import numpy as np
>>> import pyhysteron
>>> from pyhysteron import plot
>>> temperature = 50 - 30 * np.cos(np.linspace(0, 20, 400))
>>> model = pyhysteron.Model(np.full(15, 0.2), (20, 80), input="temperature [degC]", output="lift [mm]")
>>> recording = pyhysteron.Recording(temperature, model.simulate(temperature), simulated=True)
>>> ax = plot.loops(recording, model)
>>> ax.figure.savefig("loops.png")

The figures of the chapter:

======  ==============================================
Figure  Call
======  ==============================================
1, 11   ``loops(recording)``, ``loops(recording, model)``
2       ``major_loops(model)``
3       ``grid(model)``
4       ``structure(model)``
5       ``operators()``
6, 7    ``plane(model, input)``
8       ``weights(model)``, ``weights(model, kind="bars")``
10, 12  ``over_time(recording, model)``
13, 14  ``over_time(recording, model, of="input")``
15      ``dead_band(recording, model)``
======  ==============================================

Only Fig. 9 is not among them: it shows the windows of another program, Simulink.
"""

try:
    import matplotlib as _matplotlib  # noqa: F401
except ImportError as _missing:
    raise ImportError("pyhysteron.plot needs matplotlib: pip install 'pyhysteron[plot]'") from _missing

from ._loops import loops, major_loops
from ._notebook import Picture as Picture
from ._operators import operators, structure
from ._plane import excitation, grid, plane
from ._series import band, dead_band, over_time
from ._weights import weights

__all__ = [
    "band",
    "dead_band",
    "excitation",
    "grid",
    "loops",
    "major_loops",
    "operators",
    "over_time",
    "plane",
    "structure",
    "weights",
]

"""Control loops on a hysteresis model and its inverse.

A `Controller` is an inverse as feedforward, a `Pid`, or both, fixed or adapting. `Controller.run`
follows a reference on a simulated plant (`pyhysteron.SpringPlant`, `pyhysteron.PreisachPlant`) or
on any object with ``read`` and ``write``. `Controller.step` is for a loop of your own. Gains come
from a `RelayTest`, from a step test (`Pid.from_step`), or from a scenario's own test (`tune`).
`pyhysteron.track` compares controllers. Times are in seconds.
"""

from ._hysteron import Action, Controller, Pid, RelayTest, Trace, headings, tune

__all__ = ["Action", "Controller", "Pid", "RelayTest", "Trace", "headings", "tune"]

"""What `Model.plot` and `Recording.plot` show: one figure, at the width of the notebook."""

import io
import re

from matplotlib.figure import Figure

from ._loops import loops, major_loops
from ._series import _time
from ._style import MODELLED, RECORDED, label
from ._weights import weights

#: A recording of more samples is drawn as pixels, so that the notebook stays small.
_MANY = 20_000


class Picture:
    """A figure that a notebook shows at its own width.

    Attributes
    ----------
    figure : matplotlib.figure.Figure
        To change or to save it.
    """

    def __init__(self, figure):
        self.figure = figure

    def _repr_html_(self) -> str:
        text = io.StringIO()
        self.figure.savefig(text, format="svg")
        svg = text.getvalue()
        head, rest = svg[svg.index("<svg") :].split(">", 1)
        # The figure has its own size; the notebook knows its width.
        head = re.sub(r'\s(width|height)="[^"]*"', "", head)
        return f'{head} style="width: 100%; height: auto">{rest}'


def _model(model, recording):
    if recording is not None:
        return _recording(recording, model)
    figure = Figure(figsize=(12, 5), layout="constrained")
    if model.thermal is not None or model.is_timed:
        weights(model, kind="map", ax=figure.subplots())
    else:
        loop, plane = figure.subplots(1, 2)
        major_loops(model, ax=loop)
        weights(model, kind="map", ax=plane)
    return Picture(figure)


def _recording(recording, model):
    figure = Figure(figsize=(12, 5), layout="constrained")
    axes = figure.subplot_mosaic([["loop", "output"], ["loop", "input"]], width_ratios=[4, 5])
    loops(recording, model, ax=axes["loop"])
    time, when = _time(recording)
    for name in ("output", "input"):
        axes[name].plot(time, getattr(recording, name), **RECORDED)
        axes[name].set_ylabel(label(getattr(recording, f"{name}_name")))
    if model is not None:
        axes["output"].plot(time, model.evaluate(recording).output_model, **MODELLED)
    axes["output"].sharex(axes["input"])
    axes["output"].tick_params(labelbottom=False)
    axes["input"].set_xlabel(when)
    if len(recording) > _MANY:
        for ax in axes.values():
            ax.set_rasterization_zorder(10)
    return Picture(figure)

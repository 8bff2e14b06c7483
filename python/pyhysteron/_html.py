"""Models, recordings and fits as HTML for notebooks: key figures beside small pictures (inline SVG)."""

import re
from html import escape
from typing import Any

import numpy as np

from ._hysteron import Model, Recording, branches, excitation

_BLUE, _ORANGE, _GREY = "#12355b", "#c8501e", "#8a8a8a"
_SIZE = 150  # of a picture, px
#: Cells of a plane's picture along each side at most, and points of a loop's picture.
_CELLS, _POINTS = 24, 800
#: Samples of a recording that a picture of its operators looks at.
_SAMPLES = 100_000
#: Colours of what an input says about an operator: never, once, ambiguous, determined.
_CLASSES = ("#f2f2f2", "#f3c9b0", "#d9904f", _BLUE)
_SIGNS = {"degC": "°C", "degF": "°F", "deg": "°", "um": "µm", "uC/cm2": "µC/cm²"}


def model(model: Model) -> str:
    """Major loop with a minor loop, the weights on the plane, and key figures."""
    low, high = model.active_range if model.spacing is not None else model.range
    rows = [
        ("operator", f"{model.operator}, {model.levels} levels"),
        ("input", f"{_label(model.input)}, {low:.6g} to {high:.6g}"),
        ("output", "{}, {:.6g} to {:.6g}".format(_label(model.output), *sorted(model.output_range))),
    ]
    if model.thermal is not None:
        rows.append(("thermal body", f"{model.thermal.tau_heating:.3g} s heating, {model.thermal.tau_cooling:.3g} s cooling"))
    if model.load_range is not None:
        rows.append(("load", "{}, {:.6g} to {:.6g}".format(_label(model.load_name or "load"), *model.load_range)))
    if model.spacing is not None:
        rows.append(("levels", "close together where the output moves"))
    if model.creep:
        rows.append(("creep", ", ".join(f"{100 * term.coefficient:.3g} % in {term.tau:.3g} s" for term in model.creep)))
    if model.lag:
        rows.append(("lag", f"{model.lag:.3g} s"))
    if model.fit is not None:
        rows += _fit_rows(model.fit)
    # Without stages: the loop of the operators.
    low, high = model.range
    operators = Model(model.weights, model.range, operator=model.operator, offset=model.offset, sign=model.sign)
    step = (high - low) / (model.levels - 1)
    turns = [low - step, high, low - step, low + 0.65 * (high - low), low + 0.3 * (high - low), high]
    input = np.concatenate([np.linspace(a, b, 80) for a, b in zip(turns, turns[1:])])
    seen = input if model.spacing is None else np.interp(input, np.append(low - step, model.plane), model.spacing)
    pictures = [_loop(seen, operators.simulate(input), model.input, model.output), _weights(model)]
    return _page("Model", rows, pictures)


def recording(recording: Recording) -> str:
    """The loops, what the input says about the operators, and key figures."""
    input, output = recording.input, recording.output
    rows = [
        ("samples", f"{len(recording)}, {'simulated' if recording.simulated else 'measured'}"),
        ("input", f"{_label(recording.input_name)}, {input.min():.6g} to {input.max():.6g}"),
        ("output", f"{_label(recording.output_name)}, {output.min():.6g} to {output.max():.6g}"),
        ("branches", f"{branches(input)[-1] + 1}"),
    ]
    time, load = recording.time, recording.load
    if time is not None:
        rows.append(("time", f"{time[0]:.6g} to {time[-1]:.6g} s"))
    if load is not None:
        rows.append(("load", f"{_label(recording.load_name)}, {load.min():.6g} to {load.max():.6g}"))
    if recording.path is not None:
        rows.append(("file", recording.path.name))
    pictures = [_loop(input, output, recording.input_name, recording.output_name)]
    if input.min() < input.max():
        pictures.append(_excitation(recording))
    return _page("Recording", rows, pictures)


def fit(fit: Any) -> str:
    """Key figures of a fit, and the candidates of its cross-validation."""
    rows = _fit_rows(fit)
    rows += [("largest error", f"{fit.max_abs:.4g}"), ("weights not zero", f"{fit.weights_not_zero}")]
    rows += [("solver", f"{fit.solver}, smooth {fit.smooth.along:g} along, {fit.smooth.across:g} across, start {fit.start}")]
    if fit.open_at_start:
        rows.append(("unknown at the start", f"{fit.open_at_start} operators"))
    if fit.file:
        rows.append(("file", fit.file))
    pictures = []
    if fit.validation is not None:
        rows.append(("cross-validation", f"{fit.validation.nrmse_percent:.3g} % of the range"))
        pictures.append(_candidates(fit.validation.scores))
    return _page("Fit", rows, pictures)


def _fit_rows(fit: Any) -> list[tuple[str, str]]:
    source = ", simulated" if fit.simulated else ""
    return [
        ("fitted", f"{fit.samples} samples{source}"),
        ("RMSE", f"{fit.rmse:.4g} = {fit.nrmse_percent:.3g} % of the range"),
    ]


def _page(title: str, rows: list[tuple[str, str]], pictures: list[str]) -> str:
    cell = '<td style="text-align:left;padding:1px 6px">'
    table = "".join(f"<tr>{cell}<b>{escape(name)}</b></td>{cell}{escape(value)}</td></tr>" for name, value in rows)
    return (
        '<div style="display:flex;flex-wrap:wrap;gap:14px;align-items:center">'
        f'<table style="font-size:90%"><caption style="text-align:left"><b>{title}</b></caption><tbody>{table}</tbody></table>'
        f"{''.join(pictures)}</div>"
    )


def _svg(title: str, x: str, y: str, body: str) -> str:
    middle, end = 18 + _SIZE / 2, _SIZE + 36
    text = 'font-size="10" font-family="sans-serif" fill="currentColor" text-anchor="middle"'
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{end}" height="{end}" viewBox="0 0 {end} {end}" role="img">'
        f"<title>{escape(title)}</title>"
        f'<rect x="17.5" y="9.5" width="{_SIZE + 1}" height="{_SIZE + 1}" fill="none" stroke="{_GREY}"/>'
        f'<text x="{middle}" y="{_SIZE + 26}" {text}>{escape(x)}</text>'
        f'<text x="11" y="{middle - 8}" {text} transform="rotate(-90 11 {middle - 8})">{escape(y)}</text>'
        f'<g transform="translate(18 10)">{body}</g></svg>'
    )


def _scaled(values: Any) -> Any:
    """From 3 % to 97 % of the picture."""
    low, high = float(np.min(values)), float(np.max(values))
    # Halves: the range of finite numbers may be infinite.
    span = high / 2 - low / 2
    share = (values / 2 - low / 2) / span if span > 0 else np.full(len(values), 0.5)
    return _SIZE * (0.03 + 0.94 * share)


def _loop(input: Any, output: Any, input_name: str, output_name: str) -> str:
    kept = np.unique(np.linspace(0, len(input) - 1, _POINTS).astype(int))
    x, y = _scaled(input)[kept], _SIZE - _scaled(output)[kept]
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y))
    line = f'<polyline points="{points}" fill="none" stroke="{_BLUE}" stroke-width="1"/>'
    return _svg("output over input", _label(input_name), _label(output_name), line)


def _plane(title: str, colours: list[list[tuple[str, float] | None]], unit: str) -> str:
    """Cells `[i][j]`: α (off) to the right, β (on) upwards, nothing where α > β."""
    side = _SIZE / len(colours)
    cells = []
    for i, row in enumerate(colours):
        for j, cell in enumerate(row):
            if cell is not None and cell[1] > 0:
                colour, opacity = cell
                cells.append(
                    f'<rect x="{i * side:.2f}" y="{_SIZE - (j + 1) * side:.2f}" width="{side:.2f}" height="{side:.2f}" '
                    f'fill="{colour}" fill-opacity="{opacity:.2f}"/>'
                )
    return _svg(title, f"α{unit}", f"β{unit}", "".join(cells))


def _weights(model: Model) -> str:
    # Neighbours are added up where there are too many for the picture.
    mu = np.nan_to_num(model.weights)
    count = min(model.levels, _CELLS)
    place = np.arange(model.levels) * count // model.levels
    sums = np.zeros((count, count))
    np.add.at(sums, (place[:, None], place[None, :]), mu)
    largest = np.abs(sums).max() or 1.0
    colours = [
        [(_BLUE if sums[i, j] >= 0 else _ORANGE, abs(sums[i, j]) / largest) if i <= j else None for j in range(count)]
        for i in range(count)
    ]
    return _plane("weights on the plane: blue above zero, orange below", colours, _unit(model.input))


def _excitation(recording: Recording) -> str:
    levels = 12
    low, high = recording.summary(levels=levels).plane
    found = excitation(_thinned(recording.input), (low, high), levels)
    colours = [[(_CLASSES[int(found[i, j])], 1.0) if i <= j else None for j in range(levels)] for i in range(levels)]
    return _plane("operators: light never moved, blue determined", colours, _unit(recording.input_name))


def _thinned(input: Any) -> Any:
    """The turning points, and of a long input only some samples between them."""
    if len(input) <= _SAMPLES:
        return input
    turns = np.flatnonzero(np.diff(branches(input)))
    between = np.linspace(0, len(input) - 1, _SAMPLES).astype(int)
    return input[np.union1d(turns, between)]


def _candidates(scores: Any) -> str:
    """Error over levels, a dot for each candidate."""
    x, y = (_scaled(np.array(values, float)) for values in ([s.levels for s in scores], [s.rmse for s in scores]))
    dots = "".join(f'<circle cx="{a:.1f}" cy="{_SIZE - b:.1f}" r="2.5" fill="{_BLUE}"/>' for a, b in zip(x, y))
    return _svg("error of each candidate", "levels", "error left out", dots)


def _label(name: str) -> str:
    """`temperature [degC]` with the signs of the units."""
    return re.sub(r"\[(.*)\]$", lambda found: f"[{_SIGNS.get(found[1], found[1])}]", name)


def _unit(name: str) -> str:
    found = re.search(r"\s*\[.*\]$", _label(name))
    return found[0] if found else ""

#!/usr/bin/env python3
"""A plain identification to compare with: dense regressor from the definition, and SciPy's NNLS.

Reads one JSON object {"min", "max", "levels", "input", "output", "fold", "test"} from standard
input. `fold` (a number for each sample, or null) tells which samples are left out together. `test`
is the input of another recording, or null.

Prints one JSON object: errors in the output's unit, the squared error at the optimum of a fit of
everything, the seconds that the regressor and that fit took, and with `test` the output predicted
for it. Needs NumPy and SciPy.
"""
import json
import sys
import time

import numpy as np
from scipy.optimize import nnls


def regressor(minimum, maximum, levels, samples):
    """The states of all MKP operators at every sample, from all off, by equation (5)."""
    step = (maximum - minimum) / (levels - 1)
    j, i = np.tril_indices(levels)  # row by row: j = 1…K, i = 1…j
    x = np.clip((np.asarray(samples) - minimum) / step + 1.0, 0.0, levels)
    phi = np.empty((len(x), len(i)))
    gamma = np.zeros(len(i))
    for n, position in enumerate(x):
        ridge = np.clip(position - np.arange(levels), 0.0, 1.0)
        gamma = np.maximum(ridge[j], np.minimum(gamma, ridge[i]))
        phi[n] = gamma
    return phi


def fit(phi, y):
    """Weights from zero on and a free offset, with the better sign of the output."""
    ones = np.ones((len(y), 1))
    matrix = np.hstack([phi, ones, -ones])
    best = None
    for sign in (1.0, -1.0):
        x, norm = nnls(matrix, sign * y, maxiter=30 * matrix.shape[1])
        if best is None or norm < best[0]:
            best = (norm, sign, x)
    _, sign, x = best
    return lambda rows: sign * (rows @ x[:-2] + x[-2] - x[-1])


def main():
    job = json.load(sys.stdin)
    y = np.asarray(job["output"])
    start = time.perf_counter()
    plane = lambda samples: regressor(job["min"], job["max"], job["levels"], samples)
    phi = plane(job["input"])
    built = time.perf_counter()
    model = fit(phi, y)
    done = time.perf_counter()
    result = {
        "squares": float(np.sum((y - model(phi)) ** 2)),
        "seconds_regressor": built - start,
        "seconds_fit": done - built,
    }
    if job.get("test") is not None:
        result["predicted"] = model(plane(job["test"])).tolist()
    if job.get("fold") is not None:
        fold = np.asarray(job["fold"])
        training, predicted = 0.0, np.empty_like(y)
        for f in np.unique(fold):
            inside = fold == f
            model = fit(phi[~inside], y[~inside])
            training += np.sum((y[~inside] - model(phi[~inside])) ** 2)
            predicted[inside] = model(phi[inside])
        count = len(np.unique(fold))
        result["training_rmse"] = float(np.sqrt(training / len(y) / (count - 1)))
        result["left_out_rmse"] = float(np.sqrt(np.mean((y - predicted) ** 2)))
    json.dump(result, sys.stdout)


main()

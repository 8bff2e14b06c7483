"""`pyhysteron.fit` against SciPy's non-negative least squares on the same data, at the same optimum.

    python python/benchmarks/fit.py

SciPy gets the dense regressor: one column for each operator, and two of ones for an offset of either sign. Making it is counted apart.
"""

import warnings

import numpy as np
from scipy.optimize import nnls
from timing import best

import pyhysteron

SAMPLES = 10_000
RANGE = (20.0, 80.0)


def experiment(levels):
    """A material with two hills of density, as shape-memory alloys have, driven over the whole plane, and noise of 1 %."""
    random = np.random.default_rng(1)
    place = np.arange(1, levels + 1) / levels
    alpha, beta = np.meshgrid(place, place, indexing="ij")
    hill = lambda a, b, width: np.exp(-((alpha - a) ** 2 + (beta - b) ** 2) / width**2)
    density = hill(0.3, 0.6, 0.1) + 0.4 * hill(0.5, 0.8, 0.07)
    density[density < 0.01] = 0
    density[np.tril_indices(levels, -1)] = np.nan
    model = pyhysteron.Model(density / levels**2, RANGE, offset=1)
    bottom = RANGE[0] - (RANGE[1] - RANGE[0]) / (levels - 1)
    turns = [bottom]
    for level in model.plane:
        turns += [level, bottom]
    turns += list(random.choice(model.plane, levels))
    path = np.concatenate([[0], np.cumsum(np.abs(np.diff(turns)))])
    input = np.interp(np.linspace(0, path[-1], SAMPLES), path, turns)
    low, high = model.output_range
    return input, model.simulate(input) + 0.01 * (high - low) * random.normal(size=SAMPLES)


def regressor(input, levels):
    count = levels * (levels + 1) // 2
    columns = np.empty((len(input), count + 2))
    for n in range(count):
        columns[:, n] = pyhysteron.Model(np.eye(1, count, n)[0], RANGE).simulate(input)
    columns[:, -2:] = 1, -1
    return columns


def squares(model, input, output):
    return float(np.sum((model.simulate(input) - output) ** 2))


def main():
    warnings.simplefilter("ignore", pyhysteron.HysteronWarning)  # the noise goes against the input, and is meant to
    print(f"{SAMPLES} samples, noise of 1 %, sign given.\n")
    print("| levels | operators | hysteron | regressor | SciPy's nnls | ratio of the solutions | difference of squared errors |")
    print("| ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
    for levels in (10, 20, 40):
        input, output = experiment(levels)
        fit = lambda: pyhysteron.fit(input, output, levels=levels, range=RANGE, sign=1, bootstrap=0)
        ours, model = best(fit, 7)
        making, columns = best(lambda: regressor(input, levels), 1)
        theirs, (_, norm) = best(lambda: nnls(columns, output, maxiter=100 * columns.shape[1]), 3 if levels < 40 else 1)
        difference = (squares(model, input, output) - norm**2) / norm**2
        count = columns.shape[1] - 2
        print(
            f"| {levels} | {count} | {1e3 * ours:.1f} ms | {making:.2f} s | {1e3 * theirs:.1f} ms |"
            f" {theirs / ours:.1f} | {difference:.1e} |"
        )
        # The same convex problem; an error in the weights enters the squares squared.
        assert abs(difference) < 1e-9, "not the same optimum"


if __name__ == "__main__":
    main()

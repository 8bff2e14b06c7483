"""What the benchmarks measure with."""

import time


def best(work, times):
    """Seconds of the best of a few, and what it gave: what else the machine does only ever adds time."""
    taken = []
    for _ in range(times):
        start = time.perf_counter()
        result = work()
        taken.append(time.perf_counter() - start)
    return min(taken), result

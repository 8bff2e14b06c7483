"""What several tests share and no fixture gives."""

from concurrent.futures import ThreadPoolExecutor

#: A comparison of controllers that is done in some hundredths of a second.
SCENARIO = """
title = "A sine on a simulated piezo-like actuator"
duration_s = 8
interval_s = 0.01
settle_s = 2
seeds = 2
plant = { kind = "preisach", levels = 60 }
model = { levels = 10, range = [8, 150], rates = [200, 200] }
loop = { filter_s = 0.01, tolerance = 0.5 }
controllers = ["pid", "inverse-pid", "adaptive-pid"]
reference = [{ kind = "constant", value = 36 }, { kind = "sine", amplitude = 24, period_s = 2 }]
"""
#: A plant that takes many times as long.
SLOW_SCENARIO = SCENARIO.replace("levels = 60", "levels = 240")


def together(work, threads=4):
    """`work(n)` in each of several threads at once; what one of them raises is raised."""
    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(work, range(threads)))


def lines(ax):
    """The curves of a figure by their names in the legend."""
    return {line.get_label(): line for line in ax.get_lines()}

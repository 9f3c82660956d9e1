"""Damage: gross errors, dense noise and gaps of known size in takes computed from skeletons."""
import statistics

import grids
import scenarios
from tables import cell, number, shares, table

SETS = ("five cuts", "other CMU", "HDM05")


def figure_of(scenario):
    return "rmse_touched" if scenario.startswith("gaps") and "noise" not in scenario else "fd"


def comparison(cells, methods, damages):
    """Every method's mean; bold is the best."""
    rows = []
    for damage, _ in damages:
        means = [grids.values(cells, figure_of(damage), noise=damage, method=m) for m, _ in methods]
        best = min((statistics.mean(v) for v in means if v), default=None)
        rows.append([damage] + [f"**{cell(v)}**" if v and statistics.mean(v) == best else cell(v)
                                for v in means])
    return table(["damage"] + [m for m, _ in methods], rows)


def best_other(cells, damage):
    """The smallest mean of the methods but auto, and which: the damaged take itself counts, too."""
    found = []
    for method, _ in scenarios.METHODS[1:]:
        values = grids.values(cells, figure_of(damage), noise=damage, method=method)
        if values:
            found.append((statistics.mean(values), method))
    return min(found)


def summary(sets, sigma):
    """auto and the best of all others on each set of takes, and how true auto's sigma is.

    sets: [(cells, damages)], the damages of each in one order; sigma: damage -> status -> shares.
    """
    rows = []
    for place, (damage, _) in enumerate(scenarios.SCENARIOS):
        auto, other = [], []
        for cells, damages in sets:
            own = damages[place][0]
            auto.append(cell(grids.values(cells, figure_of(own), noise=own, method="auto")))
            best, which = best_other(cells, own)
            other.append(f"{number(best)} ({which})")
        found = sigma[damage]
        rows.append([damage] + [text for pair in zip(auto, other) for text in pair] +
                    [shares(found[status]) for status in ("kept", "corrected", "filled")])
    head = ["damage"] + [f"{text}: {who}" for text in SETS for who in ("auto", "best other")]
    return table(head + ["within 1 / 2 sigma, %: kept", "corrected", "filled"], rows)


def details(cells):
    rows = [[d] + [cell(grids.values(cells, f, noise=d, method="auto"), spread=True)
                   for f in ("fd", "rmse_touched", "rmse_untouched", "smoothness")]
            for d, _ in scenarios.SCENARIOS]
    return table(["damage", "FD", "RMSE touched", "RMSE untouched", "smoothness error"], rows)

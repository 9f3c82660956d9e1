"""Harm: what is done to takes that are clean, or as noisy as recordings are."""
import statistics

import grids
import scenarios
from tables import number, table

MM = scenarios.UNIT_MM
HEAD = ["recording", "Hz", "input, mm", "best filter, mm", "which", "auto, mm", "auto / best",
        "worst joint, cm: median", "worst", "strikes kept: input", "best filter", "auto"]


def measure(given, takes, noisy):
    """Cells per rate: auto on clean takes; auto and every filter of the grids on the noisy ones."""
    cells = {}
    methods = [("auto", "auto"), ("input", "none")] + given.filters
    for rate in (120, 60, 30):
        thinned = lambda own: [grids.Take(t.file, t.frames, 120 // rate) for t in own]
        noises = [(label, spec) for label, spec, rates in scenarios.RECORDING_NOISES if rate in rates]
        clean = scenarios.CLEAN[:2]
        cells[rate] = grids.cells_of(given, f"harm-clean-{rate}", thinned(takes), [clean], methods[:2], 1,
                                     scenarios.EXTREMITIES)
        cells[rate] += grids.cells_of(given, f"harm-{rate}", thinned(noisy), noises, methods, 1,
                                      scenarios.EXTREMITIES)
    return cells


def figures(cells, method, noise):
    """FD in mm, worst displacements in cm per take, strikes kept; means but for the worst."""
    get = lambda figure: grids.values(cells, figure, noise=noise, method=method)
    fd = get("fd")
    if not fd:
        return None
    return MM * statistics.mean(fd), [MM / 10 * x for x in get("worst")], statistics.mean(get("strikes"))


def compare(given, cells, rate, noise):
    fd, worst, strikes = figures(cells, "auto", noise)
    input_fd, _, input_strikes = figures(cells, "input", noise)
    of_filters = {label: figures(cells, label, noise) for label, _ in given.filters}
    of_filters = {label: found for label, found in of_filters.items() if found}
    best = min(of_filters, key=lambda label: of_filters[label][0], default=None)
    texts = [noise, str(rate), number(input_fd)]
    if best:
        best_fd, _, best_strikes = of_filters[best]
        texts += [number(best_fd), best, number(fd), f"{fd / best_fd:.2f}"]
    else:
        texts += ["-", "-", number(fd), "-"]
    texts += [number(statistics.median(worst)), number(max(worst)), f"{input_strikes:.2f}",
              f"{best_strikes:.2f}" if best else "-", f"{strikes:.2f}"]
    return texts


def rows(given, cells):
    order = [scenarios.CLEAN] + scenarios.RECORDING_NOISES
    return table(HEAD, [compare(given, cells[rate], rate, label)
                        for label, _, rates in order for rate in rates])


def worst_takes(cells, count=8):
    """The takes of the clean rows in which a joint was moved farthest."""
    found = [(MM / 10 * float(c["worst"]), rate, c["take"]) for rate in cells for c in cells[rate]
             if c["noise"] == scenarios.CLEAN[0] and c["method"] == "auto"]
    return table(["take", "Hz", "worst joint, cm"],
                 [[take.split(" thinned")[0], str(rate), number(worst)]
                  for worst, rate, take in sorted(found, reverse=True)[:count]])

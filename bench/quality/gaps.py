"""Gaps: markers of real recordings hidden in five ways, and how far off the fillings are.

Recordings are [frames x 3 markers] in mm, NaN where a marker really was not seen. What is hidden was
seen throughout and for ten frames on either side; 5 % of what is seen, but for the runs of 370 frames.
"""
import concurrent.futures
import dataclasses
import pathlib
import statistics
import tempfile

import numpy as np

import peers
import scenarios
import sigma
from tables import cell, number, shares, table

SHARE, MARGIN, TRIES = 0.05, 10, 100000
PROGRAM = ["auto", "cubic", "completion", "tslra"]
SPEC = {"cubic": "interpolate:kind=cubic"}  # of those that are not named as their specification is


def may_hide(seen, hidden, markers, first, length):
    around = slice(first - MARGIN, first + length + MARGIN)
    return seen[around][:, markers].all() and not hidden[around][:, markers].any()


def draw_first(random, frames, length):
    return random.integers(MARGIN, frames - length - MARGIN)


def hide_single(samples, seen, random, length):
    """One marker at a time."""
    hidden = np.zeros_like(seen)
    for _ in range(TRIES):
        if hidden.sum() >= SHARE * seen.sum():
            break
        marker, first = random.integers(seen.shape[1]), draw_first(random, len(seen), length)
        if may_hide(seen, hidden, [marker], first, length):
            hidden[first:first + length, marker] = True
    return hidden


def spreads(samples, seen):
    """[markers x markers] of how much the distance of two varies; infinite where they are seldom seen
    together, -1 of a marker to itself."""
    points = samples.reshape(len(samples), -1, 3)
    spread = np.full((seen.shape[1], seen.shape[1]), np.inf)
    for a in range(seen.shape[1]):
        for b in range(a):
            both = seen[:, a] & seen[:, b]
            if both.mean() > 0.3:
                spread[a, b] = spread[b, a] = np.linalg.norm(points[both, a] - points[both, b], axis=1).std()
    np.fill_diagonal(spread, -1)
    return spread


def hide_groups(samples, seen, random, length, sizes):
    """Neighbouring markers at once, as many as drawn from sizes."""
    hidden = np.zeros_like(seen)
    nearest = np.argsort(spreads(samples, seen), axis=1)  # the marker itself comes first
    for _ in range(TRIES // 10):
        if hidden.sum() >= SHARE * seen.sum():
            break
        marker, first = random.integers(seen.shape[1]), draw_first(random, len(seen), length)
        group = nearest[marker, :random.choice(sizes)]
        if may_hide(seen, hidden, group, first, length):
            hidden[first:first + length, group] = True
    return hidden


def hide_few_to_five(samples, seen, random, length):
    return hide_groups(samples, seen, random, length, (3, 4, 5))


def hide_limbs(samples, seen, random, length):
    """A fifth of the markers, those at the steadiest distances from one."""
    return hide_groups(samples, seen, random, length, (seen.shape[1] // 5,))


def hide_runs(count):
    """So many markers at once for one run (Kieu et al. 2022, PLoS ONE 17(8))."""
    def hide(samples, seen, random, length):
        hidden = np.zeros_like(seen)
        for _ in range(TRIES if len(seen) >= length + 5 * MARGIN else 0):
            first = draw_first(random, len(seen), length)
            able = [k for k in range(seen.shape[1]) if may_hide(seen, hidden, [k], first, length)]
            if len(able) >= count:
                hidden[first:first + length, random.choice(able, count, replace=False)] = True
                break
        return hidden
    return hide


def rmse(error):
    return float(np.sqrt(np.mean(error**2)))


def mean_absolute(error):
    return float(np.mean(np.abs(error)))


@dataclasses.dataclass(frozen=True)
class Protocol:
    label: str
    hide: object
    length: int
    methods: tuple
    error: object = rmse


ALL = ("auto", "cubic", "local ridge", "PCA", "completion", "tslra")
PROTOCOLS = [
    Protocol("one marker, 60 frames", hide_single, 60, ALL),
    Protocol("one marker, 120 frames", hide_single, 120, ALL[:4]),
    Protocol("3 to 5 neighbours, 60 frames", hide_few_to_five, 60, ALL[:4]),
    Protocol("3 to 5 neighbours, 120 frames", hide_few_to_five, 120, ALL[:4]),
    Protocol("a limb, 60 frames", hide_limbs, 60, ALL[:4]),
] + [Protocol(f"{n} markers, 370 frames (MAE)", hide_runs(n), 370, ALL[:4], mean_absolute)
     for n in (3, 6, 9)]


@dataclasses.dataclass
class Trial:
    """A recording with what one protocol and seed hides, and what became of it."""
    recording: str
    protocol: Protocol
    samples: np.ndarray
    hidden: np.ndarray
    filled: dict = dataclasses.field(default_factory=dict)
    sigma: np.ndarray = None

    @property
    def gappy(self):
        return np.where(self.hidden, np.nan, self.samples)

    def difference(self, method):
        """Of all hidden samples; NaN where the method leaves them missing."""
        return (self.filled[method] - self.samples)[self.hidden]

    def error(self, method):
        """Of the hidden samples that the method fills."""
        difference = self.difference(method)
        return difference[np.isfinite(difference)]


def trials_of(recording, samples, seeds, protocols):
    seen = ~np.isnan(samples).reshape(len(samples), -1, 3).any(2)
    trials = []
    for protocol in protocols:
        for seed in range(1, seeds + 1):
            hidden = protocol.hide(samples, seen, np.random.default_rng(seed), protocol.length)
            if hidden.any():
                trials.append(Trial(recording, protocol, samples, np.repeat(hidden, 3, axis=1)))
    return trials


def run_program(given, trials, method, rate):
    """Fills the gaps of trials on one recording by one call of the program."""
    if not trials:
        return
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for i, trial in enumerate(trials):
            np.save(folder / f"{i}.npy", trial.gappy)
        sources = [folder / f"{i}.npy" for i in range(len(trials))]
        more = ["--sigma"] if method == "auto" else []
        found = sigma.denoise(given.moclean, sources, folder, rate, SPEC.get(method, method), *more)
        for i, trial in enumerate(trials):
            trial.filled[method] = found[0][str(i)]
            if more:
                trial.sigma = found[1][str(i)]


def measure(given, protocols=tuple(PROTOCOLS)):
    trials = []
    for recording, rate in given.markers.items():
        samples = np.load(given.data / f"markers/{recording}.npy")[:given.marker_frames].astype(float)
        own = trials_of(recording, samples, given.seeds, protocols)
        for method in PROGRAM:
            run_program(given, [t for t in own if method in t.protocol.methods], method, rate)
        with concurrent.futures.ProcessPoolExecutor() as pool:
            for method in peers.PEERS:
                filled = pool.map(peers.fill, [method] * len(own), [t.gappy for t in own],
                                  [t.hidden for t in own])
                for trial, result in zip(own, filled):
                    trial.filled[method] = result
        trials += own
    return trials


def errors(trials, protocol, method, recording):
    """The protocol's figure of one recording per seed, of what the method fills."""
    return [protocol.error(t.error(method)) for t in trials
            if t.protocol is protocol and t.recording == recording and method in t.filled
            and t.error(method).size]


def truth_of_sigma(trials):
    """Of auto: the farthest coordinate, share left missing, shares within sigma, most sigmas off."""
    difference = np.concatenate([t.difference("auto") for t in trials])
    stated = np.concatenate([t.sigma[t.hidden] for t in trials])
    ratio = np.abs(difference) / np.maximum(stated, 1e-300)
    return [number(np.nanmax(np.abs(difference))), f"{100 * np.isnan(difference).mean():.0f}",
            shares(sigma.within(difference, stated)), number(np.nanmax(ratio))]


def summary(trials):
    """Median over recordings of their means over seeds, and how true auto's sigma is."""
    rows = []
    for protocol in PROTOCOLS:
        own = [t for t in trials if t.protocol is protocol]
        if not own:
            continue
        names = sorted({t.recording for t in own})
        texts = []
        for method in ALL:
            means = [statistics.mean(e) for n in names if (e := errors(own, protocol, method, n))]
            texts.append(number(statistics.median(means)) if len(means) == len(names) else "-")
        rows.append([protocol.label, str(len(names))] + texts + truth_of_sigma(own))
    return table(["hidden", "recordings", *ALL, "auto: farthest off", "left missing, %",
                  "within 1 / 2 sigma, %", "most sigmas off"], rows)


def recordings(trials):
    """One row per recording and protocol."""
    rows = []
    for protocol in PROTOCOLS:
        for name in sorted({t.recording for t in trials if t.protocol is protocol}):
            rows.append([protocol.label, name] + [cell(errors(trials, protocol, m, name)) for m in ALL])
    return table(["hidden", "recording", *ALL], rows)


def left_alone(trials):
    """How much of what was seen is changed beside single gaps of 60 frames."""
    rows = []
    for name in sorted({t.recording for t in trials}):
        for method in ("auto", "completion", "tslra"):
            own = [t for t in trials if t.protocol is PROTOCOLS[0] and t.recording == name]
            seen = ~np.isnan(own[0].samples)
            change = [rmse((t.filled[method] - t.samples)[seen & ~t.hidden]) for t in own]
            wrong = [rmse(t.error(method)) for t in own]
            rows.append([name, method, f"{statistics.mean(wrong):.2f}", f"{statistics.mean(change):.2f}"])
    return table(["recording", "method", "hidden, RMSE mm", "left, RMS of change mm"], rows)

"""Fillings of gaps that others use, in NumPy: what auto is compared with on real markers.

A recording is [frames x 3 markers] with NaN where a marker is not seen. Gaps that a peer cannot fill
are left to straight lines.
"""
import numpy as np


def gaps_of(seen):
    """(marker, first, last) of every gap, last excluded; seen is [frames x markers]."""
    edges = np.diff(np.pad(~seen, ((1, 1), (0, 0))).astype(int), axis=0)
    return [(j, a, b) for j in range(seen.shape[1])
            for a, b in zip(np.where(edges[:, j] == 1)[0], np.where(edges[:, j] == -1)[0])]


def straight_lines(samples):
    filled = samples.copy()
    frames = np.arange(len(samples))
    for column in filled.T:
        known = ~np.isnan(column)
        if known.any():
            column[:] = np.interp(frames, frames[known], column[known])
    return filled


def with_gaps_filled(samples, wanted, fill):
    """Fills the gaps that begin where `wanted` [frames x 3 markers] is true, all others by lines.
    fill(points, seen, marker, first, last) gives [last - first x 3], or None where it cannot."""
    points = samples.reshape(len(samples), -1, 3)
    seen = ~np.isnan(points).any(2)
    filled = straight_lines(samples).reshape(points.shape)
    for marker, first, last in gaps_of(seen):
        if not wanted[first, 3 * marker]:
            continue
        found = fill(points, seen, marker, first, last)
        if found is not None:
            filled[first:last, marker] = found
    return filled.reshape(samples.shape)


def local_frames(points, reference, weights):
    """Rotations [frames x 3 x 3] and centres that take points [frames x k x 3] onto the reference
    (weighted Procrustes; Kabsch 1976)."""
    weights = weights / weights.sum()
    centre = weights @ points
    base = weights[:, None] * (reference - weights @ reference)
    u, _, v = np.linalg.svd((points - centre[:, None]).transpose(0, 2, 1) @ base)
    u[:, :, 2] *= np.sign(np.linalg.det(u @ v))[:, None]
    return u @ v, centre


def local_ridge(points, seen, marker, first, last, steadiest=4, ridge=1e-4, least=60):
    """The marker in the local frame of the four markers at the steadiest distances from it, by ridge
    regression on all markers seen in the gap; what it is off by at the ends fades linearly."""
    frames = len(points)
    around = slice(max(first - 1, 0), min(last + 1, frames))
    both = seen & seen[:, [marker]]
    others = [k for k in range(points.shape[1])
              if k != marker and seen[around, k].all() and both[:, k].mean() > 0.3]
    if len(others) < steadiest:
        return None
    spread = {k: np.linalg.norm(points[both[:, k], k] - points[both[:, k], marker], axis=1).std() + 1e-3
              for k in others}
    others.sort(key=spread.get)
    near = others[:steadiest]
    train = seen[:, marker] & seen[:, near].all(1)
    if not train.any():
        return None
    features = [k for k in others if seen[train, k].mean() > 0.6]
    train &= seen[:, features].all(1)
    if train.sum() < least:
        return None
    used = np.concatenate([np.where(train)[0], np.arange(around.start, around.stop)])
    rotation, centre = local_frames(points[used][:, near], points[used[0]][near],
                                    1 / np.array([spread[k] for k in near]))
    x = ((points[used][:, features] - centre[:, None]) @ rotation).reshape(len(used), -1)
    y = np.einsum("fi,fij->fj", points[used, marker] - centre, rotation)
    known = np.arange(len(used)) < train.sum()
    x_mean, y_mean = x[known].mean(0), y[known].mean(0)
    gram = (x[known] - x_mean).T @ (x[known] - x_mean)
    gram[np.diag_indices(len(gram))] += ridge * np.trace(gram) / len(gram)
    weights = np.linalg.solve(gram, (x[known] - x_mean).T @ (y[known] - y_mean))
    local_guess = (x[~known] - x_mean) @ weights + y_mean
    guess = np.einsum("fj,fij->fi", local_guess, rotation[~known]) + centre[~known]
    return without_steps(guess, points[around, marker], first - around.start, last - around.start)


def without_steps(guess, truth, first, last):
    """guess[first:last] plus a line between what it is off by beside the gap."""
    ends = [truth[e] - guess[e] for e in (first - 1, last) if 0 <= e < len(guess)]
    ends = [e for e in ends if np.isfinite(e).all()]
    if not ends:
        return guess[first:last]
    share = ((np.arange(first, last) - first + 1) / (last - first + 1))[:, None]
    return guess[first:last] + (1 - share) * ends[0] + share * ends[-1]


def principal_components(points, seen, marker, first, last, scale=200, own=0.02, held=0.999):
    """After Gloersen and Federolf (2016): principal components of the frames in which every marker is
    seen, relative to the mean of the markers seen in the gap; markers weigh exp(-d^2 / (2 scale^2)) by
    their mean distance d (mm), the missing one `own`. As many components as hold that share of the
    variance; scores by least squares from the markers that are seen, ends as for local_ridge()."""
    frames = len(points)
    around = slice(max(first - 1, 0), min(last + 1, frames))
    others = [k for k in range(points.shape[1]) if k != marker and seen[around, k].all()]
    train = seen[:, others + [marker]].all(1) if others else np.zeros(frames, bool)
    if len(others) < 4 or train.sum() < 10:
        return None
    centre = points[:, others].mean(1, keepdims=True)
    moving = (points - centre)[:, others + [marker]]
    distance = np.linalg.norm(moving[train][:, :-1] - moving[train][:, -1:], axis=2).mean(0)
    weights = np.append(np.exp(-distance**2 / (2 * scale**2)), own)
    mean = moving[train].mean(0)
    weighted = ((moving - mean) * weights[:, None]).reshape(frames, -1)
    variance, axes = np.linalg.eigh(weighted[train].T @ weighted[train])
    variance, axes = variance[::-1], axes[:, ::-1]
    axes = axes[:, :1 + int(np.searchsorted(np.cumsum(variance) / variance.sum(), held))]
    scores = np.linalg.lstsq(axes[:-3], weighted[around, :-3].T, rcond=None)[0]
    guess = (axes[-3:] @ scores).T / own + mean[-1] + centre[around, 0]
    return without_steps(guess, points[around, marker], first - around.start, last - around.start)


PEERS = {"local ridge": local_ridge, "PCA": principal_components}


def fill(name, samples, wanted):
    return with_gaps_filled(samples, wanted, PEERS[name])

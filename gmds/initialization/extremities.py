"""Starts from extremities: heads, hands and tails are far from everything else on any member of a class."""

from __future__ import annotations

import itertools

import numpy as np

from geodesics.arrays import Floats, Integers
from geodesics.euclidean import euclidean_distances
from gmds.spectral.functional_maps import nearest_rows
from gmds.spectral.sample_maps import SampledPair
from gmds.surface.view import View

MOST = 7  # extremities of a surface: a bound, 7! assignments are still quick to score
BEST = 32  # assignments kept; set by hand
RINGS = 3  # around a local maximum in which nothing is farther; set by hand
LEAST_GAP = 0.3  # between extremities, of the largest distance from the centre; set by hand

# Limbs are as many extremities whose mean squared distance to the rest is so many times that of the mean vertex: the
# fourth of people, animals and hands of development pairs is at 2.4 and more, that of teeth, faces, brains and bones at
# 2.1 and less (benchmarks/results/notes.md, "Shapes without limbs").
LIMBS = 4
STANDS_OUT = 2.25


def extremities(pair: SampledPair) -> list[Integers]:
    """Sample maps by trilateration from assigned extremities, for the 32 assignments that distort distances least.

    Extremities are vertices farther from all others than those around them: heads, hands, tails.

    Parameters
    ----------
    pair : SampledPair
        Both surfaces in one metric, p samples of the source and q of the target.

    Returns
    -------
    list of int64 arrays of shape (p,)
        Indices into the samples of the target; none where a surface has fewer than three extremities.

    See Also
    --------
    eigenfunction_signs : The other start that needs nothing but the two surfaces.
    """
    ours, theirs = surface_extremities(pair.source), surface_extremities(pair.target)
    if min(len(ours), len(theirs)) < 3:
        return []
    here, there = _distances(pair.source, ours, ours), _distances(pair.target, theirs, theirs)
    if len(ours) <= len(theirs):
        assigned = [(ours, theirs[list(a)]) for a in _assignments(here, there)]
    else:
        assigned = [(ours[list(a)], theirs) for a in _assignments(there, here)]
    return [trilaterated(pair, *both) for both in assigned]


def trilaterated(pair: SampledPair, ours: Integers, theirs: Integers) -> Integers:
    """Each sample goes where its distances to the vertices `ours` (l,) are those to `theirs` (l,) on the target."""
    queries = _distances(pair.source, pair.source_samples, ours)
    return nearest_rows(queries, _distances(pair.target, pair.target_samples, theirs))


def has_limbs(view: View) -> bool:
    """Whether four extremities or more stand out from the surface: heads and legs do, the cusps of a tooth do not."""
    far, mass = (view.commute_time_embedding**2).sum(axis=1), view.spectrum.mass
    tips = far[surface_extremities(view)] * mass.sum()
    return bool((tips > STANDS_OUT * (mass @ far)).sum() >= LIMBS)


def surface_extremities(view: View) -> Integers:
    """Vertices farther from all others, in mean squared commute-time distance, than those around them; at most seven.

    As the embedding is centred, the mean squared distance from x is |e(x)|^2 and a constant.
    """
    embedding = view.commute_time_embedding
    far = (embedding**2).sum(axis=1)
    highest, faces = far.copy(), view.mesh.faces
    for _ in range(RINGS):
        around = highest[faces].max(axis=1)
        for k in range(3):
            np.maximum.at(highest, faces[:, k], around)
    peaks = view.usable[far[view.usable] >= highest[view.usable]]
    peaks = peaks[np.argsort(-far[peaks], kind="stable")]
    kept: list[int] = []
    for peak in peaks:
        gaps = np.linalg.norm(embedding[kept] - embedding[peak], axis=1)
        if (gaps > LEAST_GAP * np.sqrt(far[peaks[0]])).all():
            kept.append(int(peak))
    return np.array(kept[:MOST], dtype=np.int64)


def _distances(view: View, ours: Integers, theirs: Integers) -> Floats:
    """Commute-time distances (p, q) between vertices (p,) and (q,) of a view."""
    embedding = view.commute_time_embedding
    return euclidean_distances(embedding[ours], embedding[theirs])


def _assignments(few: Floats, many: Floats) -> Integers:
    """The 32 injective assignments (32, l) of l points to more whose mutual distances agree best."""
    all_of_them = np.array(list(itertools.permutations(range(len(many)), len(few))))
    i, j = np.triu_indices(len(few), 1)
    misfit = np.abs(few[i, j] - many[all_of_them[:, i], all_of_them[:, j]]).mean(axis=1)
    return all_of_them[np.argsort(misfit, kind="stable")[:BEST]]

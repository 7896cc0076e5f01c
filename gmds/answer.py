"""From the maps that were embedded to a Correspondence: which rows count, how far to trust it, what else there is."""

from __future__ import annotations

import platform
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from geodesics import SurfacePoints
from geodesics.euclidean import euclidean_distances
from gmds import __version__
from gmds.candidates import FUNCTIONS, Embedded, SurfacePair
from gmds.correspondence import Candidate, Correspondence, MatchStatus
from gmds.surface import Surface

Array = NDArray[np.float64]

POOR = 0.12  # relative stress above which distances count as badly kept
BENT = 0.35  # correlation of curvature below which they do as well
CLOSE = 0.3  # difference of log-likelihood, a residual, below which another map is as good
DIFFERENT = 0.1  # mean distance between the images of two maps, over root area, that makes them two answers
JUDGES = 100  # samples that distortion is measured against


def answer(pair: SurfacePair, placed: Sequence[Embedded], meta: Mapping[str, Any]) -> Correspondence:
    """The best map as a `Correspondence` between the original meshes, the others as its candidates."""
    source, target = pair.source, pair.target
    best = placed[0]
    valid = source.regular.spectrum.mass > 0
    candidates = tuple(
        Candidate(_original(source, target, h), h.evidence.stress, h.evidence.orientation) for h in placed[1:]
    )
    return Correspondence(
        source=source.original,
        target=target.original,
        points=_original(source, target, best),
        valid=valid,
        distortion=_distortion(source, best),
        status=_status(placed, pair.sense),
        candidates=candidates,
        meta={**meta, "evidence": vars(best.evidence), "solver": best.solution.status.name, "versions": _versions()},
    )


def _versions() -> dict[str, str]:
    """What computed the numbers."""
    numeric = {name: version(name) for name in ("numpy", "scipy", "numba")}
    return {"gmds": __version__, "python": platform.python_version(), **numeric}


def _original(source: Surface, target: Surface, hypothesis: Embedded) -> SurfacePoints:
    """The points on the original target; vertices that were left out go where the nearest one that was not went."""
    points = hypothesis.points
    used = source.regular.usable
    row = np.arange(source.mesh.n_vertices)
    if len(used) < len(row):
        row = used[cKDTree(source.mesh.vertices[used]).query(source.mesh.vertices)[1]]
    face, weight = target.face_index[points.face[row]], points.barycentric[row]
    corners, turned = target.original.faces[face], target.mesh.faces[points.face[row]]
    swapped = (corners != turned).any(axis=1, keepdims=True)  # a turned face keeps its first corner
    return SurfacePoints(target.original, face, np.where(swapped, weight[:, [0, 2, 1]], weight))


def _distortion(source: Surface, hypothesis: Embedded) -> Array:
    """Mean |d_S - d_Q| (n,) from each vertex to the samples, over the mean d_S; 1 where there is no map."""
    ours, theirs = hypothesis.views
    k = min(FUNCTIONS, ours.functions.shape[1], theirs.functions.shape[1])
    judges = ours.samples(JUDGES)
    here, there = ours.distance(k).embedding, hypothesis.points.interpolate(theirs.distance(k).embedding)
    d_source, d_target = (euclidean_distances(rows, rows[judges]) for rows in (here, there))
    result = np.abs(d_source - d_target).mean(axis=1) / d_source[ours.usable].mean()
    result[ours.spectrum.mass == 0] = 1.0
    return result


def _status(placed: Sequence[Embedded], sense: int) -> MatchStatus:
    """POOR where distances or curvature are badly kept, AMBIGUOUS where a quite different map is nearly as good."""
    best = placed[0].evidence
    if best.stress > POOR or best.curvature < BENT:
        return MatchStatus.POOR
    for other in placed[1:]:
        close = other.evidence.loss(sense) - best.loss(sense) < CLOSE
        if close and _gap(placed[0], other) > DIFFERENT:
            return MatchStatus.AMBIGUOUS
    return MatchStatus.GOOD


def _gap(one: Embedded, other: Embedded) -> float:
    """Mean distance in space between the images of two maps, over the square root of the target's area."""
    mesh = one.views[1].mesh
    return float(np.linalg.norm(mesh.vertices[one.images] - mesh.vertices[other.images], axis=1).mean())

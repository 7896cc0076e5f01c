"""Regions of the source of which a map says itself that it is probably wrong there."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from geodesics.arrays import Bools, Floats, Integers
from geodesics.mesh import Mesh
from geodesics.one_ring import one_ring_areas
from geodesics.topology.edges import edges

DOUBT = 0.5  # confidence below which the point is more likely wrong than right
LEAST_SHARE = 0.02  # of the area of the source, of a region that is named; set by hand


class DoubtfulRegion(NamedTuple):
    """A connected region: its `share` of the area, mean `confidence`, and the vertex in its midst (`center`)."""

    center: int
    share: float
    confidence: float
    vertices: Integers

    def __repr__(self) -> str:
        how_sure = f"share={self.share:.3f}, confidence={self.confidence:.2f}"
        return f"DoubtfulRegion(center={self.center}, {how_sure}, {len(self.vertices)} vertices)"

    def as_data(self) -> dict[str, float]:
        """As JSON has it, without the vertices."""
        return {"vertex": self.center, "share": self.share, "confidence": self.confidence}


def doubtful_regions(source: Mesh, confidence: Floats, valid: Bools) -> list[DoubtfulRegion]:
    """The regions, the largest first, where vertices are `valid` and have a confidence below `DOUBT`.

    Parameters
    ----------
    source : Mesh
        With n vertices.
    confidence : float64 array of shape (n,)
        Of the map at each vertex; where it is NaN nobody rated it and there is no doubt.
    valid : bool array of shape (n,)
        Where the map says that there is a counterpart.

    Returns
    -------
    list of DoubtfulRegion
        Regions of less than `LEAST_SHARE` of the area are left out.
    """
    doubtful = valid & (confidence < DOUBT)
    areas = one_ring_areas(source)
    if not doubtful.any() or areas.sum() <= 0:
        return []
    a, b = edges(source).ends.T
    kept = doubtful[a] & doubtful[b]
    n = source.n_vertices
    graph = sp.coo_matrix((np.ones(kept.sum()), (a[kept], b[kept])), shape=(n, n))
    _, labels = connected_components(graph, directed=False)
    shares = np.bincount(labels, np.where(doubtful, areas, 0.0)) / areas.sum()
    found = [
        _region(source, np.flatnonzero((labels == label) & doubtful), areas, confidence, float(shares[label]))
        for label in np.flatnonzero(shares >= LEAST_SHARE)
    ]
    return sorted(found, key=lambda one: (-one.share, one.center))


def _region(source: Mesh, rows: Integers, areas: Floats, confidence: Floats, share: float) -> DoubtfulRegion:
    weights = areas[rows] / areas[rows].sum()
    middle = weights @ source.vertices[rows]
    center = rows[np.linalg.norm(source.vertices[rows] - middle, axis=1).argmin()]
    return DoubtfulRegion(int(center), share, float(weights @ confidence[rows]), rows)

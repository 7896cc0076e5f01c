"""Where a surface touches itself: what a map has put on the other sheet is taken back.

A hand on a thigh, or on the other hand, is closer in space to what it touches than registration tells apart, and some
of it is sent there. Such a part is an island: wherever it begins, neighbours go to places that are near in space, but
far apart along the target. It is smaller than the rest, which is continuous and therefore right.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from geodesics import SurfacePoints
from geodesics.arrays import Bools, Floats, Integers
from geodesics.caching import memoized
from geodesics.threads import threads
from geodesics.topology.edge_paths import distances_to_nearest, edge_distances
from geodesics.topology.edges import components, edges
from gmds.registration.deformable import DeformableMesh

# Root areas along the target between the images of neighbours, and mean edges of it, beyond which they are on two
# sheets: of 48 maps of FAUST for development neighbours are 0.19 apart at the most, or 0.97 at the least
# (benchmarks/results/notes.md, "Contacts"). Share of the area that an island has at the most (there 0.002), and what is
# not one at the least; set by hand.
JUMP = 0.4
EDGES = 5
MOST = 0.1
LEAST_REST = 0.5
RINGS = 3  # around an image, where nothing is far: a bound, so that few paths are looked for
WALKS = 4_000_000  # of as many edges, from what is looked up at a time: 40 MB at the most; a bound, so that memory is
BLOCK = 256  # starts of paths at a time: a bound, so that memory is
PAIRS = 2_000_000  # of an island and what is near its rim, at a time: 100 MB; a bound as well
# How much longer a path on the target may be than that on the source, and root areas that come on top; set by hand.
STRETCH = 1.5
ROOM = 0.03


def taken_back(source: DeformableMesh, target: DeformableMesh, y: Floats, points: SurfacePoints) -> SurfacePoints:
    """The points (n,) of a source that lies at y (n, 3), those of islands moved to the sheet of their surroundings.

    A vertex of an island goes to the closest point, in position and normal, among what is no farther from the images of
    the rim of the island, along the target, than the vertex is from that rim, but for some stretch.
    """
    images = points.nearest_vertices()
    ends = edges(source.mesh).ends
    lost = islands(source, ends[~jumps(target, images[ends])])
    if not lost.any():
        return points
    rows, goals = source.moved_features(y), images.copy()
    for island in _connected(lost, ends):
        inside = np.isin(ends, island)
        rim = np.unique(ends[inside.any(axis=1) & ~inside.all(axis=1)])
        rim = rim[~lost[rim]]
        if len(rim):
            goals[island] = _among_near(source, target, island, rim, rows[island], images[rim])
    moved = np.flatnonzero(goals != images)
    found = target.closest(rows[moved], target.features, goals[moved])
    face, weights = points.face.copy(), points.barycentric.copy()
    face[moved], weights[moved] = found.face, found.barycentric
    return SurfacePoints(points.mesh, face, weights)


def on_the_sheets_of(images: Integers, coarse: DeformableMesh, found: Integers, fine: DeformableMesh) -> Integers:
    """Vertices (n,) `found` on a fine copy of a surface, near the `images` (n,) on a coarse one and on the same sheet.

    Those on another sheet are replaced by what is closest, in position and normal, to the image itself.
    """
    asked, row = np.unique(found, return_inverse=True)
    label = coarse.usable[coarse.tree.query(fine.features[asked], workers=threads())[1]]
    pairs, of_pair = np.unique(np.stack([images, label[row]], axis=1), axis=0, return_inverse=True)
    lost = jumps(coarse, pairs)[of_pair.ravel()]
    if not lost.any():
        return found
    goal = fine.usable[fine.tree.query(coarse.features[images[lost]])[1]]
    result = found.copy()
    result[lost] = goal
    return result


def jumps(target: DeformableMesh, images: Integers) -> Bools:
    """Whether vertices of the target, in pairs (e, 2), are far apart along it."""
    far = np.flatnonzero(~within_rings(target, images))
    result = np.zeros(len(images), dtype=np.bool_)
    if len(far):
        ends = edges(target.mesh).ends
        length = float(np.linalg.norm(np.subtract(*target.mesh.vertices[ends.T]), axis=1).mean())
        begin, row = np.unique(images[far, 0], return_inverse=True)
        for start in range(0, len(begin), BLOCK):
            distance = edge_distances(target.mesh, begin[start : start + BLOCK], max(JUMP, EDGES * length))
            these = (row >= start) & (row < start + BLOCK)
            result[far[these]] = np.isinf(distance[row[these] - start, images[far[these], 1]])
    return result


def within_rings(mesh: DeformableMesh, pairs: Integers) -> Bools:
    """Whether vertices, in pairs (e, 2), are within `RINGS` edges of each other.

    Looked up in rows of the power of the matrix of steps, some at a time: beside a vertex of 8,000 neighbours all of it
    would take gigabytes.
    """
    steps = _steps(mesh)
    result = np.asarray(steps[pairs[:, 0], pairs[:, 1]], dtype=np.bool_).ravel()
    rest = np.flatnonzero(~result)
    begin, row = np.unique(pairs[rest, 0], return_inverse=True)
    walks = np.ones(mesh.mesh.n_vertices)  # of so many steps from a vertex: no fewer than where they end
    for _ in range(RINGS):
        walks = steps @ walks
    block = (np.cumsum(walks[begin]) // WALKS).astype(np.int64)
    for number in np.unique(block):
        these = np.flatnonzero(block == number)
        rows = steps[begin[these]]
        for _ in range(RINGS - 1):
            rows = rows @ steps
        here = np.flatnonzero((row >= these[0]) & (row <= these[-1]))
        ends = pairs[rest[here], 1]
        result[rest[here]] = np.asarray(rows[row[here] - these[0], ends], dtype=np.bool_).ravel()
    return result


@memoized
def _steps(mesh: DeformableMesh) -> sp.csr_matrix:
    """Which vertices (n, n) are the same, or the ends of an edge."""
    n = mesh.mesh.n_vertices
    ends = edges(mesh.mesh).ends
    steps = sp.coo_matrix((np.ones(len(ends), dtype=np.bool_), ends.T), shape=(n, n)).tocsr()
    return sp.csr_matrix(steps + steps.T + sp.identity(n, dtype=np.bool_, format="csr"))


def islands(source: DeformableMesh, kept: Integers) -> Bools:
    """Vertices (n,) of small parts, connected by the edges that are kept (e, 2), beside one that is most of it."""
    left, right = kept.T
    labels = components(left, right, source.mesh.n_vertices)
    share = np.bincount(labels, source.areas)
    small = (share > 0) & (share < MOST) & (share.max() > LEAST_REST)
    return np.asarray(small[labels] & (source.areas > 0), dtype=np.bool_)


def _connected(inside: Bools, ends: Integers) -> list[Integers]:
    left, right = ends[inside[ends].all(axis=1)].T
    labels = components(left, right, len(inside))
    return [np.flatnonzero(inside & (labels == label)) for label in np.unique(labels[inside])]


def _among_near(
    source: DeformableMesh,
    target: DeformableMesh,
    island: Integers,
    rim: Integers,
    rows: Floats,
    images: Integers,
) -> Integers:
    """Of the vertices of an island, at `rows` (k, 6), the closest on the target (k,) that are as near to the rim."""
    reach = STRETCH * distances_to_nearest(source.mesh, rim)[island] + ROOM
    away = distances_to_nearest(target.mesh, np.unique(images), float(reach.max()))
    near = np.flatnonzero(away <= reach.max())
    found, step = np.empty(len(island), dtype=np.int64), max(1, PAIRS // len(near))
    for start in range(0, len(island), step):
        these = slice(start, start + step)
        gaps = ((rows[these, None] - target.features[near]) ** 2).sum(axis=2)
        found[these] = near[np.where(away[near] <= reach[these, None], gaps, np.inf).argmin(axis=1)]
    return found

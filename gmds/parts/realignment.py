"""Regions laid on the target anew, as stiff as they are: a head that a map has turned round, whose nose is an ear.

No proposal may have a region right that the rest of the likeliest has. Around points spread over the source a region
is laid, by similarities from all sides, on the part of the target that the map sends it to. Where one of them lies
closer than what the map itself makes of the region, and elsewhere, the region is sent where it says, and all of the
source registered anew. Similarities are improved by closest points (Besl and McKay 1992).
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from geodesics import GeodesicDistance, SurfacePoints, embedded, farthest_point_sampling
from geodesics.arrays import Bools, Floats, Integers
from geodesics.threads import both, side_by_side
from geodesics.topology.components import largest_component
from gmds._kernels.alignments import alignment_costs, refined_alignments
from gmds.parts.alignments import MISSING, STEPS, TURN, Similarities
from gmds.parts.boxes import CELLS, box_around
from gmds.registration.deformable import DeformableMesh
from gmds.registration.similarity import nearest_similarity

# Points that regions lie around, shares of the area that they have, and how much larger the part of the target is that
# they are laid on; set by hand.
CENTRES = 24
SHARES = (0.04, 0.08, 0.15)
ROOM = 1.8
SIZES = (0.6, 1.6)  # of a region on the target, times that of the source there: a bound
# Of the root of a region's area: what is as far from the other surface belongs to nothing there, and within what
# closest points are believed; set by hand.
REACH = 0.3
CLOSEST_REACH = 0.45
# Of the cost of where the map itself lays a region, that of another place, at the most; root areas, root mean square,
# between two places: from 0.05 maps of people that were right became worse as often as better
# (benchmarks/results/notes.md, "Recombination", for these two and the reaches).
LEAST_COST = 0.95
APART = 0.1
PLACES = 2  # of a region; set by hand
MOST = 16  # regions that are registered; set by hand
ALL_SIDES = Rotation.create_group("I").as_matrix()  # 60 rotations: none is farther than 45 degrees from one of them
FIRST_STEPS = 3  # of closest points for all of them, the others for the best; set by hand
MOST_REFINED = 12  # of them; set by hand


class Placement(NamedTuple):
    """Vertices (k,) of the source, where they go (k, 3), and the cost as a share of that of the map itself."""

    vertices: Integers
    y: Floats
    cost: float


def realigned(
    source: DeformableMesh, target: DeformableMesh, y: Floats, size: float = 1.0, shares: Sequence[float] = SHARES
) -> list[Floats]:
    """Where vertices go (n, 3) by a map to y (n, 3) and, in one region, by a place that fits it better; best first.

    On the target the source is `size` times as large as it is. Regions have these `shares` of its area.
    """
    places = []
    for laid in laid_anew(source, target, y, size, shares)[:MOST]:
        places.append(y.copy())
        places[-1][laid.vertices] = laid.y
    return places


def laid_anew(
    source: DeformableMesh, target: DeformableMesh, y: Floats, size: float = 1.0, shares: Sequence[float] = SHARES
) -> list[Placement]:
    """Regions with places that fit better than where the map to y (n, 3) sends them, the best first."""
    distance = GeodesicDistance(embedded(source.mesh))
    body = source.usable[np.isin(source.usable, source.mesh.faces[largest_component(source.mesh)])]
    centres = farthest_point_sampling(distance, min(CENTRES, len(body)), int(body[0]))
    images = target.usable[cKDTree(target.mesh.vertices[target.usable]).query(y[centres])[1]]

    def around(distances: tuple[Floats, Floats]) -> list[Placement]:
        found: list[Placement] = []
        here, beyond = distances
        for share in shares:
            one, there = Patch(source, _nearest(source, here, share)), share * size**2
            other = Patch(target, _nearest(target, beyond, ROOM * there))
            middle = target.mesh.vertices[_nearest(target, beyond, there)].mean(axis=0)
            found += _better(one, other, y[one.vertices], middle, size)
        return found

    from_both = both(lambda: _distances(source, centres), lambda: _distances(target, images))
    found = itertools.chain(*side_by_side(around, zip(*from_both, strict=True)))
    return sorted(found, key=lambda laid: laid.cost)


@dataclass(frozen=True, eq=False)
class Patch:
    """A region of a simplified surface as alignments are judged by: its vertices (k,)."""

    mesh: DeformableMesh
    vertices: Integers

    @property
    def places(self) -> Floats:
        """Where its vertices are (k, 3)."""
        return self.mesh.mesh.vertices[self.vertices]

    @property
    def areas(self) -> Floats:
        """Shares (k,) of its area."""
        areas = self.mesh.areas[self.vertices]
        return areas / areas.sum()

    @property
    def size(self) -> float:
        """The root of its area."""
        return float(np.sqrt(self.mesh.areas[self.vertices].sum()))

    def arrays(self) -> tuple[Any, ...]:
        """What the kernels take: points, normals and areas; cells, corner, step; vertices, normals, which are outside.

        What comes nearest to a vertex outside, or on the rim, of the region has nothing there.
        """
        places, normals, box = self.mesh.mesh.vertices, self.mesh.normals, box_around(self.mesh, CELLS)
        ours = self.places, np.ascontiguousarray(normals[self.vertices]), self.areas
        return (*ours, *box, places, np.ascontiguousarray(normals), self._outside())

    def _outside(self) -> Bools:
        """Whether a vertex (n,) of the surface is on a face with one that is not in the region."""
        outside = np.ones(self.mesh.mesh.n_vertices, dtype=bool)
        outside[self.vertices] = False
        faces = self.mesh.mesh.faces
        outside[faces[outside[faces].any(axis=1)]] = True
        return outside


def _better(one: Patch, other: Patch, y: Floats, middle: Floats, size: float) -> Iterator[Placement]:
    """Places of a region on another that cost less than that of the map, which sends its vertices to y (k, 3)."""
    own, there = _fitted(one, y, size), one.size * size
    turned = np.einsum("ab,kbc->kac", own.rotations[0], ALL_SIDES)
    sizes = np.full(len(turned), own.sizes[0])
    shifts = middle - own.sizes[0] * turned @ (one.areas @ one.places)
    begun = [np.concatenate(both) for both in ((own.rotations, turned), (own.sizes, sizes), (own.shifts, shifts))]
    tried, ours, theirs = Similarities(*begun), one.arrays(), other.arrays()
    costs = _refined(tried, ours, theirs, there, size, FIRST_STEPS)
    tried = tried[np.append(0, 1 + np.argsort(costs[1:], kind="stable")[:MOST_REFINED])]
    costs = _refined(tried, ours, theirs, there, size, STEPS - FIRST_STEPS)
    places = tried.moved(one.places)
    kept: list[Floats] = []
    for row in np.argsort(costs, kind="stable"):
        if len(kept) == PLACES or costs[row] >= LEAST_COST * costs[0]:
            return
        if all(_apart(one, places[row], before) > APART for before in [y, *kept]):
            kept.append(places[row])
            yield Placement(one.vertices, places[row], float(costs[row] / costs[0]))


def _refined(
    tried: Similarities, ours: tuple[Any, ...], theirs: tuple[Any, ...], width: float, size: float, steps: int
) -> Floats:
    """The costs (k,) of similarities after so many steps of closest points, in place, of a region of this width."""
    refined_alignments(*tried.arrays, ours, theirs, CLOSEST_REACH * width, steps, SIZES[0] * size, SIZES[1] * size)
    return alignment_costs(*tried.arrays, ours, theirs, REACH * width, TURN, MISSING)


def _fitted(one: Patch, y: Floats, size: float) -> Similarities:
    """The similarity that is closest to the map of a region to y (k, 3)."""
    nearest = nearest_similarity(one.places, y, one.areas)
    sizes = np.clip([nearest.size], SIZES[0] * size, SIZES[1] * size)
    rotations = nearest.rotation[None]
    return Similarities(rotations, sizes, nearest.there - sizes * (rotations @ nearest.here))


def _apart(one: Patch, places: Floats, others: Floats) -> float:
    """Root mean square distance of two places of a region."""
    return float(np.sqrt(one.areas @ ((places - others) ** 2).sum(axis=1)))


def _distances(mesh: DeformableMesh, vertices: Integers) -> Floats:
    """Geodesic distances (k, n) from vertices (k,)."""
    return GeodesicDistance(embedded(mesh.mesh)).field(SurfacePoints.at_vertices(mesh.mesh, vertices))


def _nearest(mesh: DeformableMesh, distances: Floats, share: float) -> Integers:
    """The vertices nearest a point that have this share of the area."""
    order = np.argsort(distances, kind="stable")
    return order[: 1 + int(np.searchsorted(np.cumsum(mesh.areas[order]), share))]

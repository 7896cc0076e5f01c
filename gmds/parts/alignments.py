"""How a surface may lie on another as it is, turned, resized and moved: many similarities, and the best of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from geodesics.arrays import Floats, Integers
from geodesics.caching import cached_property, memoized
from gmds._kernels.alignments import alignment_costs, refined_alignments
from gmds.parts.boxes import CELLS, box_around
from gmds.parts.extremities import near_boundary
from gmds.registration.deformable import DeformableMesh
from gmds.surface.measured import Surface

# Set by hand, but for `REFINED`, `MISSING` and `TURN`, of which others were tried on parts of SHREC'20 animals and were
# no better (benchmarks/results/notes.md, "Parts").
FRAMES = 120  # points of each surface, at most, whose frames are laid on each other
FRAME_RADIUS = 0.12  # root areas around a point over which the direction of its frame is averaged
SAME_SIDE = 0.2  # cosine of normals there, below which a point lies on another sheet
STEP_OF_SIZE = 1.19  # from one size that is tried to the next: closest points bridge half of that
POINTS = 150  # of each surface, between which a similarity is judged
REACH = 0.12  # root areas: what is as far from the other surface as that belongs to nothing there
FINE_REACH = 0.08  # the same, once closest points have been sought
TURN = 0.5  # of 1 - cosine of normals, beside the squared gap over the squared reach: normals at 180 degrees say no
MISSING = 0.6  # the cost of what lies on the boundary of the other surface, where that of what fits nowhere is 1
REFINED = 1500  # similarities of least cost that are improved by closest points
CLOSEST_REACH = 0.15  # root areas within which closest points are believed
STEPS = 8  # of closest points
APART = 0.1  # root mean square distance in root areas between two alignments that are two


@dataclass(frozen=True, eq=False)
class Similarities:
    """Maps y = s R x + t, with `rotations` R (k, 3, 3), `sizes` s (k,) and `shifts` t (k, 3)."""

    rotations: Floats
    sizes: Floats
    shifts: Floats

    def __len__(self) -> int:
        return len(self.sizes)

    @property
    def arrays(self) -> tuple[Floats, Floats, Floats]:
        """Rotations, sizes and shifts, as the kernels take them."""
        return self.rotations, self.sizes, self.shifts

    def __getitem__(self, rows: Integers) -> Similarities:
        return Similarities(self.rotations[rows], self.sizes[rows], self.shifts[rows])

    def moved(self, points: Floats) -> Floats:
        """Where each of them sends points (p, 3): an array (k, p, 3)."""
        turned = np.einsum("kab,pb->kpa", self.rotations, points)
        return np.asarray(self.sizes[:, None, None] * turned + self.shifts[:, None], dtype=np.float64)


class Framed(NamedTuple):
    """Places (k, 3) of a surface with their `frames` (k, 3, 3)."""

    places: Floats
    frames: Floats


@dataclass(frozen=True, eq=False)
class Judged:
    """A simplified surface as alignments are judged by: points on it, and its closest vertex to any place near it."""

    surface: Surface
    mesh: DeformableMesh
    grid: int = CELLS

    @cached_property
    def points(self) -> Integers:
        """Vertices (p,) spread over the surface."""
        return self._cells[0]

    @cached_property
    def _cells(self) -> tuple[Integers, Floats]:
        """Farthest points, and the area of the cell of each."""
        cells = self.surface.regular.cells(POINTS)
        areas = self.surface.areas * (cells.nearest >= 0)
        return cells.samples, np.bincount(np.maximum(cells.nearest, 0), areas, len(cells.samples)).astype(np.float64)

    @cached_property
    def arrays(self) -> tuple[Any, ...]:
        """What the kernels take: points, normals and areas; cells, their corner and step; vertices, normals, edge."""
        samples, areas = self._cells
        box = box_around(self.mesh, self.grid)
        normals = full_normals(self.surface)
        return (
            np.ascontiguousarray(self.surface.mesh.vertices[samples]),
            np.ascontiguousarray(normals[samples]),
            areas / areas.sum(),
            box.cells,
            box.low,
            box.step,
            np.ascontiguousarray(self.mesh.mesh.vertices),
            np.ascontiguousarray(self.mesh.normals),
            self._edge,
        )

    @cached_property
    def _edge(self) -> NDArray[np.bool_]:
        """Whether a vertex (n,) of the simplified mesh is on a face at the boundary."""
        faces, edge = self.mesh.mesh.faces, self.mesh.boundary.copy()
        edge[faces[edge[faces].any(axis=1)]] = True
        return edge


@memoized
def full_normals(surface: Surface) -> Floats:
    """Normals (n, 3) of all vertices."""
    return DeformableMesh.of(surface).normals


def frames(surface: Surface, vertices: Integers) -> Floats:
    """At each vertex (k,) its normal, averaged, and the principal directions of the most and the least curvature.

    Arrays (k, 3, 3) of rows that are orthonormal and right-handed; the signs of the two directions are arbitrary.
    """
    places, areas, normals = surface.mesh.vertices, surface.areas, full_normals(surface)
    usable = surface.regular.usable
    result = np.empty((len(vertices), 3, 3))
    for row, near in enumerate(cKDTree(places[usable]).query_ball_point(places[vertices], FRAME_RADIUS)):
        around = usable[near]
        around = around[normals[around] @ normals[vertices[row]] > SAME_SIDE]
        normal = areas[around] @ normals[around]
        normal = normal / max(np.linalg.norm(normal), np.finfo(float).tiny)
        across = normals[around] - np.outer(normals[around] @ normal, normal)
        most = np.linalg.eigh((areas[around, None] * across).T @ across)[1][:, 2]
        most -= normal * (most @ normal)
        most /= max(np.linalg.norm(most), np.finfo(float).tiny)
        result[row] = normal, most, np.cross(normal, most)
    return result


def alignments(source: Judged, target: Judged, sizes: tuple[float, float], count: int) -> Similarities:
    """The `count` best similarities between two surfaces of unit area, apart from each other, the best first.

    Frames of points of one are laid on those of the other, with `sizes` from the least to the most; what then lies
    nearest the boundary of the other surface, either way, may be missing there. The best are improved by closest points
    (Besl and McKay 1992).
    """
    begun = laid_on(framed(source, FRAMES), framed(target, FRAMES), sizes)
    if len(begun) == 0:  # no point lies far enough from the boundary to have a frame
        return begun
    costs = alignment_costs(*begun.arrays, source.arrays, target.arrays, REACH, TURN, MISSING)
    best = begun[np.argsort(costs, kind="stable")[:REFINED]]
    refined_alignments(*best.arrays, source.arrays, target.arrays, CLOSEST_REACH, STEPS, *sizes)
    costs = alignment_costs(*best.arrays, source.arrays, target.arrays, FINE_REACH, TURN, MISSING)
    order = np.argsort(costs, kind="stable")
    places = best.moved(source.arrays[0]).reshape(len(best), -1) / np.sqrt(len(source.arrays[0]))
    kept: list[int] = []
    for one in order:
        if len(kept) == count:
            break
        if not kept or np.sqrt(((places[kept] - places[one]) ** 2).sum(axis=1)).min() > APART:
            kept.append(int(one))
    return best[np.array(kept, dtype=np.int64)]


def laid_on(source: Framed, target: Framed, sizes: tuple[float, float]) -> Similarities:
    """All similarities that lay the frame of a point of the source, either way round, on one of the target."""
    flips = np.array([[1.0, 1.0, 1.0], [1.0, -1.0, -1.0]])
    flipped = target.frames[:, None] * flips[None, :, :, None]  # (q, 2, 3, 3)
    rotations = np.einsum("qfca,pcb->pqfab", flipped, source.frames)
    shape = rotations.shape[:3]
    turned = np.einsum("pqfab,pb->pqfa", rotations, source.places)
    goals = np.broadcast_to(target.places[None, :, None], (*shape, 3))
    ratio = sizes[1] / sizes[0]
    tried = sizes[0] * ratio ** np.linspace(0.0, 1.0, 1 + max(1, round(np.log(ratio) / np.log(STEP_OF_SIZE))))
    return Similarities(
        np.concatenate([rotations.reshape(-1, 3, 3)] * len(tried)),
        np.repeat(tried, int(np.prod(shape))),
        np.concatenate([(goals - size * turned).reshape(-1, 3) for size in tried]),
    )


def framed(one: Judged, count: int) -> Framed:
    """At most `count` points of a surface, those near its boundary left out, with their frames."""
    vertices = one.surface.regular.samples(count)
    vertices = vertices[~near_boundary(one.surface.mesh)[vertices]]
    return Framed(one.surface.mesh.vertices[vertices], frames(one.surface, vertices))

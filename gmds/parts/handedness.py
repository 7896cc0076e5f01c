"""Whether a surface lies better on the mirror image of another, or inside out, than on it as it is: cheaply.

For shapes that keep their shape, bones and teeth; two poses of a body lie on each other neither way.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from geodesics.arrays import Floats
from gmds._kernels.alignments import alignment_costs, refined_alignments
from gmds.parts.alignments import (
    CLOSEST_REACH,
    MISSING,
    REACH,
    STEPS,
    TURN,
    Framed,
    Judged,
    framed,
    laid_on,
)
from gmds.registration.deformable import DeformableMesh
from gmds.surface.measured import Surface

# Points of source and target whose frames are laid on each other, similarities that are improved by closest points, and
# cells along a surface: with 120 and 120, 1500 and 40 the costs of teeth are the same to within 0.01, for ten times
# the time (benchmarks/results/mirrored.md).
FRAMES = (24, 48)
REFINED = 100
GRID = 24
CLOSED_SIZES = (0.9, 1.1)  # of surfaces of unit area of which neither is a part of the other
OPEN_SIZES = (0.6, 1.7)  # where one may be, as for overlaps
AXES = np.array([-1.0, 1.0, 1.0])  # what a mirror image, of source or target, multiplies coordinates by


class Image(NamedTuple):
    """What is made of a target: its mirror image, or the same surface with its faces turned, or both, or neither."""

    reflected: bool
    turned: bool

    def of(self, surface: Surface) -> Surface:
        """That image of a surface."""
        image = surface.reflection if self.reflected else surface
        return image.inside_out if self.turned else image

    @property
    def reverses(self) -> bool:
        """Whether a map to it that preserves orientation reverses it as a map to the surface itself."""
        return self.reflected != self.turned


AS_IT_IS = Image(reflected=False, turned=False)
MIRRORED = Image(reflected=True, turned=False)
INSIDE_OUT = (Image(reflected=False, turned=True), Image(reflected=True, turned=True))


def image_costs(
    source: Surface, target: Surface, simplified: tuple[DeformableMesh, DeformableMesh], images: Sequence[Image]
) -> Floats:
    """For each image of the target what the surfaces cost, from 0 to 1, as they lie best on each other without bending.

    `simplified` are both with few faces. What `gmds.parts.alignments` does, with fewer frames; images are taken of the
    source, whose place in space is arbitrary.
    """
    ours, theirs = (Judged(surface, mesh, GRID) for surface, mesh in zip((source, target), simplified, strict=True))
    here, there = (framed(one, count) for one, count in zip((ours, theirs), FRAMES, strict=True))
    is_open = any(mesh.boundary.any() for mesh in simplified)
    sizes = OPEN_SIZES if is_open else CLOSED_SIZES
    if len(here.places) == 0 or len(there.places) == 0:
        return np.ones(len(images))
    return np.array([_cost(ours.arrays, here, theirs.arrays, there, image, sizes) for image in images])


def _cost(
    ours: tuple[Any, ...],
    here: Framed,
    theirs: tuple[Any, ...],
    there: Framed,
    image: Image,
    sizes: tuple[float, float],
) -> float:
    """The least cost over similarities of an image of the source and the target."""
    here, ours = _framed_image(here, image), _arrays_image(ours, image)
    begun = laid_on(here, there, sizes)
    costs = alignment_costs(*begun.arrays, ours, theirs, REACH, TURN, MISSING)
    best = begun[np.argsort(costs, kind="stable")[:REFINED]]
    refined_alignments(*best.arrays, ours, theirs, CLOSEST_REACH, STEPS, *sizes)
    return float(alignment_costs(*best.arrays, ours, theirs, REACH, TURN, MISSING).min())


def _framed_image(one: Framed, image: Image) -> Framed:
    """The frames of an image: right-handed again."""
    places, rows = one.places, one.frames
    if image.reflected:
        places, rows = places * AXES, rows * AXES
    if image.turned:
        rows = rows * np.array([-1.0, 1.0, 1.0])[:, None]
    normals, most = rows[:, 0], rows[:, 1]
    return Framed(places, np.stack([normals, most, np.cross(normals, most)], axis=1))


def _arrays_image(arrays: tuple[Any, ...], image: Image) -> tuple[Any, ...]:
    """What the kernels take of an image of a surface (see `Judged.arrays`)."""
    points, normals, areas, cells, low, step, vertices, directions, edge = arrays
    if image.turned:
        normals, directions = -normals, -directions
    if image.reflected:
        last = low[0] + step * (cells.shape[0] - 1)
        low, cells = np.array([-last, *low[1:]]), np.ascontiguousarray(cells[::-1])
        points, normals, vertices, directions = (rows * AXES for rows in (points, normals, vertices, directions))
    return points, normals, areas, cells, low, step, vertices, directions, edge

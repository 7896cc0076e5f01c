"""A map that is nearly right, made better: of two surfaces of a collection, both already laid out on one triangulation.

Going through a template the errors of two maps add up. Registering the two surfaces themselves, from where that leads,
takes away what the template brought in, for a fraction of the time of a match: nothing has to be proposed or weighed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Floats, Integers
from geodesics.barycentric import combination
from geodesics.closest import closest_on_triangles
from gmds.matching.candidates import registered
from gmds.matching.effort import keeps_sizes
from gmds.matching.large_surfaces import coarse
from gmds.matching.pair import SurfacePair
from gmds.matching.polishing import there_and_back, with_eigenfunctions
from gmds.registration.contacts import taken_back
from gmds.registration.deformable import DeformableMesh
from gmds.surface.measured import Surface


@dataclass(frozen=True, eq=False)
class CommonPoints:
    """The same n points on two surfaces, with the `faces` (m, 3) that join them: `here` (n, 3), `there` (n, 3)."""

    here: Floats
    there: Floats
    faces: Integers


def settled_places(source: Surface, target: Surface, common: CommonPoints) -> Floats:
    """Where the common points of the source belong on the target (n, 3), after registering one surface to the other.

    The registration starts from where the common points are on both, and goes there and back as that of a match does.
    Surfaces of more than 8,000 vertices are registered as copies with fewer. All in the coordinates of the originals.
    """
    ours, theirs = coarse(source), coarse(target)
    here, there = _Laid(source, ours).inward(common.here), _Laid(target, theirs).inward(common.there)
    pair = SurfacePair(ours, theirs)
    start = _carried(Mesh(here, common.faces), there, pair.full[0])
    pair = SurfacePair(ours, theirs, isometric=keeps_sizes(pair.full[0], start))
    deformation = registered(pair, SurfacePoints.closest(theirs.mesh, start))
    if not deformation.residuals.is_congruence:
        deformation, settings = with_eigenfunctions(pair, deformation)
        deformation = there_and_back(pair, deformation, settings, lambda share: None)
    faces = ours.mesh.faces
    face, weights, _ = closest_on_triangles(here, ours.mesh.vertices, faces)
    images = combination(weights, taken_back(*pair.full, deformation.y, deformation.points).positions[faces[face]])
    return SurfacePoints.closest(target.original, _Laid(target, theirs).outward(images)).positions


@dataclass(frozen=True, eq=False)
class _Laid:
    """How a copy lies beside the mesh that its surface was measured from: moved and scaled."""

    surface: Surface
    copy: Surface

    def inward(self, places: Floats) -> Floats:
        """Places (p, 3) in the coordinates of the original as those on the copy."""
        for step in self._steps:
            places = (places - step[0]) * step[1]
        return places

    def outward(self, places: Floats) -> Floats:
        """The other way round."""
        for step in self._steps[::-1]:
            places = places / step[1] + step[0]
        return places

    @property
    def _steps(self) -> list[tuple[Floats, float]]:
        surfaces = [self.surface, *([] if self.copy is self.surface else [self.copy])]
        return [_step(one.original.vertices, one.mesh.vertices) for one in surfaces]


def _step(before: Floats, after: Floats) -> tuple[Floats, float]:
    """The shift (3,) and then the scale that bring vertices (n, 3) to where they are after."""
    scale = float(np.linalg.norm(after - after.mean(axis=0)) / np.linalg.norm(before - before.mean(axis=0)))
    return before.mean(axis=0) - after.mean(axis=0) / scale, scale


def _carried(common: Mesh, there: Floats, source: DeformableMesh) -> Floats:
    """Where the vertices of the source (n, 3) go if those of the common triangulation, on it, go `there` (q, 3).

    Closest by position and normal, so that hands that touch a thigh are not taken for it.
    """
    n = common.n_vertices
    registered_mesh = DeformableMesh(common, np.arange(n), np.zeros(n))
    near = registered_mesh.usable[registered_mesh.tree.query(source.features)[1]]
    points = registered_mesh.closest(source.features, registered_mesh.features, near)
    return combination(points.barycentric, there[common.faces[points.face]])

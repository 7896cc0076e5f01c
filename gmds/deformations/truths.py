"""Truth along deformations: where every vertex of a mesh is on its deformed copy."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Bools
from geodesics.barycentric import combination

Deformation = Callable[[Mesh], tuple[Mesh, SurfacePoints]]


class Part(tuple[Mesh, SurfacePoints]):
    """A deformed mesh and the truth, as every deformation gives them, and which vertices of the old mesh are gone.

    Parameters
    ----------
    mesh : Mesh
        The deformed mesh.
    truth : SurfacePoints
        n points of it, one per vertex of the old mesh; that of a vertex that is gone is the remaining point closest
        in space when it went.
    missing : bool array of shape (n,)
        True where the vertex of the old mesh is gone. ``mesh, truth = part`` leaves it out.

    See Also
    --------
    cut : Makes one.
    compose : Carries `missing` along.
    """

    missing: Bools

    def __new__(cls, mesh: Mesh, truth: SurfacePoints, missing: Bools) -> Part:
        self = super().__new__(cls, (mesh, truth))
        self.missing = missing
        return self

    def __getnewargs__(self) -> tuple[Mesh, SurfacePoints, Bools]:  # type: ignore[override]
        """Parts can be copied and pickled."""
        return self.mesh, self.truth, self.missing

    @property
    def mesh(self) -> Mesh:
        """The deformed mesh."""
        return self[0]

    @property
    def truth(self) -> SurfacePoints:
        """One point of it per vertex of the old mesh."""
        return self[1]


def moved(mesh: Mesh, vertices: ArrayLike) -> tuple[Mesh, SurfacePoints]:
    """The mesh with its vertices (n, 3) elsewhere; vertex i stays vertex i.

    Raises `MeshError` where a vertex is on no face: it has no surface point.
    """
    result = Mesh(vertices, mesh.faces)
    return result, SurfacePoints.at_vertices(result, np.arange(mesh.n_vertices))


def carried(points: SurfacePoints, truth: SurfacePoints) -> SurfacePoints:
    """Points of a mesh on its deformed copy, given the truth of the mesh's vertices.

    Exact where the copy has the same faces and vertex i is still vertex i; else the surface point closest in space to
    the weighted mean of the images of the face's corners.

    Parameters
    ----------
    points : SurfacePoints
        p points of the mesh.
    truth : SurfacePoints
        One point of the copy per vertex of the mesh.

    Returns
    -------
    SurfacePoints
        p points of the copy.
    """
    same_faces = np.array_equal(points.mesh.faces, truth.mesh.faces)
    if same_faces and np.array_equal(truth.positions, truth.mesh.vertices):
        return SurfacePoints(truth.mesh, points.face, points.barycentric)
    corners = truth.positions[points.mesh.faces[points.face]]
    return SurfacePoints.closest(truth.mesh, combination(points.barycentric, corners))


def compose(*deformations: Deformation) -> Callable[[Mesh], Part]:
    """Several deformations, one after another, as one.

    Parameters
    ----------
    *deformations : callable
        Each Mesh -> (Mesh, SurfacePoints); the first is applied first.

    Returns
    -------
    callable
        Mesh -> `Part`, with the truth of the first mesh's vertices on the last mesh, and those of them that any of the
        deformations removed.
    """

    def together(mesh: Mesh) -> Part:
        result, truth = moved(mesh, mesh.vertices)
        missing = np.zeros(mesh.n_vertices, dtype=bool)
        for deformation in deformations:
            done = deformation(result)
            if isinstance(done, Part):
                missing |= truth.interpolate(done.missing.astype(np.float64)) > 0.5
            result, step = done
            truth = carried(truth, step)
        return Part(result, truth, missing)

    return together

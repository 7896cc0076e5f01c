"""Odd but legal surfaces, by row of the reliability table, each with the distances from one of its vertices."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, field

import generated_shapes as shapes
import numpy as np
from graph_distances import graph_distances
from numpy.typing import ArrayLike, NDArray
from rare_shapes import cone, crowded, plate, strip

from geodesics import Mesh


@dataclass(frozen=True)
class Odd:
    """Arrays as a user gives them; `source` is the vertex distances are measured from, `sound` the faces that count."""

    vertices: NDArray
    faces: NDArray
    source: int = 0
    sound: NDArray | None = None
    known: NDArray | None = field(default=None, repr=False)

    @functools.cached_property
    def distances(self) -> NDArray:
        """Reference distances (n,): +inf where unreachable, NaN where nothing is claimed."""
        if self.known is not None:
            return self.known
        return graph_distances(self.vertices, self.faces if self.sound is None else self.sound, self.source)

    @functools.cached_property
    def mesh(self) -> Mesh:
        """As it is, checked."""
        return Mesh(self.vertices, self.faces)

    @functools.cached_property
    def area(self) -> float:
        """Area, every face counted once."""
        a, b, c = self.vertices[(self.faces if self.sound is None else self.sound).T]
        return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def of(mesh: Mesh, *extra: ArrayLike, source: int = 0) -> Odd:
    """A mesh with further faces that add nothing to its surface."""
    faces = np.concatenate([mesh.faces, np.array(extra, dtype=np.int64).reshape(-1, 3)])
    return Odd(mesh.vertices, faces, source, mesh.faces)


def turned(mesh: Mesh, which: NDArray) -> Odd:
    """Some faces the other way round."""
    return Odd(mesh.vertices, np.where(which[:, None], mesh.faces[:, ::-1], mesh.faces))


def split_edge(share: float) -> Odd:
    """A new vertex on an edge, next to its end: two slivers, or two faces of no area when `share` is 0."""
    mesh = BALL()
    a, b, c = mesh.faces[50].tolist()
    other = next(f for f in mesh.faces.tolist() if {a, b} < set(f) and c not in f)
    d = ({*other} - {a, b}).pop()
    n = mesh.n_vertices
    rest = [f for f in mesh.faces.tolist() if not {a, b} < set(f)]
    vertices = np.vstack([mesh.vertices, (1 - share) * mesh.vertices[a] + share * mesh.vertices[b]])
    odd = Odd(vertices, np.array([*rest, [a, n, c], [n, b, c], [b, n, d], [n, a, d]]))
    if share:
        return odd
    known = Odd(mesh.vertices, mesh.faces).distances
    return Odd(vertices, odd.faces, sound=mesh.faces, known=np.append(known, known[a]))


def fin() -> Odd:
    """An edge of three faces."""
    mesh = BALL()
    a, b, _ = mesh.faces[50]
    top = mesh.vertices[[a, b]].mean(axis=0) * 1.2
    return Odd(np.vstack([mesh.vertices, top]), np.vstack([mesh.faces, [a, b, mesh.n_vertices]]))


def bow_tie() -> Odd:
    """Two surfaces that meet in one vertex."""
    mesh, n = BALL(), BALL().n_vertices
    other = np.where(mesh.faces == 9, 9, mesh.faces + n)
    used, compact = np.unique(np.concatenate([mesh.faces, other]), return_inverse=True)
    vertices = np.concatenate([mesh.vertices, 2 * mesh.vertices[9] - mesh.vertices])[used]
    return Odd(vertices, compact.reshape(-1, 3))


def isolated() -> Odd:
    """Vertices on no face, among them the first and the last."""
    mesh = shapes.with_isolated(BALL())
    return Odd(mesh.vertices, mesh.faces, source=5)


def half() -> Odd:
    """Half of a surface; the vertices of the other half are gone."""
    mesh = BALL()
    used, compact = np.unique(mesh.faces[mesh.vertices[mesh.faces].mean(axis=1)[:, 0] > 0.1], return_inverse=True)
    return Odd(mesh.vertices[used], compact.reshape(-1, 3))


def holes() -> Odd:
    """A surface with many small holes."""
    mesh = shapes.bumpy_sphere(3)
    lost = np.flatnonzero(np.arange(mesh.n_faces) % 97 == 5)
    return Odd(mesh.vertices, np.delete(mesh.faces, lost, axis=0))


def plain(mesh: Mesh, scale: float = 1.0, shift: float = 0.0, source: int = 0) -> Odd:
    """A sound mesh, somewhere and of some size."""
    return Odd(scale * mesh.vertices + shift, mesh.faces, source)


def flat(mesh: Mesh) -> Odd:
    """A flat convex mesh, where distances are straight."""
    return Odd(mesh.vertices, mesh.faces, known=np.linalg.norm(mesh.vertices - mesh.vertices[0], axis=1))


def spike() -> Odd:
    """One vertex a thousand diameters away."""
    mesh = BALL()
    far = mesh.vertices.copy()
    far[9] *= 2000
    return Odd(far, mesh.faces)


@functools.cache
def BALL() -> Mesh:
    """The surface that is made odd."""
    return shapes.bumpy_sphere(2)


ODD: list[tuple[str, str, Callable[[], Odd]]] = [
    ("G01", "duplicate faces", lambda: of(BALL(), *BALL().faces[[3, 7, 7, 90]], BALL().faces[5, [1, 2, 0]])),
    ("G02", "faces that name a vertex twice", lambda: of(BALL(), [4, 4, 9], [7, 8, 7], [3, 3, 3])),
    ("G03", "faces of zero area", lambda: split_edge(0.0)),
    ("G04", "slivers of aspect 1e7", lambda: split_edge(1e-7)),
    ("G04", "needles", lambda: flat(shapes.rectangle(2, 300))),
    ("G05", "edge of three faces", fin),
    ("G06", "bow-tie vertex", bow_tie),
    ("G07", "isolated vertices", isolated),
    ("G08", "two components", lambda: plain(shapes.joined(BALL(), shapes.icosphere(1)))),
    ("G09", "disc", lambda: flat(shapes.disc(8))),
    ("G10", "many holes", holes),
    ("G10", "half of a surface", half),
    ("G11", "one face turned", lambda: turned(BALL(), np.arange(BALL().n_faces) == 17)),
    ("G11", "half the faces turned", lambda: turned(BALL(), np.arange(BALL().n_faces) % 2 == 0)),
    ("G11", "all faces turned", lambda: turned(BALL(), np.ones(BALL().n_faces, bool))),
    ("G12", "Moebius strip", lambda: plain(strip())),
    ("G12", "Klein bottle", lambda: plain(strip(klein=True))),
    ("G13", "genus 1", lambda: plain(shapes.torus(24, 12))),
    ("G13", "genus 2", lambda: plain(plate(2))),
    ("G13", "genus 5", lambda: plain(plate(5))),
    ("G14", "flat plane", lambda: flat(shapes.rectangle(12, 12))),
    ("G15", "cylinder", lambda: plain(shapes.cylinder(24, 10))),
    ("G15", "cone", lambda: plain(cone())),
    ("G16", "sphere", lambda: plain(shapes.icosphere(2))),
    ("G16", "cube", lambda: plain(shapes.cube(5))),
    ("G19", "scale 1e-12", lambda: plain(BALL(), 1e-12)),
    ("G19", "scale 1e12", lambda: plain(BALL(), 1e12)),
    ("G20", "1e8 away from the origin", lambda: plain(BALL(), 1.0, 1e8)),
    ("G21", "one triangle", lambda: Odd(np.eye(3), np.array([[0, 1, 2]]))),
    ("G21", "two triangles", lambda: Odd(shapes.tetrahedron().vertices, np.array([[0, 1, 2], [0, 2, 3]]))),
    ("G21", "tetrahedron", lambda: plain(shapes.tetrahedron())),
    ("G23", "surface through itself", lambda: plain(shapes.torus(24, 12, major=0.3, minor=0.6))),
    ("G23", "surfaces through each other", lambda: plain(shapes.joined(BALL(), BALL(), gap=0.7))),
    ("G24", "vertices crowded in one place", lambda: plain(crowded(BALL()))),
    ("G25", "spike", spike),
    ("G26", "noise of 5 % of the edges", lambda: plain(shapes.jittered(BALL(), 0.05))),
]  # fmt: skip

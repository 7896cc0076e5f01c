"""What bending and stretching do not change: components, boundary loops, Euler characteristic, genus."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geodesics.caching import memoized
from geodesics.mesh import Mesh
from geodesics.topology.components import vertex_components
from geodesics.topology.edges import components, corner_fans, degenerate_faces, edges, face_components
from geodesics.topology.orientation import orientation


@dataclass(frozen=True)
class Invariants:
    """Numbers of `components` and of `boundaries` (loops), the `euler` characteristic V - E + F, and the `genus`.

    The genus is None where it has no meaning: edges of more than two faces, or a part without an orientation.
    """

    components: int
    boundaries: int
    euler: int
    genus: int | None

    def __str__(self) -> str:
        genus = "" if self.genus is None else f", genus {self.genus}"
        return f"{_counted(self.components, 'component')}, {_counted(self.boundaries, 'boundary loop')}{genus}"


@memoized
def invariants(mesh: Mesh) -> Invariants:
    """The topological invariants of a mesh, faces that name a vertex twice left out.

    With c components and b boundaries, 2 c - b - (V - E + F) is twice the genus; vertices at which several fans of
    faces meet count once for each fan.
    """
    table, sound = edges(mesh), ~degenerate_faces(mesh)
    fan_labels, fans = np.unique(corner_fans(mesh)[sound], return_inverse=True)
    rim, fans = (table.n_faces[table.of_side] == 1)[sound], fans.reshape(-1, 3)
    start, end = fans[rim], np.roll(fans, -1, axis=1)[rim]
    loops = len(np.unique(components(start, end, len(fan_labels))[start]))
    fewer = int(sound.sum()) - len(table.ends)
    genus = None
    if (table.n_faces <= 2).all() and not orientation(mesh).one_sided.any():
        pieces = len(np.unique(face_components(mesh)[sound]))
        genus = (2 * pieces - loops - (len(fan_labels) + fewer)) // 2
    return Invariants(
        components=int(vertex_components(mesh).max(initial=-1)) + 1,
        boundaries=loops,
        euler=len(np.unique(mesh.faces[sound])) + fewer,
        genus=genus,
    )


def _counted(number: int, thing: str) -> str:
    return f"{number} {thing}{'' if number == 1 else 's'}"

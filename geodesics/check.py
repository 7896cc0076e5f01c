"""What is unusual or wrong with a mesh, as notes; nothing is changed (see `geodesics.repair`).

| code | says |
|---|---|
| W201 | faces given more than once |
| W202 | faces that name a vertex twice |
| W203 | faces of zero area |
| W204 | faces oriented against their neighbours, or a closed surface turned inside out |
| W206 | most of the surface is flat, as planes and cylinders are |
| W208 | coordinates so far from the origin that edges have lost their precision |
| W209 | vertices far away from all others |
| W212 | a part that has no orientation (Moebius strip) |
| W213 | edges of more than two faces |
| W214 | vertices at which several fans of faces meet |
| W215 | vertices on no face |
| W216 | several components |
| W217 | boundary loops |
| W218 | Euler characteristic and genus |
| W219 | different vertices at the same position |
| W229 | vertices on open edges that they are no ends of: T-junctions |
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from geodesics.arrays import Bools
from geodesics.defects import flat_faces, repeated_faces, unreferenced_vertices
from geodesics.errors import Note
from geodesics.io.precision import precision_notes
from geodesics.mesh import Mesh
from geodesics.one_ring import one_ring_areas, one_ring_curvature
from geodesics.topology.components import boundary_vertices, vertex_components
from geodesics.topology.edges import corner_fans, degenerate_faces, edges
from geodesics.topology.invariants import invariants
from geodesics.topology.junctions import junctions
from geodesics.topology.orientation import orientation

__all__ = ["check", "flat_faces", "repeated_faces", "unreferenced_vertices"]

# Gaussian curvature times the area of the surface, no unit, below which it counts as 0: a sphere has 4 pi. Set by hand,
# far above rounding and far below a curved surface; only the note W206 depends on it.
FLAT = 1e-3
NAMED = 100  # indices listed in a note, at most; a convention that keeps messages readable

# The option with which `gmds repair` mends a finding ("": none is needed); codes that are not here it cannot mend.
REMEDIES = {
    **dict.fromkeys(("W201", "W202", "W204", "W215"), ""),
    "W203": "--remesh",
    "W219": "--weld",
    "W229": "--sew",
    **dict.fromkeys(("W213", "W214"), "--cut"),
    "W216": "--largest",
    "W217": "--fill-holes",
}


def check(mesh: Mesh) -> list[Note]:
    """What is unusual or wrong with a mesh, each finding as a note.

    Parameters
    ----------
    mesh : Mesh
        The mesh, which is not changed.

    Returns
    -------
    list of Note
        Warnings first. The list is never empty, as the topology is always reported (W218).

    See Also
    --------
    geodesics.repair.repair : Removes what can be removed.
    """
    notes = [note for find in _CHECKS for note in find(mesh)]
    return sorted(notes, key=lambda note: note.severity != "warning")


def _warn(code: str, mask: Bools, sentence: str) -> list[Note]:
    """A warning listing where `mask` holds, if anywhere; `sentence` has one place for the count."""
    where = np.flatnonzero(mask)
    if not len(where):
        return []
    return [Note(code, "warning", sentence.format(len(where)), tuple(where[:NAMED].tolist()), len(where))]


def _faces(mesh: Mesh) -> Iterable[Note]:
    yield from _warn("W201", repeated_faces(mesh), "{} faces repeat an earlier face")
    yield from _warn("W202", degenerate_faces(mesh), "{} faces name a vertex twice")
    yield from _warn("W203", flat_faces(mesh), "{} faces have zero area")


def _orientation(mesh: Mesh) -> Iterable[Note]:
    sides = orientation(mesh)
    yield from _warn("W204", sides.turn, "{} faces are oriented against their neighbours")
    yield from _warn("W204", sides.inward, "{} faces belong to closed parts that are inside out")
    yield from _warn("W212", sides.one_sided, "{} faces belong to a part that has no orientation, like a Moebius strip")


def _manifold(mesh: Mesh) -> Iterable[Note]:
    table = edges(mesh)
    where = table.ends[table.n_faces > 2]
    if len(where):
        message = f"{len(where)} edges have more than two faces, first the one between vertices {where[0].tolist()}"
        yield Note("W213", "warning", message, tuple(np.unique(where)[:NAMED].tolist()), len(where))
    sound = ~degenerate_faces(mesh)
    _, first = np.unique(corner_fans(mesh)[sound], return_index=True)
    fans = np.bincount(mesh.faces[sound].ravel()[first], minlength=mesh.n_vertices)
    yield from _warn("W214", fans > 1, "{} vertices join several fans of faces")


def _vertices(mesh: Mesh) -> Iterable[Note]:
    yield from _warn("W215", unreferenced_vertices(mesh), "{} vertices are on no face")
    _, first, place = np.unique(mesh.vertices, axis=0, return_index=True, return_inverse=True)
    repeated = np.ones(mesh.n_vertices, dtype=bool)
    repeated[first] = False
    yield from _warn("W219", repeated, "{} vertices are at the position of an earlier one")
    on_edge = np.zeros(mesh.n_vertices, dtype=bool)
    on_edge[junctions(Mesh(mesh.vertices, first[place.reshape(-1)][mesh.faces])).vertex] = True
    yield from _warn("W229", on_edge, "{} vertices lie on open edges that they are no ends of (T-junctions)")
    distance = np.linalg.norm(mesh.vertices - np.median(mesh.vertices, axis=0), axis=1)
    yield from _warn("W209", distance > 20 * np.median(distance), "{} vertices are far away from all others")


def _topology(mesh: Mesh) -> Iterable[Note]:
    topology = invariants(mesh)
    if topology.components > 1:
        sizes = np.sort(np.bincount(vertex_components(mesh)[vertex_components(mesh) >= 0]))[::-1]
        message = f"{topology.components} components, of {', '.join(map(str, sizes[:5]))} vertices"
        yield Note("W216", "warning", message, (), topology.components)
    if topology.boundaries:
        table, sound = edges(mesh), ~degenerate_faces(mesh)
        count = int((table.n_faces[table.of_side] == 1)[sound].sum())
        yield Note("W217", "info", f"{topology.boundaries} boundary loops with {count} edges", (), topology.boundaries)
    genus = "" if topology.genus is None else f", genus {topology.genus}"
    yield Note("W218", "info", f"Euler characteristic {topology.euler}{genus}")


def _curvature(mesh: Mesh) -> Iterable[Note]:
    areas, inner = one_ring_areas(mesh), ~boundary_vertices(mesh)
    flat = np.abs(one_ring_curvature(mesh)) * areas.sum() / 3 < FLAT
    share = areas[inner & flat].sum() / max(areas[inner].sum(), np.finfo(float).tiny)
    if share > 0.5:
        message = (
            f"{share:.0%} of the area has no Gaussian curvature; the scale-invariant metric is that of space there"
        )
        yield Note("W206", "info", message)


_CHECKS: list[Callable[[Mesh], Iterable[Note]]] = [
    _faces,
    _orientation,
    _manifold,
    _vertices,
    precision_notes,
    _topology,
    _curvature,
]

"""Repair before comparison: damage of the meshes of a collection that has nothing to do with their shapes."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from geodesics import Mesh
from geodesics.arrays import Floats, Integers
from geodesics.topology.components import largest_component
from geodesics.topology.edges import edge_keys, twice_given

# all three chosen on the classes DEVELOPMENT of examples/paper/table1_retrieval.py
LARGEST_HOLE = 0.5  # perimeter, in units of sqrt(area): what is longer is the edge of the surface
SPIKE = 0.75  # how far a vertex is from the middle of its neighbours, in units of their r.m.s. distance from it
SMOOTHING_STEPS = 10  # there and back


def mended(mesh: Mesh) -> Mesh:
    """The largest piece of a mesh, parted where sheets meet in a point, small holes closed, spikes and noise smoothed.

    Nothing here depends on the unit of length, nor on the size of a part: everything is relative to neighbours.
    """
    return smoothed(without_spikes(without_small_holes(largest_piece(parted(mesh)))))


def parted(mesh: Mesh) -> Mesh:
    """A vertex for every fan of faces: sheets that meet in a point part there.

    Heat does not pass through a point of a surface, but it does through a vertex of a mesh. Sheets that meet in an edge
    part as well, unless there are faces around that link them.
    """
    faces, m = mesh.faces, len(mesh.faces)
    corner = np.arange(3 * m).reshape(m, 3)
    # half-edge k of a face runs from its corner k + 1 to k + 2; faces at the same edge share both its ends
    start, end = corner[:, [1, 2, 0]].ravel(), corner[:, [2, 0, 1]].ravel()
    a, b = faces.ravel()[start], faces.ravel()[end]
    low, high = np.where(a < b, start, end), np.where(a < b, end, start)
    one, other = twice_given(edge_keys(a, b, mesh.n_vertices))
    links = np.r_[low[one], high[one]], np.r_[low[other], high[other]]
    graph = sp.coo_matrix((np.ones(len(links[0])), links), shape=(3 * m, 3 * m))
    fan = sp.csgraph.connected_components(graph, directed=False)[1]
    _, first, renumbered = np.unique(fan, return_index=True, return_inverse=True)
    return Mesh(mesh.vertices[faces.ravel()[first]], renumbered.reshape(m, 3))


def largest_piece(mesh: Mesh) -> Mesh:
    """The connected piece with the largest area, without vertices on no face.

    Eyes and teeth are surfaces of their own: heat never gets there, and they say nothing about the rest.
    """
    kept, renumbered = np.unique(mesh.faces[largest_component(mesh)], return_inverse=True)
    return Mesh(mesh.vertices[kept], renumbered.reshape(-1, 3))


def without_small_holes(mesh: Mesh) -> Mesh:
    """Holes with a perimeter up to LARGEST_HOLE sqrt(area) closed by a fan around a new vertex in their middle."""
    limit = LARGEST_HOLE * np.sqrt(mesh.area)
    loops = [loop for loop in _loops(mesh) if _perimeter(mesh.vertices[loop]) <= limit]
    if not loops:
        return mesh
    middles = np.array([mesh.vertices[loop].mean(axis=0) for loop in loops])
    fans = [
        np.column_stack([np.roll(loop, -1), loop, np.full(len(loop), mesh.n_vertices + k)])
        for k, loop in enumerate(loops)
    ]
    return Mesh(np.vstack([mesh.vertices, middles]), np.vstack([mesh.faces, *fans]))


def without_spikes(mesh: Mesh) -> Mesh:
    """Vertices that stand out from their neighbours by more than SPIKE put in the middle of these, worst first."""
    vertices, mean = mesh.vertices - mesh.vertices.mean(axis=0), _mean_of_neighbours(mesh)
    for _ in range(5):
        middle = mean @ vertices
        away = np.linalg.norm(vertices - middle, axis=1)
        spread = np.sqrt(np.maximum(mean @ (vertices**2).sum(axis=1) - (middle**2).sum(axis=1), 0))
        height = away / np.maximum(spread, np.finfo(float).tiny)
        spikes = (height > SPIKE) & (height >= mean.sign().multiply(height).max(axis=1).toarray().ravel())
        if not spikes.any():
            break
        vertices[spikes] = middle[spikes]
    return Mesh(vertices + mesh.vertices.mean(axis=0), mesh.faces)


def smoothed(mesh: Mesh) -> Mesh:
    """Noise between neighbours taken away, the volume kept: SMOOTHING_STEPS steps there and back (Taubin 1995)."""
    mean, vertices = _mean_of_neighbours(mesh), mesh.vertices
    for _ in range(SMOOTHING_STEPS):
        vertices = vertices + 0.5 * (mean @ vertices - vertices)
        vertices = vertices - 0.53 * (mean @ vertices - vertices)
    return Mesh(vertices, mesh.faces)


def _mean_of_neighbours(mesh: Mesh) -> sp.csr_matrix:
    """Rows that sum to 1, equal where two vertices share an edge (n, n)."""
    i, j = mesh.faces[:, [0, 1, 2]].ravel(), mesh.faces[:, [1, 2, 0]].ravel()
    n = mesh.n_vertices
    graph = sp.coo_matrix((np.ones(2 * len(i)), (np.r_[i, j], np.r_[j, i])), shape=(n, n)).tocsr()
    graph.data[:] = 1
    return (sp.diags(1 / np.asarray(graph.sum(axis=1)).ravel()) @ graph).tocsr()


def _loops(mesh: Mesh) -> list[Integers]:
    """The boundary as closed loops of vertices in the direction of their faces; only those without a crossing."""
    start, end = mesh.faces[:, [0, 1, 2]].ravel(), mesh.faces[:, [1, 2, 0]].ravel()
    _, first, count = np.unique(edge_keys(start, end, mesh.n_vertices), return_index=True, return_counts=True)
    rim = first[count == 1]
    after: dict[int, int] = {}
    crossing: set[int] = set()
    for a, b in zip(start[rim].tolist(), end[rim].tolist(), strict=True):
        crossing.update({a} if a in after else ())
        after[a] = b
    loops = []
    while after:
        first_vertex, vertex = next(iter(after.items()))
        del after[first_vertex]
        loop = [first_vertex]
        while vertex in after and vertex != first_vertex:
            loop.append(vertex)
            vertex = after.pop(vertex)
        if vertex == first_vertex and len(loop) > 2 and not crossing & set(loop):
            loops.append(np.array(loop))
    return loops


def _perimeter(loop: Floats) -> float:
    return float(np.linalg.norm(loop - np.roll(loop, -1, axis=0), axis=1).sum())

"""Texture coordinates along a map: by the corners of faces, as they jump where an atlas is cut."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Bools, Floats, Integers
from geodesics.closest import closest_weights
from geodesics.topology.edges import edge_keys
from gmds.errors import MapError
from gmds.maps.point_map import PointMap

SAME = 1e-6  # texture coordinates closer than this are one: the image is 1 wide, and files often have six decimals
JUMP = 0.5  # an edge crosses a cut when it ends this far from where it was foretold, over its length in the image;
# set by hand: what is suspected in vain is found out, and costs time only
LARGEST = 2000  # faces of the patch that is searched; a bound of time, set by hand


def carry_uv(answer: PointMap, uv: Floats) -> tuple[Floats, Bools]:
    """Texture coordinates of the target, carried to the corners of the source's faces.

    A corner gets what the texture has where its vertex goes. A face whose corners go to different charts of the
    texture, or to different sides of a cut, would be filled with all that lies between them in the image. Such a face
    takes all three from one side: from the chart where the middle of the face goes, at the points of it that are
    closest to where the corners go. It shows the right part of the image, stretched up to the seam.

    Parameters
    ----------
    answer : Correspondence
        The map.
    uv : array of shape (m of the target, 3, 2)
        Texture coordinates of the corners of the target's faces.

    Returns
    -------
    carried : array of shape (m of the source, 3, 2)
        Those of the source's faces.
    across : array of shape (m of the source,)
        Which faces lie across a seam.

    Raises
    ------
    MapError
        E310, for coordinates of another shape, or not finite.

    See Also
    --------
    read_look : Where texture coordinates come from.
    """
    source, target, points = answer.source, answer.target, answer.points
    if uv.shape != (target.n_faces, 3, 2) or not np.isfinite(uv).all():
        raise MapError(f"texture coordinates must be finite and ({target.n_faces}, 3, 2), not {uv.shape}")
    joined = _joined(target, uv)
    label = connected_components(joined, directed=False)[1]
    at_vertex = np.einsum("nk,nkj->nj", points.barycentric, uv[points.face])
    carried, place = at_vertex[source.faces], points.positions[source.faces]
    chart = label[points.face][source.faces]
    across = (chart != chart[:, :1]).any(axis=1) | _torn(target, uv, points, source.faces)
    rows = np.flatnonzero(across)
    middle = SurfacePoints.closest(target, place[rows].mean(axis=1)).face if len(rows) else rows
    for row, face in zip(rows, middle, strict=True):
        patch = _patch(target, joined, int(face), place[row])
        found = np.stack([_looked_up(target, uv, patch, corner) for corner in place[row]])
        across[row] = np.abs(found - carried[row]).max() > SAME  # else it only looked as if
        if across[row]:
            carried[row] = found
    return carried, across


def charts(mesh: Mesh, uv: Floats) -> Integers:
    """The number (m,) of the piece of the texture, in one part and uncut, that each face lies in."""
    return np.asarray(connected_components(_joined(mesh, uv), directed=False)[1], dtype=np.int64)


def _joined(mesh: Mesh, uv: Floats) -> sp.csr_matrix:
    """Which faces (m, m) share an edge with the same texture coordinates on both sides."""
    m = mesh.n_faces
    start, end = mesh.faces, np.roll(mesh.faces, -1, axis=1)
    here, there = uv, np.roll(uv, -1, axis=1)
    turned = (start > end)[..., None]
    key = edge_keys(start, end, mesh.n_vertices).ravel()
    ends = np.concatenate([np.where(turned, there, here), np.where(turned, here, there)], axis=2).reshape(-1, 4)
    order = np.argsort(key, kind="stable")
    first, second = order[:-1], order[1:]
    same = (key[first] == key[second]) & (np.abs(ends[first] - ends[second]) < SAME).all(axis=1)
    a, b = first[same] // 3, second[same] // 3
    graph = sp.csr_matrix((np.ones(len(a), dtype=np.int8), (a, b)), shape=(m, m))
    return sp.csr_matrix(graph + graph.T)


def _torn(mesh: Mesh, uv: Floats, points: SurfacePoints, faces: Integers) -> Bools:
    """Whether a face (m,) with corners at these points has an edge whose ends are not where each other's face says.

    The coordinates of a face of the mesh, continued in its plane to the other end of the edge, foretell what is there.
    """
    place, at = points.positions, np.einsum("nk,nkj->nj", points.barycentric, uv[points.face])
    run, rise = (rows[:, 1:] - rows[:, :1] for rows in (mesh.vertices[mesh.faces], uv))
    slope = (np.linalg.pinv(run) @ rise)[points.face]
    result = np.zeros(len(faces), dtype=bool)
    for k in range(3):
        for a, b in ((faces[:, k], faces[:, k - 1]), (faces[:, k - 1], faces[:, k])):
            foretold = np.einsum("mi,mij->mj", place[b] - place[a], slope[a])
            off = np.linalg.norm(at[b] - at[a] - foretold, axis=1)
            result |= off > JUMP * np.linalg.norm(foretold, axis=1) + SAME
    return result


def _looked_up(mesh: Mesh, uv: Floats, patch: Integers, place: Floats) -> Floats:
    """Texture coordinates (2,) of the point of the patch closest to a place (3,); of several, on its first face."""
    triangles = mesh.vertices[mesh.faces[patch]]
    weights = closest_weights(np.tile(place, (len(patch), 1)), triangles)
    gap = np.linalg.norm(np.einsum("pk,pkj->pj", weights, triangles) - place, axis=1)
    near = int(np.argmax(gap <= gap.min() + SAME * np.ptp(triangles, axis=(0, 1)).max()))
    return np.asarray(weights[near] @ uv[patch[near]], dtype=np.float64)


def _patch(mesh: Mesh, joined: sp.csr_matrix, face: int, corners: Floats) -> Integers:
    """Faces around `face` that are reached without crossing a seam, as far as the corners (3, 3) lie from it."""
    middle = corners.mean(axis=0)
    reach = 1.5 * float(np.linalg.norm(corners - middle, axis=1).max())
    found, seen = [face], {face}
    for one in found:
        if len(found) >= LARGEST:
            break
        for other in joined.indices[joined.indptr[one] : joined.indptr[one + 1]].tolist():
            if other not in seen:
                seen.add(other)
                if np.linalg.norm(mesh.vertices[mesh.faces[other]] - middle, axis=1).min() <= reach:
                    found.append(other)
    return np.array(found, dtype=np.int64)

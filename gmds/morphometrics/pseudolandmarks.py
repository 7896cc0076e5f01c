"""Points that nobody placed: evenly spread over a surface, in pairs where it is symmetric."""

from __future__ import annotations

import numpy as np

from geodesics import GeodesicDistance, Mesh, SurfacePoints, embedded, farthest_point_sampling
from geodesics.arrays import Integers
from geodesics.errors import BadArgument

MIDLINE = 0.5  # spacings of points, within which a point and its partner are one on the midline; set by hand


def even_points(mesh: Mesh, count: int) -> Integers:
    """`count` vertices (count,), each as far from all earlier ones as can be, the first as far as can be from vertex 0.

    Raises `BadArgument` (E604) for another number than from 1 to that of the vertices.
    """
    used = np.unique(mesh.faces)
    if not 1 <= count <= len(used):
        raise BadArgument(f"there can be from 1 to {len(used)} points, not {count}")
    distance = GeodesicDistance(embedded(mesh))
    first = int(distance.field(SurfacePoints.at_vertices(mesh, used[:1]))[0][used].argmax())
    return np.asarray(farthest_point_sampling(distance, count, first=int(used[first])), dtype=np.int64)


def paired_points(mesh: Mesh, partner: SurfacePoints, count: int) -> tuple[SurfacePoints, list[str]]:
    """About `count` points evenly spread, each with its partner on the other side, and their names.

    Points are called L1, R1, L2, R2, ... and M1, M2, ... on the midline; which side is L is a matter of chance.
    `partner`: where each vertex is on the other side, as a reversing `self_symmetry` tells.
    """
    order = even_points(mesh, min(count, len(np.unique(mesh.faces))))
    place, other = mesh.vertices, partner.positions
    spacing = float(np.sqrt(mesh.area / count))
    chosen: list[int] = []
    for vertex in order.tolist():
        taken = [*place[chosen], *other[chosen]]
        if not taken or np.linalg.norm(np.array(taken) - place[vertex], axis=1).min() > MIDLINE * spacing:
            chosen.append(vertex)
    middle = np.linalg.norm(place[chosen] - other[chosen], axis=1) <= MIDLINE * spacing
    faces, weights, names = [], [], []
    here = SurfacePoints.at_vertices(mesh, chosen)
    for i, vertex in enumerate(chosen):
        pair = [("M", here, i)] if middle[i] else [("L", here, i), ("R", partner, vertex)]
        number = int(middle[: i + 1].sum()) if middle[i] else int((~middle[: i + 1]).sum())
        for letter, points, row in pair:
            faces.append(points.face[row])
            weights.append(points.barycentric[row])
            names.append(f"{letter}{number}")
    return SurfacePoints(mesh, np.array(faces), np.array(weights)), names

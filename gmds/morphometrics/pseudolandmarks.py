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
    """Points evenly spread, each with its partner on the other side, and their names: `count`, or one more.

    Each is as far as can be from all earlier ones and their partners. They are called L1, R1, L2, R2, ... and M1, M2,
    ... on the midline; which side is L is a matter of chance. `partner`: where each vertex is on the other side, as a
    reversing `self_symmetry` tells.
    """
    used = np.unique(mesh.faces)
    count = min(count, len(used))
    distance = GeodesicDistance(embedded(mesh))
    apart = np.linalg.norm(mesh.vertices - partner.positions, axis=1)
    middle = apart <= MIDLINE * np.sqrt(mesh.area / count)
    faces, weights, names = [], [], list[str]()
    numbers = {True: 0, False: 0}
    nearest = np.full(mesh.n_vertices, np.inf)
    vertex = int(even_points(mesh, 1)[0])
    while len(names) < count and nearest[vertex] > 0:
        here, is_middle = SurfacePoints.at_vertices(mesh, [vertex]), bool(middle[vertex])
        numbers[is_middle] += 1
        for letter, points in [("M", here)] if is_middle else [("L", here), ("R", partner[[vertex]])]:
            faces.append(points.face[0])
            weights.append(points.barycentric[0])
            names.append(f"{letter}{numbers[is_middle]}")
            nearest = np.minimum(nearest, distance.field(points)[0])
        vertex = int(used[nearest[used].argmax()])
    return SurfacePoints(mesh, np.array(faces), np.array(weights)), names

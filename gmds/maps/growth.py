r"""What a map says of growth: how much lengths and areas around each vertex change from source to target.

Each source triangle and its image have a deformation gradient with principal stretches :math:`s_1 \ge s_2`. Of these

.. math:: \log s_1 s_2, \qquad \log \frac{s_1 + s_2}{2}

are the logarithm of the growth of the area, and the mean over all tangent directions of the logarithm of the growth of
length (the integral of :math:`\log \sqrt{s_1^2 \cos^2 + s_2^2 \sin^2}`); where growth has no direction the first is
twice the second. A map from triangles to triangles shakes by about the length of an edge, so both are averaged by an
implicit step of the heat equation over the source: areas of images with their sign, whose sum over a region only
depends on where the map sends its rim, and the trace-free part of the logarithmic strain, which shaking leaves zero
on average. What the map's own errors leave in the growth of the area is cleared away by `steps_and_slopes`, which keeps
the steep rim of a part that grew; where triangles are sheared much the map is likely to be off, and trusted less.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from geodesics import embedded, stiffness, vertex_normals
from geodesics.arrays import Bools, Floats, Integers
from geodesics.errors import BadArgument
from geodesics.linalg.factors import factorised
from geodesics.mesh import Mesh
from geodesics.topology.orientation import orient_faces
from gmds.maps.images import torn_faces
from gmds.maps.point_map import PointMap
from gmds.maps.steps_and_slopes import cleared
from gmds.maps.strain import frames, log_strain, principal, square

# Heat time, in units of the area of the source, and what the others are in units of it: heat time of the area, and of
# the shear that tells how far to trust it; strength of the clearing; and the shear (half log s1/s2) at which trust is
# a half. Chosen on the development pairs of `benchmarks.study.growth` (`benchmarks/results/growth_development.csv`).
SMOOTHING = 1e-3
OF_AREA = 0.1
OF_SHEAR = 0.3
CLEARING = 0.5
DOUBTED_SHEAR = 0.2
LEAST_SHARE = 0.02  # of known area around a vertex, below which its growth is unknown: a bound of extrapolation
LEAST_GROWTH = 1e-3  # of area, where images cancel: a bound


@dataclass(frozen=True, eq=False)
class Growth:
    """How a map changes lengths and areas around each of the n vertices of its source, NaN where that is unknown.

    Attributes
    ----------
    length : float64 array of shape (n,)
        The natural logarithm of the growth of length, the mean over all tangent directions.
    area : float64 array of shape (n,)
        The natural logarithm of the growth of area.
    stretches : float64 array of shape (n, 2)
        Principal stretches, the larger first: factors, 1 where nothing changes.
    direction : float64 array of shape (n, 3)
        The unit tangent, up to sign, along which the larger stretch is; it means little where both are nearly the same.
    smoothing : float
        Over what share of the area of the source these are averaged, as a heat time.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped
    >>> animal = quadruped(n_vertices=200)
    >>> larger, _ = gmds.global_scale(animal, 2.0)
    >>> growth = gmds.growth_between(animal, larger)
    >>> growth.stretches.shape, bool(abs(growth.relative).max() < 1e-6)
    ((200, 2), True)
    """

    length: Floats
    area: Floats
    stretches: Floats
    direction: Floats
    smoothing: float

    @property
    def relative(self) -> Floats:
        """`length` (n,) less its median: growth beside that of the whole, whatever units both meshes are in."""
        known = self.length[np.isfinite(self.length)]
        return np.asarray(self.length - (np.median(known) if len(known) else 0.0), dtype=np.float64)


def growth_of(answer: PointMap, smoothing: float = SMOOTHING) -> Growth:
    """The growth from source to target that a map says.

    Parameters
    ----------
    answer : Correspondence
        The map, or anything with its attributes; rows that are not valid have no say.
    smoothing : float
        Heat time in units of the area of the source, over which growth is averaged: features of a breadth of less than
        about 2 sqrt(smoothing * area) are not told apart.

    Returns
    -------
    Growth
        In the units of both meshes: a copy twice as large has grown by log 2 everywhere.

    Raises
    ------
    BadArgument
        E604 when the smoothing is not positive.

    See Also
    --------
    growth_between : Of two meshes with the same faces.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped
    >>> animal = quadruped(n_vertices=200)
    >>> import geodesics
    >>> import numpy as np
    >>> larger = geodesics.Mesh(2 * animal.vertices, animal.faces)
    >>> same = geodesics.SurfacePoints.at_vertices(larger, np.arange(animal.n_vertices))
    >>> growth = gmds.growth_of(gmds.Correspondence.from_points(animal, same))
    >>> [float(np.median(values).round(2)) for values in (growth.length, growth.area)]  # log 2 and log 4
    [0.69, 1.39]
    """
    image = answer.points.positions
    used = answer.valid[answer.source.faces].all(axis=1) & ~torn_faces(
        answer.source, image, np.sqrt(answer.target.area)
    )
    normals = answer.points.interpolate(vertex_normals(answer.target))
    return _growth(answer.source, image, normals, used, smoothing)


def growth_between(before: Mesh, after: Mesh, smoothing: float = SMOOTHING) -> Growth:
    """The growth from one mesh to another with the same faces, vertex i being vertex i.

    Parameters
    ----------
    before, after : Mesh
        Of n vertices each.
    smoothing : float
        As of `growth_of`.

    Returns
    -------
    Growth
        At the vertices of `before`.

    Raises
    ------
    BadArgument
        E604 when the faces differ, or the smoothing is not positive.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped
    >>> animal = quadruped(n_vertices=200)
    >>> import geodesics
    >>> larger = geodesics.Mesh(2 * animal.vertices, animal.faces)
    >>> float(gmds.growth_between(animal, larger).length.max().round(2))  # log 2
    0.69
    """
    if not np.array_equal(before.faces, after.faces):
        raise BadArgument("the two meshes must have the same faces")
    used = np.ones(before.n_faces, dtype=bool)
    return _growth(before, after.vertices, vertex_normals(after), used, smoothing)


def _growth(source: Mesh, image: Floats, normals: Floats, used: Bools, smoothing: float) -> Growth:
    if not smoothing > 0:
        raise BadArgument(f"smoothing must be a positive share of the area, not {smoothing!r}")
    faces = orient_faces(source).faces
    run, rise = frames(source.vertices, faces)[1], image[faces[:, 1:]] - image[faces[:, :1]]
    area = 0.5 * np.linalg.norm(np.cross(run[:, 0], run[:, 1]), axis=1)
    used = used & (area > 1e-12 * area.max())
    image_normal = 0.5 * np.cross(rise[:, 0], rise[:, 1])
    signed = np.copysign(np.linalg.norm(image_normal, axis=1), (image_normal * normals[faces].sum(axis=1)).sum(axis=1))
    signed *= np.sign(signed[used].sum()) or 1.0
    strain = np.where(used[:, None, None], log_strain(source.vertices, faces, rise), 0.0)
    area_used = area * used
    amounts = np.column_stack([signed * used, np.abs(signed) * used, area_used])
    smooth = _smoothed(source, faces, amounts, OF_AREA * smoothing)
    log_area, known = _log_growth(smooth)
    sheared = _smoothed(source, faces, np.column_stack([area_used, area * square(strain)]), OF_SHEAR * smoothing)
    doubt = sheared[:, 1] / np.maximum(sheared[:, 0], LEAST_SHARE) / DOUBTED_SHEAR**2
    trust = np.where(np.isfinite(log_area), known / (1 + doubt), 0.0)
    log_area = np.where(
        trust > 0, 2 * cleared(embedded(source), np.nan_to_num(log_area) / 2, trust, CLEARING * smoothing), np.nan
    )
    strained = _smoothed(source, faces, np.column_stack([area_used, area[:, None] * strain.reshape(-1, 9)]), smoothing)
    weight = np.maximum(strained[:, :1], LEAST_SHARE)[:, :, None]
    shear, direction = principal(strained[:, 1:].reshape(-1, 3, 3) / weight, vertex_normals(source))
    stretches = np.exp(log_area[:, None] / 2 + shear[:, None] * [1, -1])
    direction[np.isnan(log_area)] = np.nan
    return Growth(np.log(stretches.mean(axis=1)), log_area, stretches, direction, smoothing)


def _log_growth(smooth: Floats) -> tuple[Floats, Floats]:
    """The logarithm (n,) of the growth of area, NaN where unknown, and how much of the area around (n,) is known.

    `smooth` (n, 3): densities of the area of images with its sign, without, and of the area before.
    """
    known = smooth[:, 2] > LEAST_SHARE
    weight = np.where(known, smooth[:, 2], 1.0)
    kept = np.where(smooth[:, 0] > LEAST_GROWTH * smooth[:, 1], smooth[:, 0], LEAST_GROWTH * smooth[:, 1])
    log_area = np.where(known & (kept > 0), np.log(np.maximum(kept, 1e-300) / weight), np.nan)
    return log_area, np.clip(smooth[:, 2], 0.0, 1.0)


def _smoothed(source: Mesh, faces: Integers, amounts: Floats, smoothing: float) -> Floats:
    """Densities (n, c) of amounts per face (m, c) after one implicit heat step; 0 at vertices on no face."""
    metric = embedded(source)
    mass = metric.mass
    there = np.flatnonzero(mass > 0)
    diffusion = smoothing * mass.sum() * stiffness(metric)[there][:, there]
    per_vertex = np.zeros((source.n_vertices, amounts.shape[1]))
    for corner in faces.T:
        np.add.at(per_vertex, corner, amounts / 3)
    density = np.zeros_like(per_vertex)
    density[there] = factorised((sp.diags(mass[there]) + diffusion).tocsc()).solve(per_vertex[there])
    return density

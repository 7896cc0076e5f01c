r"""What a map says of growth: how much lengths and areas around each vertex change from source to target.

Each source triangle and its image have a deformation gradient with principal stretches :math:`s_1 \ge s_2`. Of these

.. math:: \log s_1 s_2, \qquad \log \frac{s_1 + s_2}{2}

are the logarithm of the growth of the area, and the mean over all tangent directions of the logarithm of the growth of
length (the integral of :math:`\log \sqrt{s_1^2 \cos^2 + s_2^2 \sin^2}`); where growth has no direction the first is
twice the second. A map from triangles to triangles shakes by about the length of an edge, so both are averaged by one
implicit step of the heat equation over the source: areas of images with their sign, whose sum over a region only
depends on where the map sends its rim, and the trace-free part of the logarithmic strain, which shaking leaves zero
on average.
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

# Heat time, in units of the area of the source: the least error of the growth field on the development pairs of
# `benchmarks.study.growth` (`benchmarks/results/growth.md`).
SMOOTHING = 1e-3
MOST_STRAIN = 2.0  # of half log s1/s2 of one triangle, a bound: more is a triangle that the map all but collapses
THINNEST = 1e-6  # breadth over length of a triangle, below which nothing is known across it: a bound
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
    run, rise = _frames(source.vertices, faces)[1], image[faces[:, 1:]] - image[faces[:, :1]]
    area = 0.5 * np.linalg.norm(np.cross(run[:, 0], run[:, 1]), axis=1)
    used = used & (area > 1e-12 * area.max())
    image_normal = 0.5 * np.cross(rise[:, 0], rise[:, 1])
    signed = np.copysign(np.linalg.norm(image_normal, axis=1), (image_normal * normals[faces].sum(axis=1)).sum(axis=1))
    signed *= np.sign(signed[used].sum()) or 1.0
    strain = np.where(used[:, None, None], _strain(source.vertices, faces, rise), 0.0)
    amounts = np.column_stack([signed, np.abs(signed), np.ones(len(area))]) * used[:, None]
    amounts[:, 2] *= area
    smooth = _smoothed(source, faces, np.column_stack([amounts, area[:, None] * strain.reshape(-1, 9)]), smoothing)
    known = smooth[:, 2] > LEAST_SHARE
    weight = np.where(known, smooth[:, 2], 1.0)
    kept = np.where(smooth[:, 0] > LEAST_GROWTH * smooth[:, 1], smooth[:, 0], LEAST_GROWTH * smooth[:, 1])
    log_area = np.where(known & (kept > 0), np.log(np.maximum(kept, 1e-300) / weight), np.nan)
    shear, direction = _principal(smooth[:, 3:].reshape(-1, 3, 3) / weight[:, None, None], vertex_normals(source))
    stretches = np.exp(log_area[:, None] / 2 + shear[:, None] * [1, -1])
    direction[np.isnan(log_area)] = np.nan
    return Growth(np.log(stretches.mean(axis=1)), log_area, stretches, direction, smoothing)


def _frames(vertices: Floats, faces: Integers) -> tuple[Floats, Floats]:
    """Two orthonormal tangents (m, 2, 3) of each face, and two of its edges (m, 2, 3)."""
    run = vertices[faces[:, 1:]] - vertices[faces[:, :1]]
    tiny = np.finfo(float).tiny
    one = run[:, 0] / np.maximum(np.linalg.norm(run[:, 0], axis=1, keepdims=True), tiny)
    other = run[:, 1] - (run[:, 1] * one).sum(axis=1, keepdims=True) * one
    other /= np.maximum(np.linalg.norm(other, axis=1, keepdims=True), tiny)
    return np.stack([one, other], axis=1), run


def _strain(vertices: Floats, faces: Integers, rise: Floats) -> Floats:
    """The trace-free logarithmic strain (m, 3, 3) of each face, whose edges become `rise` (m, 2, 3)."""
    frame, run = _frames(vertices, faces)
    flat = np.einsum("mei,mki->mek", run, frame)  # edges in the frame of their face
    gradient = np.einsum("mke,mei->mki", np.linalg.pinv(flat, rcond=THINNEST), rise)
    metric = np.einsum("mki,mli->mkl", gradient, gradient)
    values, vectors = np.linalg.eigh(metric)
    logs = np.log(np.maximum(values, np.finfo(float).tiny))
    shear = np.clip(0.25 * (logs[:, 1] - logs[:, 0]), 0.0, MOST_STRAIN)
    axes = np.einsum("mkj,mki->mji", vectors, frame)
    outer = axes[:, 1, :, None] * axes[:, 1, None, :] - axes[:, 0, :, None] * axes[:, 0, None, :]
    return np.asarray(shear[:, None, None] * outer, dtype=np.float64)


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


def _principal(strain: Floats, normals: Floats) -> tuple[Floats, Floats]:
    """Half of log s1/s2 (n,), and the direction of s1 (n, 3), of trace-free strains (n, 3, 3) of tangent planes."""
    across = np.eye(3) - normals[:, :, None] * normals[:, None, :]
    flat = across @ strain @ across
    values, vectors = np.linalg.eigh((flat + np.swapaxes(flat, 1, 2)) / 2)
    return np.asarray((values[:, 2] - values[:, 0]) / 2, dtype=np.float64), vectors[:, :, 2].copy()

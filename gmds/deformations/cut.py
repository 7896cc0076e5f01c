r"""Parts cut off, by a plane or by geodesic balls, until a share of the area is gone."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from geodesics import GeodesicDistance, Mesh, SurfacePoints, embedded
from geodesics.arrays import Floats, Integers
from geodesics.errors import BadArgument, IndexOutOfRange
from gmds.deformations.directions import unit
from gmds.deformations.kept_faces import largest_piece, part
from gmds.deformations.truths import Part

SMALLEST_BALL = 0.5  # radius of the smallest of several balls, as a share of that of the largest; set by hand
TIES = 1e-9  # of the largest order of a face, below which two faces are taken to be equally far: rounding errors


def cut(
    mesh: Mesh,
    share: float = 0.3,
    *,
    normal: ArrayLike | None = None,
    centre: int | None = None,
    count: int = 1,
    rng: int = 0,
) -> Part:
    r"""Cut off a share of the area, and keep the largest component of the rest.

    What goes is the side of a plane that its normal points to, or a geodesic ball around a vertex, or else the union of
    several balls around random vertices, of random radii: the faces whose middle has

    .. math:: \min_i d(x, c_i) / u_i < r,

    with geodesic distances :math:`d` and :math:`u_i` between 0.5 and 1. Place of the plane, or :math:`r`, follow from
    the share. Cuts run along edges. Remaining vertices keep their order and place.

    Parameters
    ----------
    mesh : Mesh
        The mesh, of n vertices.
    share : float
        Of the area, in [0, 1): what is gone in the end, smaller components included, as nearly as faces allow. Where a
        slightly larger cut would free a whole limb, the limb goes or stays, whichever is nearer.
    normal : array_like of shape (3,), optional
        Of the plane, in the coordinates of the mesh and of any length.
    centre : int, optional
        The vertex in the middle of the ball.
    count : int
        Balls around random vertices, where neither `normal` nor `centre` is given. Several make
        parts in the manner of PFAUST [1]_.
    rng : int
        Seed of the random choices.

    Returns
    -------
    Part
        ``mesh, truth``, as of every deformation, and `missing`.

    Raises
    ------
    ValueError
        For a share outside [0, 1), for both a normal and a centre, no direction, no ball, or when nothing is left.
    IndexOutOfRange
        E105 for a centre that is no vertex.

    See Also
    --------
    scan : What is seen from one side.
    holes : Holes of a given size.

    References
    ----------
    .. [1] Bracha, Dages, Kimmel, "On unsupervised partial shape correspondence", ACCV 2024: PFAUST, in which the balls
       (4 or 13) have one radius (0.16 or 0.1) and the largest component is kept.
    """
    mesh = Mesh.from_object(mesh)
    if not 0 <= share < 1:
        raise BadArgument(f"share must be at least 0 and below 1, not {share}")
    if normal is not None and centre is not None:
        raise BadArgument("give either the normal of a plane or the centre of a ball, not both")
    if normal is not None:
        order = -mesh.vertices[mesh.faces].mean(axis=1) @ unit(normal)
    else:
        order = _balls(mesh, centre, count, rng)[mesh.faces].mean(axis=1)
    faces = _nearest_share(mesh, _ranked(order), share)
    if len(faces) == 0:
        raise BadArgument(f"a cut of {share} of the area leaves nothing; ask for a smaller one")
    return part(mesh, faces)


def _balls(mesh: Mesh, centre: int | None, count: int, rng: int) -> Floats:
    """Distance (n,) of every vertex to the nearest centre, in units of the radius of its ball; inf out of reach."""
    if centre is not None:
        if not 0 <= centre < mesh.n_vertices:
            raise IndexOutOfRange(f"centre {centre} is none of the {mesh.n_vertices} vertices")
        centres, radii = np.array([centre]), np.ones(1)
    else:
        if count < 1:
            raise BadArgument(f"count must be at least 1, not {count}")
        random = np.random.default_rng(rng)
        centres = random.permutation(np.unique(mesh.faces))[:count]
        radii = random.uniform(SMALLEST_BALL, 1, len(centres))
    field = GeodesicDistance(embedded(mesh)).field(SurfacePoints.at_vertices(mesh, centres))
    nearest: Floats = (field / radii[:, None]).min(axis=0)
    return nearest


def _ranked(order: Floats) -> Integers:
    """Faces (m,), the first to go first; of those equally far that with the smaller number."""
    finite = np.isfinite(order)
    low, high = order[finite].min(), order[finite].max()
    steps = np.full(len(order), np.inf)
    steps[finite] = np.rint((order[finite] - low) / max(high - low, np.finfo(float).tiny) / TIES)
    return np.argsort(steps, kind="stable")


def _nearest_share(mesh: Mesh, ranked: Integers, share: float) -> Integers:
    """The largest piece (k, 3) of what is left without the first so many faces, of an area nearest to that wanted."""

    def left(count: int) -> tuple[Integers, float]:
        faces = largest_piece(mesh, mesh.faces[np.sort(ranked[count:])])
        return faces, 1 - Mesh(mesh.vertices, faces).area / mesh.area if len(faces) else 1.0

    low, high = 0, len(ranked)  # the more goes, the smaller the largest piece
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if left(middle)[1] <= share else (low, middle)
    fewer, more = left(low), left(high)
    return fewer[0] if share - fewer[1] <= more[1] - share or len(more[0]) == 0 else more[0]

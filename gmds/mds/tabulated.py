"""A distance written down once, from a few hundred fields, so that any pair of points is a short sum."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from geodesics import Distance, Mesh, SurfacePoints, farthest_point_sampling
from geodesics.arguments import is_whole
from geodesics.arrays import Floats, Integers
from geodesics.distance import as_distance, as_points
from geodesics.errors import BadArgument
from geodesics.topology.components import vertex_components

COLUMNS = 16384  # vertices that coordinates are computed of together: a bound of memory


@dataclass(frozen=True, eq=False, init=False)
class TabulatedDistance:
    r"""A distance as a pseudo-Euclidean embedding, so that any pair of points is a short sum, as sec. 5 has need of.

    .. math:: d(x, y)^2 = \sum_k \sigma_k \, (e_k(x) - e_k(y))^2, \qquad \sigma_k = \pm 1

    by classical scaling of the squared distances between some farthest points, extended to all vertices. Geodesic
    distances come out within a few thousandths of their mean. Never n x n: landmarks x n numbers are held while it is
    made, rank x n afterwards.

    Parameters
    ----------
    distance : Distance
        What is tabulated.
    landmarks : int
        Farthest points whose fields are computed, 2 at the least.
    rank : int
        Number of coordinates: those of the largest eigenvalues in size.

    Attributes
    ----------
    distance : Distance
        What was tabulated.
    embedding : float64 array of shape (n, k)
        :math:`e`, in units of the distance.
    signature : float64 array of shape (k,)
        :math:`\sigma`.

    Raises
    ------
    ValueError
        For fewer than 2 landmarks or a rank below 1.

    References
    ----------
    Shamai, Kimmel: Geodesic distance descriptors (2017).

    See Also
    --------
    Problem : Takes it as either distance.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped
    >>> source = quadruped(n_vertices=300)
    >>> import geodesics
    >>> table = gmds.TabulatedDistance(geodesics.GeodesicDistance(source), landmarks=50)
    >>> table.field(0).shape
    (1, 300)
    """

    distance: Distance
    embedding: Floats
    signature: Floats

    def __init__(self, distance: Distance, landmarks: int = 300, rank: int = 120) -> None:
        if not (is_whole(landmarks) and is_whole(rank)) or landmarks < 2 or rank < 1:
            raise BadArgument(f"a table needs 2 landmarks and rank 1 at least, not {landmarks!r:.40} and {rank!r:.40}")
        mesh = as_distance(distance).mesh
        label = vertex_components(mesh)
        chosen = farthest_point_sampling(distance, min(landmarks, int((label >= 0).sum())))
        fields = distance.field(SurfacePoints.at_vertices(mesh, chosen))
        blocks = [_scaled_component(fields, chosen, label, c, rank) for c in range(label.max() + 1)]
        object.__setattr__(self, "distance", distance)
        object.__setattr__(self, "embedding", np.concatenate([block for block, _ in blocks], axis=1))
        object.__setattr__(self, "signature", np.concatenate([sign for _, sign in blocks]))

    def __repr__(self) -> str:
        return f"TabulatedDistance({self.embedding.shape[1]} coordinates of {self.distance!r})"

    @property
    def mesh(self) -> Mesh:
        """The mesh whose vertices distances are given at."""
        return self.distance.mesh

    def field(self, points: SurfacePoints | ArrayLike) -> Floats:
        """Distances (p, n) from each of p points to every vertex, by the distance itself."""
        return self.distance.field(as_points(self.mesh, points))


def _scaled_component(
    fields: Floats, chosen: Integers, label: Integers, component: int, rank: int
) -> tuple[Floats, Floats]:
    """Embedding (n, k) of one component, zero elsewhere, and its signature (k,)."""
    own, there = np.flatnonzero(label[chosen] == component), np.flatnonzero(label == component)
    between = fields[np.ix_(own, chosen[own])] ** 2
    between = 0.5 * (between + between.T)
    centred = -0.5 * _centred(_centred(between).T)
    values, vectors = np.linalg.eigh(centred)
    order = np.argsort(-np.abs(values), kind="stable")[: max(1, min(rank, len(own) // 2))]
    order = order[np.abs(values[order]) > 1e-9 * np.abs(values).max()]
    values, vectors = values[order], vectors[:, order]
    embedding, mean = np.zeros((len(label), len(order))), between.mean(axis=1, keepdims=True)
    for some in np.split(there, range(COLUMNS, len(there), COLUMNS)):
        extended = -0.5 * _centred(fields[np.ix_(own, some)] ** 2 - mean)
        embedding[some] = extended.T @ (vectors * (np.sign(values) / np.sqrt(np.abs(values))))
    return embedding, np.sign(values)


def _centred(rows: Floats) -> Floats:
    """Each column minus its mean."""
    return rows - rows.mean(axis=0)

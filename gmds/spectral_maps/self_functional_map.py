"""Self functional maps: one surface in two metrics."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from geodesics import Mesh, Metric, eigenpairs, embedded, scale_invariant
from geodesics.arrays import Floats
from geodesics.errors import BadArgument
from gmds.surface.view import View


def self_functional_map(
    mesh: Mesh,
    count: int = 20,
    *,
    metrics: tuple[Callable[[Mesh], Metric], Callable[[Mesh], Metric]] = (embedded, scale_invariant),
) -> Floats:
    r"""How the eigenfunctions of one surface in two metrics are made of each other, beside sec. 4.

    .. math:: C_{ij} = \int_S \tilde\phi_i \, \phi_j \, d\tilde a

    with :math:`\phi` in the first metric, that of space unless given, and :math:`\tilde\phi` and the area
    :math:`d\tilde a` in the second, the scale-invariant one (2.1): the functional map of the identity. It is the same
    for isometric surfaces, but for the signs of eigenfunctions, and needs no map between shapes to compare them.

    Parameters
    ----------
    mesh : Mesh
        The surface.
    count : int
        Eigenfunctions in each metric.
    metrics : two functions Mesh -> Metric
        The metrics.

    Returns
    -------
    array of shape (count, count)
        :math:`C`; rows belong to the second metric. Each eigenfunction has its sign by chance.

    Raises
    ------
    ValueError
        When the surface has fewer eigenfunctions.

    References
    ----------
    Halimi, Kimmel: Self functional maps (2018).

    See Also
    --------
    self_functional_features : Without signs, for `retrieve`.
    functional_map : Between two surfaces.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped
    >>> animal = quadruped(n_vertices=200)
    >>> gmds.self_functional_map(animal, 8).shape
    (8, 8)
    """
    mesh = Mesh.from_object(mesh)
    if not isinstance(metrics, tuple | list) or len(metrics) != 2 or not all(map(callable, metrics)):
        raise BadArgument(f"metrics must be two functions, as (embedded, scale_invariant), not {metrics!r:.60}")
    first, second = (View.of(eigenpairs(metric(mesh), count)) for metric in metrics)
    if min(first.functions.shape[1], second.functions.shape[1]) < count:
        raise BadArgument(f"{mesh!r} has fewer than {count} eigenfunctions")
    return np.asarray((second.spectrum.mass[:, None] * second.functions).T @ first.functions, dtype=np.float64)


def self_functional_features(mesh: Mesh, count: int = 20) -> Floats:
    """The self functional map without signs, as a vector for `gmds.retrieve` and for distances between shapes.

    Parameters
    ----------
    mesh : Mesh
        The surface.
    count : int
        Eigenfunctions in each metric.

    Returns
    -------
    array of shape (count^2,)
        The magnitudes of the entries of `self_functional_map` over `count`.

    References
    ----------
    Halimi, Kimmel: Self functional maps (2018). Metrics: sec. 2 and (2.1).

    See Also
    --------
    retrieve : ``gmds.retrieve(query, collection, self_functional_features)``.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped
    >>> animal = quadruped(n_vertices=200)
    >>> gmds.self_functional_features(animal, 8).shape
    (64,)
    """
    return np.abs(self_functional_map(mesh, count)).ravel() / count

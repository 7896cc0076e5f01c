"""Functional maps from descriptors, by least squares."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse.linalg import LinearOperator, cg

from geodesics import Mesh, Metric, Spectrum, SurfacePoints, wave_kernel_signature
from geodesics.arguments import real_numbers, whole_number
from geodesics.arrays import Bools, Floats
from geodesics.errors import BadArgument, BadShape
from geodesics.spectrum import as_spectrum
from gmds.spectral_maps.operators import multiplication, orientation_operator
from gmds.spectral_maps.representation import BOTH, FunctionalMap, points_for
from gmds.surface.view import View

Surface = Spectrum | Metric | Mesh
SIGNS = {"preserve": 1.0, "reverse": -1.0, "any": 0.0}

# Weights of the terms beside that of the descriptors, 1, each term a mean square: set by hand, after those that the
# references give; maps of development pairs hardly change when any of them is a third or three times as large.
EIGENVALUES = 0.1
PRODUCTS = 0.6
ORIENTATION = 2.0
OPERATORS = 12  # descriptors, spread over all, that make operators; set by hand: each costs two products an iteration
SAME = 1e-9  # of the largest value, by which descriptors differ that are one but for rounding: a bound, far above it
LARGE = 1e100  # numbers up to this, and down to its inverse, can be squared and summed in float64: a bound
TINY = np.finfo(float).tiny  # what keeps divisions from 0
ENERGIES = 40  # of the wave-kernel signatures that are compared where no descriptors are given; set by hand


def functional_map(
    source: Surface,
    target: Surface,
    descriptors: tuple[ArrayLike, ArrayLike] | None = None,
    *,
    points: SurfacePoints | ArrayLike | Any | None = None,
    count: int = 30,
    orientation: Literal["preserve", "reverse", "any"] = "preserve",
) -> FunctionalMap:
    r"""The functional map of two surfaces from descriptors, or from a map of points (sec. 4).

    .. math:: \min_C \| C B - A \|^2 + a \| \Lambda_S C - C \Lambda_Q \|^2
              + b \sum_f \| M_f C - C M_g \|^2 + c \sum_f \| \Omega_f C \mp C \Omega_g \|^2

    where columns of A and B are descriptors f and g in eigenfunctions of source and target, M multiplies by a
    descriptor, and the orientation operator :math:`\Omega` tells a map from its mirror image.

    Parameters
    ----------
    source, target : Spectrum, Metric or Mesh
        The surfaces in any two metrics; of a metric, or a mesh with its embedded metric, the first 100 eigenpairs.
    descriptors : pair of array_like of shape (n, d) and (n_target, d), optional
        What is alike at corresponding points, a column a descriptor. Without them, and without points, wave-kernel
        signatures.
    points : SurfacePoints, array_like of int of shape (n,), or Correspondence, optional
        In place of descriptors: the point, or the vertex, of the target for each source vertex.
    count : int
        Eigenfunctions of each surface.
    orientation : {"preserve", "reverse", "any"}
        What the map does to the orientation; with "any" that is not asked, and reflections are as good as what they
        reflect.

    Returns
    -------
    FunctionalMap
        `zoomed_out` refines it, `points` gives the point map.

    Raises
    ------
    ValueError
        For arguments that cannot be.
    MeshError
        E108 where descriptors or points have another number of rows than the surface has vertices.

    References
    ----------
    Ovsjanikov et al.: Functional maps (2012); Nogneng, Ovsjanikov: Informative descriptor preservation via
    commutativity for shape matching (2017); Ren, Poulenard, Wonka, Ovsjanikov: Continuous and orientation-preserving
    correspondences via functional maps (2018). Eigenfunctions in any metric: sec. 4 of Aflalo, Kimmel, Raviv (2013).

    See Also
    --------
    spectral_gmds : From distances.
    match : A map without any of these.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped, truth
    >>> source, target = quadruped(n_vertices=200), quadruped('walk', n_vertices=200)
    >>> import geodesics
    >>> found = gmds.functional_map(*(geodesics.eigenpairs(mesh, 30) for mesh in (source, target)), count=10)
    >>> found.matrix.shape
    (10, 10)
    """
    if not isinstance(orientation, str) or orientation not in SIGNS:
        raise BadArgument(f"orientation must be one of {', '.join(map(repr, SIGNS))}, not {orientation!r}")
    ours, theirs = (View.of(as_spectrum(surface)) for surface in (source, target))
    most = min(ours.functions.shape[1], theirs.functions.shape[1])
    count = whole_number(count, "count", 1, most, BOTH)
    if points is not None:
        if descriptors is not None:
            raise BadArgument("give descriptors or points, not both")
        return FunctionalMap.of_points(ours, theirs, points_for(ours, theirs, points), count)
    if descriptors is None:
        descriptors = _signature(ours), _signature(theirs)
    f, g = _scaled(descriptors, ours, theirs)
    return FunctionalMap(ours, theirs, _fitted(ours, theirs, f, g, count, SIGNS[orientation]))


def _signature(view: View) -> Floats:
    return wave_kernel_signature(view.spectrum, ENERGIES)


def _scaled(descriptors: tuple[ArrayLike, ArrayLike], source: View, target: View) -> tuple[Floats, Floats]:
    """Descriptors (n, d) and (n_target, d), each column with a mean square of 1 over both surfaces."""
    if not isinstance(descriptors, tuple | list) or len(descriptors) != 2:
        raise BadArgument("descriptors must be a pair, those of the source and those of the target")
    f, g = (real_numbers(values, "descriptors") for values in descriptors)
    f, g = (values[:, None] if values.ndim == 1 else values for values in (f, g))
    for values, view, name in ((f, source, "source"), (g, target, "target")):
        if values.ndim != 2 or len(values) != view.mesh.n_vertices or values.shape[1] != f.shape[1]:
            raise BadShape(f"descriptors of the {name} must be ({view.mesh.n_vertices}, d), not {values.shape}")
        there = values[view.usable]
        if not np.isfinite(there).all():
            raise BadArgument(f"descriptors of the {name} must be finite")
        if not (np.ptp(there, axis=0) > SAME * np.abs(there).max(axis=0)).any():
            raise BadArgument(f"descriptors of the {name} are the same at all its vertices: none can be told apart")
    f, g = np.nan_to_num(f), np.nan_to_num(g)
    largest = np.maximum(np.abs(f).max(axis=0), np.abs(g).max(axis=0))
    f, g = (values / np.where(_squarable(largest), 1.0, largest) for values in (f, g))
    both = source.spectrum.mass @ f**2 + target.spectrum.mass @ g**2
    scale = np.sqrt(2 / np.maximum(both, TINY))
    return f * scale, g * scale


def _squarable(values: Floats) -> Bools:
    """Numbers whose squares, and sums of these, stay within float64, and 0."""
    return (values < LARGE) & ((values > 1 / LARGE) | (values == 0))


def _fitted(source: View, target: View, f: Floats, g: Floats, count: int, sign: float) -> Floats:
    """The minimiser (count, count), by conjugate gradients on the normal equations."""
    a, b = (
        (view.spectrum.mass[:, None] * view.functions[:, :count]).T @ values
        for view, values in ((source, f), (target, g))
    )
    chosen = np.unique(np.linspace(0, f.shape[1] - 1, OPERATORS).astype(int))
    pairs = [
        (weight * turn, operator)
        for weight, turn, operator in ((PRODUCTS, 1.0, multiplication), (ORIENTATION, sign, orientation_operator))
        if turn != 0
    ]
    left, right = [], []
    for weight, operator in pairs:
        here = np.stack([operator(source, f[:, j], count) for j in chosen])
        there = np.stack([operator(target, g[:, j], count) for j in chosen])
        scale = np.sqrt(abs(weight) * count / max((here**2).sum() + (there**2).sum(), TINY))
        left.append(scale * here)
        right.append(scale * np.sign(weight) * there)
    operators = np.concatenate(left), np.concatenate(right)
    ours, theirs = source.eigenvalues[:count], target.eigenvalues[:count]
    gaps = EIGENVALUES * count * ((ours[:, None] - theirs) / max(0.5 * (ours[-1] + theirs[-1]), TINY)) ** 2
    d = f.shape[1]

    def normal(flat: Floats) -> Floats:
        c = flat.reshape(count, count)
        rest = operators[0] @ c - c @ operators[1]
        back = operators[0].transpose(0, 2, 1) @ rest - rest @ operators[1].transpose(0, 2, 1)
        return np.asarray((c @ b @ b.T / d + gaps * c + back.sum(axis=0)).ravel())

    system = LinearOperator((count**2, count**2), matvec=normal, dtype=np.float64)
    solution, _ = cg(system, (a @ b.T / d).ravel(), rtol=1e-6, maxiter=2000)
    return np.asarray(solution.reshape(count, count), dtype=np.float64)

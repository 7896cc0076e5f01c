"""The canonical form of a surface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from geodesics import (
    Distance,
    Mesh,
    Spectrum,
    SurfacePoints,
    eigenpairs,
    embedded,
    farthest_point_sampling,
    voronoi_cells,
)
from geodesics.arguments import whole_number
from geodesics.arrays import Floats, Integers
from geodesics.distance import as_distance
from geodesics.errors import BadArgument
from geodesics.euclidean import euclidean_distances
from gmds.canonical_forms._checked import known_weights
from gmds.canonical_forms.classical import classical_scaling
from gmds.canonical_forms.smacof import smacof, stress_of
from gmds.canonical_forms.spectral import spectral_scaling, squared_distances_in_eigenfunctions

Method = Literal["least squares", "classical", "spectral"]
METHODS: tuple[Method, ...] = ("least squares", "classical", "spectral")

SAMPLES = 300  # of a surface, by which its distances are known; set by hand, as many as `TabulatedDistance` takes
FUNCTIONS = 100  # eigenfunctions of the spectral form; set by hand
STEPS = 30  # of each vertex towards its place among the samples: the stress then changes by less than a thousandth


@dataclass(frozen=True, eq=False)
class CanonicalForm:
    """A surface bent into a Euclidean space: the vertices at `positions` (n, m), in the unit of the distance.

    `samples` (p,) are the vertices whose distances were kept; `stress` is the root mean square of |d - |x - y|| between
    them over the root mean square of d. Vertices on no face, or out of reach of
    the samples, have rows of NaN.

    See Also
    --------
    canonical_form : Makes one.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped
    >>> animal = quadruped(n_vertices=200)
    >>> import geodesics
    >>> form = gmds.canonical_form(geodesics.BiharmonicDistance(animal), dimension=2, method='classical')
    >>> form.positions.shape
    (200, 2)
    """

    mesh: Mesh
    positions: Floats
    samples: Integers
    stress: float

    def __repr__(self) -> str:
        return f"CanonicalForm({self.positions.shape[1]} dimensions, stress {self.stress:.4g}, of {self.mesh!r})"

    @property
    def bent(self) -> Mesh:
        """The form as a mesh with the same faces, of its first three coordinates; vertices on no face are at 0."""
        if self.positions.shape[1] < 3:
            raise BadArgument(f"a form in {self.positions.shape[1]} dimensions is no mesh; ask for three")
        known = np.asarray(np.isfinite(self.positions).all(axis=1))
        if not known[self.mesh.faces].all():
            raise BadArgument("a form is a mesh where no vertex is out of reach of the samples")
        return Mesh(np.where(known[:, None], self.positions[:, :3], 0.0), self.mesh.faces)


def canonical_form(
    distance: Distance,
    dimension: int = 3,
    *,
    method: Method = "least squares",
    samples: int | ArrayLike = SAMPLES,
    weights: ArrayLike | Literal["area"] | None = None,
) -> CanonicalForm:
    r"""The canonical form of a surface: points in m dimensions with its distances, beside sec. 5.

    .. math:: \min_X \sum_{i,j} w_i w_j \, \big( d(s_i, s_j) - |x_i - x_j| \big)^2

    Isometric surfaces have the same form but for a rigid motion and what cannot be embedded; in the scale-invariant
    metric so have surfaces whose parts changed size. Unlike generalised multidimensional scaling, which places one
    surface on another, this pays for the curvature that no Euclidean space has.

    Parameters
    ----------
    distance : Distance
        Any distance of the surface: geodesic, diffusion, commute time, in any metric.
    dimension : int
        m, at least 1.
    method : {"least squares", "classical", "spectral"}
        The stress above by majorisation (`smacof`); its squared distances (`classical_scaling`); or these written in
        eigenfunctions (`spectral_scaling`), of the spectrum of the distance where it has one.
    samples : int or array_like of int
        Vertices whose distances are kept, or how many farthest points are. The other vertices are placed by their
        distances to these.
    weights : array_like of shape (p,) or "area", optional
        How much each sample counts: equal unless given, or the area nearest to each. For the spectral form they have no
        say.

    Returns
    -------
    CanonicalForm
        With a position for each vertex; NaN for those that samples cannot reach.

    Raises
    ------
    MeshError
        E105 to E107 for samples that are no vertices on a face.
    ValueError
        For samples that cannot reach each other, and arguments that cannot be.

    References
    ----------
    Elad, Kimmel: On bending invariant signatures for surfaces (2003); Bronstein, Bronstein, Kimmel: Three-dimensional
    face recognition (2005); Aflalo, Kimmel: Spectral multidimensional scaling (2013). With (2.1) of Aflalo, Kimmel,
    Raviv (2013) as the metric: a form that local scale does not change.

    See Also
    --------
    geodesics.distance_matrix : The distances alone.
    solve : Places a surface on another.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped
    >>> animal = quadruped(n_vertices=200)
    >>> import geodesics
    >>> form = gmds.canonical_form(geodesics.GeodesicDistance(animal), samples=40)
    >>> form.positions.shape
    (200, 3)
    """
    distance = as_distance(distance)
    if method not in METHODS:
        raise BadArgument(f"method must be one of {METHODS}, not {method!r}")
    dimension = whole_number(dimension, "dimension", 1)
    chosen = _samples(distance, samples)
    fields = distance.field(chosen)  # type: ignore[arg-type]
    d = 0.5 * (fields[:, chosen] + fields[:, chosen].T)
    if not np.isfinite(d).all():
        raise BadArgument("some samples cannot reach each other; take those of one component")
    w = _weights(distance, chosen, weights)
    if method == "spectral":
        spectrum = _spectrum(distance)
        most = len(spectrum.eigenvalues) - 1
        dimension = whole_number(dimension, "dimension", 1, most, "the eigenfunctions but for the constant one")
        positions = spectral_scaling(spectrum, squared_distances_in_eigenfunctions(spectrum, chosen, d), dimension)
    elif method == "classical":
        positions = _extended(fields, d, classical_scaling(d, dimension, w), w)
    else:
        places = smacof(d, dimension, w)
        positions = _settled(fields, places, _extended(fields, d, places, w), w)
        positions[chosen] = places
    positions[~np.isfinite(fields).all(axis=0)] = np.nan
    placed = positions[chosen]
    stress = stress_of(d, euclidean_distances(placed, placed), w) / stress_of(d, np.zeros_like(d), w)
    return CanonicalForm(distance.mesh, positions, chosen, float(np.sqrt(stress)))


def _samples(distance: Distance, samples: int | ArrayLike) -> Integers:
    if np.ndim(samples) == 0:
        most = len(np.unique(distance.mesh.faces))
        return farthest_point_sampling(distance, min(whole_number(samples, "samples", 2), most))
    places = SurfacePoints.at_vertices(distance.mesh, samples)  # raises E105 to E107
    chosen = distance.mesh.faces[places.face, places.barycentric.argmax(axis=1)]
    if len(chosen) < 2 or len(np.unique(chosen)) < len(chosen):
        raise BadArgument(f"samples must be two different vertices at least, none given twice, not {samples!r:.60}")
    return np.asarray(chosen, dtype=np.int64)


def _weights(distance: Distance, chosen: Integers, weights: ArrayLike | str | None) -> Floats:
    if weights is None:
        return np.full(len(chosen), 1 / len(chosen))
    if isinstance(weights, str):
        if weights != "area":
            raise BadArgument(f"weights must be numbers or 'area', not {weights!r}")
        mass = getattr(distance, "spectrum", getattr(distance, "metric", None) or embedded(distance.mesh)).mass
        cell = voronoi_cells(distance, chosen)
        share = np.bincount(cell[cell >= 0], mass[cell >= 0], len(chosen))
        return np.asarray(np.maximum(share, 1e-3 * share.mean()) / share.sum(), dtype=np.float64)
    return known_weights(weights, len(chosen))


def _spectrum(distance: Distance) -> Spectrum:
    """That of the distance, else of its metric, else of the metric of space."""
    spectrum = getattr(distance, "spectrum", None)
    if isinstance(spectrum, Spectrum):
        return spectrum
    metric = getattr(distance, "metric", None) or embedded(distance.mesh)
    return eigenpairs(metric, min(FUNCTIONS, len(np.unique(distance.mesh.faces))))


def _extended(fields: Floats, d: Floats, places: Floats, w: Floats) -> Floats:
    """All vertices (n, m) by Gower's formula, from their distances (p, n) to samples at centred `places` (p, m)."""
    squared = np.nan_to_num(fields, posinf=0.0).T ** 2
    spread = places.T @ (w[:, None] * places)
    inner = -0.5 * (squared - d**2 @ w) @ (w[:, None] * places)
    return np.asarray(inner @ np.linalg.pinv(spread, hermitian=True), dtype=np.float64)


def _settled(fields: Floats, places: Floats, positions: Floats, w: Floats) -> Floats:
    """Positions (n, m) after Guttman transforms of each vertex, the samples staying at their `places`."""
    d = np.nan_to_num(fields, posinf=0.0).T
    for _ in range(STEPS):
        between = euclidean_distances(positions, places)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.where(between > 0, d / between, 0.0) * w
        positions = w @ places + ratio.sum(axis=1)[:, None] * positions - ratio @ places
    return positions

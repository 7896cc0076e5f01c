"""Diffusion distances: Euclidean distances between rows of an embedding by eigenfunctions (sec. 3)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from geodesics._kernels.spreading import closer_rows
from geodesics.arguments import real_number
from geodesics.arrays import Floats, Integers
from geodesics.distance import FEWER_POINTS, as_points
from geodesics.euclidean import euclidean_distances
from geodesics.memory import table
from geodesics.mesh import Mesh
from geodesics.metric import Metric
from geodesics.points import SurfacePoints
from geodesics.spectrum import Spectrum, as_spectrum
from geodesics.topology.components import vertex_components

# Rows of a field that are computed at a time, so that temporaries stay in the cache. Measured with 1,500 rows of 5,000
# vertices: 0.17 s; with 32, 128, 512 and 1,500 rows at a time 0.95, 0.23, 0.30 and 0.28 s.
_BLOCK = 256
# Of a diffusion distance unless the caller says otherwise: the one that `match` compares, chosen on development pairs
# (benchmarks/results/notes.md, "Embedding").
DEFAULT_TIME = 3e-3
# An eigenvalue of a surface of unit area that is rounding: what is left where the shift, of order 1, is subtracted.
NOTHING = 1e-13


@dataclass(frozen=True, eq=False, init=False)
class _SpectralDistance:
    """Distance :math:`d(x, y) = |e(x) - e(y)|` with an embedding e (n, k) that is linear on faces."""

    mesh: Mesh
    spectrum: Spectrum
    embedding: Floats

    def _set(self, spectrum: Spectrum, embedding: Floats) -> None:
        embedding = np.ascontiguousarray(embedding)
        embedding.setflags(write=False)
        object.__setattr__(self, "mesh", spectrum.mesh)
        object.__setattr__(self, "spectrum", spectrum)
        object.__setattr__(self, "embedding", embedding)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.embedding.shape[1]} coordinates on {self.mesh!r})"

    def field(self, points: SurfacePoints | ArrayLike) -> Floats:
        """Distances from each of p points to every vertex.

        Parameters
        ----------
        points : SurfacePoints or array_like of int
            Points of the mesh, or vertices.

        Returns
        -------
        array of shape (p, n)
            Distances; +inf at vertices that cannot be reached.

        Raises
        ------
        WouldExceedMemory
            E501 when the table does not fit.
        """
        points = as_points(self.mesh, points)
        result = table(len(points), self.mesh.n_vertices, "distances", FEWER_POINTS)
        here = points.interpolate(self.embedding)
        for start in range(0, len(points), _BLOCK):
            rows = slice(start, start + _BLOCK)
            result[rows] = euclidean_distances(here[rows], self.embedding)
        label = vertex_components(self.mesh)
        result[label[self.mesh.faces[points.face, 0]][:, None] != label] = np.inf
        return result

    def spreader(self) -> Callable[[int, Floats], tuple[Integers, Floats]]:
        """The search for the vertices that a new sample is closest to, for `farthest_point_sampling`.

        Returns
        -------
        callable
            (vertex, nearest (n,)) -> the vertices closer to this one than `nearest`, and their distances.
        """
        rows, label = self.embedding, vertex_components(self.mesh)

        def closer(vertex: int, nearest: Floats) -> tuple[Integers, Floats]:
            return closer_rows(rows, label, vertex, nearest)

        return closer


class DiffusionDistance(_SpectralDistance):
    r"""Diffusion distance (3.1).

    .. math:: d_t^2(s, s') = \sum_i e^{-2 \lambda_i t} (\phi_i(s) - \phi_i(s'))^2

    Infinite between components: no heat goes from one to the other.

    Parameters
    ----------
    spectrum : Spectrum, Metric or Mesh
        Eigenpairs of the surface in some metric; of a metric, or a mesh with its embedded metric, the first 100.
    time : float
        :math:`t` in units of the area in that metric, not negative. The k-th term fades about as
        :math:`e^{-8 \pi k t}` (Weyl's law) whatever the size of the surface; at 3e-3, unless given, to a half after
        nine terms.

    Raises
    ------
    ValueError
        When the time is negative.

    References
    ----------
    (3.1) of Aflalo, Kimmel, Raviv 2013; Coifman, Lafon: Diffusion maps (2006).

    See Also
    --------
    CommuteTimeDistance : The average over all times.
    BiharmonicDistance : Falls off fastest in the eigenvalue.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> early, late = (geodesics.DiffusionDistance(sphere, time).field(0).max() for time in (0.01, 0.1))
    >>> bool(early > late)
    True
    """

    time: float

    def __init__(self, spectrum: Spectrum | Metric | Mesh, time: float = DEFAULT_TIME) -> None:
        spectrum = as_spectrum(spectrum)
        time = real_number(time, "time (in units of the area of the surface)", 0.0)
        object.__setattr__(self, "time", time)
        fade = np.exp(-spectrum.eigenvalues * (time * spectrum.mass.sum()))
        self._set(spectrum, spectrum.eigenfunctions * fade)

    def __repr__(self) -> str:
        return f"DiffusionDistance({self.embedding.shape[1]} coordinates at time {self.time:g} on {self.mesh!r})"


class CommuteTimeDistance(_SpectralDistance):
    r"""Commute-time distance (3.2); infinite between components.

    .. math:: d^2(s, s') = \sum_{i \ge 1} \frac{1}{2 \lambda_i} (\phi_i(s) - \phi_i(s'))^2

    Parameters
    ----------
    spectrum : Spectrum, Metric or Mesh
        Eigenpairs of the surface in some metric; of a metric, or a mesh with its embedded metric, the first 100.

    References
    ----------
    (3.2) of Aflalo, Kimmel, Raviv 2013.

    See Also
    --------
    DiffusionDistance : At one time instead of all.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> distance = geodesics.CommuteTimeDistance(geodesics.scale_invariant(sphere))
    >>> distance.field([0, 1]).shape
    (2, 162)
    """

    def __init__(self, spectrum: Spectrum | Metric | Mesh) -> None:
        spectrum = as_spectrum(spectrum)
        values, functions = _positive_part(spectrum)
        self._set(spectrum, functions / np.sqrt(2 * values))


class BiharmonicDistance(_SpectralDistance):
    r"""Biharmonic distance; infinite between components.

    .. math:: d^2(s, s') = \sum_{i \ge 1} \frac{1}{\lambda_i^2} (\phi_i(s) - \phi_i(s'))^2

    Parameters
    ----------
    spectrum : Spectrum, Metric or Mesh
        Eigenpairs of the surface in some metric; of a metric, or a mesh with its embedded metric, the first 100.

    References
    ----------
    Lipman, Rustamov, Funkhouser: Biharmonic distance (2010). Beside (3.1) and (3.2) it falls off fastest in the
    eigenvalue.

    See Also
    --------
    CommuteTimeDistance : With the first power of the eigenvalue.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> distance = geodesics.BiharmonicDistance(sphere)
    >>> field = distance.field(0)[0]
    >>> bool(field[0] == 0 and field.argmax() == (sphere.vertices @ sphere.vertices[0]).argmin())  # farthest: opposite
    True
    """

    def __init__(self, spectrum: Spectrum | Metric | Mesh) -> None:
        spectrum = as_spectrum(spectrum)
        values, functions = _positive_part(spectrum)
        self._set(spectrum, functions / values)


def _positive_part(spectrum: Spectrum) -> tuple[Floats, Floats]:
    """Eigenpairs without the constants on components, which do not contribute to distances."""
    components = int(vertex_components(spectrum.mesh).max()) + 1
    values = spectrum.eigenvalues * spectrum.mass.sum()
    null = values < 1e-6
    null[components:] = values[components:] < NOTHING  # faces without area join what is apart
    return spectrum.eigenvalues[~null], spectrum.eigenfunctions[:, ~null]

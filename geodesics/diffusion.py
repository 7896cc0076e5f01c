"""Diffusion distances: Euclidean distances between rows of an embedding by eigenfunctions (sec. 3)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from geodesics._kernels.spreading import closer_rows
from geodesics.arrays import Floats, Integers
from geodesics.distance import FEWER_POINTS
from geodesics.euclidean import euclidean_distances
from geodesics.memory import table
from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints
from geodesics.spectrum import Spectrum
from geodesics.topology.components import vertex_components

_BLOCK = 256  # rows of a field made at a time: keeps temporaries small, whatever the number of points


@dataclass(frozen=True, eq=False, init=False)
class _SpectralDistance:
    """Distance d(x, y) = |e(x) - e(y)| with an embedding e (n, k) that is linear on faces."""

    mesh: Mesh
    spectrum: Spectrum
    embedding: Floats
    _linked: bool  # False: points of different components are infinitely far apart

    def _set(self, spectrum: Spectrum, embedding: Floats, linked: bool) -> None:
        embedding = np.ascontiguousarray(embedding)
        embedding.setflags(write=False)
        object.__setattr__(self, "mesh", spectrum.mesh)
        object.__setattr__(self, "spectrum", spectrum)
        object.__setattr__(self, "embedding", embedding)
        object.__setattr__(self, "_linked", linked)

    def field(self, points: SurfacePoints) -> Floats:
        """Distances (p, n) from each point to every vertex; +inf at vertices that can not be reached.

        Raises `WouldExceedMemory` (E501) when the table does not fit.
        """
        result = table(len(points), self.mesh.n_vertices, "distances", FEWER_POINTS)
        here = points.interpolate(self.embedding)
        for start in range(0, len(points), _BLOCK):
            rows = slice(start, start + _BLOCK)
            result[rows] = euclidean_distances(here[rows], self.embedding)
        label = vertex_components(self.mesh)
        result[:, label < 0] = np.inf
        if not self._linked:
            result[label[self.mesh.faces[points.face, 0]][:, None] != label] = np.inf
        return result

    def spreader(self) -> Callable[[int, Floats], tuple[Integers, Floats]]:
        """A function (vertex, nearest (n,)) -> the vertices closer to this one than `nearest`, and their distances."""
        rows, label, linked = self.embedding, vertex_components(self.mesh), self._linked

        def closer(vertex: int, nearest: Floats) -> tuple[Integers, Floats]:
            return closer_rows(rows, label, linked, vertex, nearest)

        return closer


class DiffusionDistance(_SpectralDistance):
    """Diffusion distance (3.1): d^2 = sum_i exp(-2 lambda_i t) (phi_i(s) - phi_i(s'))^2.

    `time` is relative: t = time * area, with the area of the surface in the metric of the spectrum, so that the
    k-th term fades about as exp(-8 pi k time) (Weyl's law) whatever the size of the surface. Finite between
    components: it compares heat profiles.
    """

    time: float

    def __init__(self, spectrum: Spectrum, time: float) -> None:
        if not time >= 0:
            raise ValueError(f"time must be >= 0 (in units of the area of the surface), not {time}")
        object.__setattr__(self, "time", float(time))
        fade = np.exp(-spectrum.eigenvalues * (time * spectrum.mass.sum()))
        self._set(spectrum, spectrum.eigenfunctions * fade, linked=True)


class CommuteTimeDistance(_SpectralDistance):
    """Commute-time distance (3.2): d^2 = sum_i (phi_i(s) - phi_i(s'))^2 / (2 lambda_i); +inf between components."""

    def __init__(self, spectrum: Spectrum) -> None:
        values, functions = _positive_part(spectrum)
        self._set(spectrum, functions / np.sqrt(2 * values), linked=False)


class BiharmonicDistance(_SpectralDistance):
    """Biharmonic distance: d^2 = sum_i (phi_i(s) - phi_i(s'))^2 / lambda_i^2; +inf between components.

    Lipman, Rustamov, Funkhouser, "Biharmonic distance" (2010); beside (3.1) and (3.2) it falls off fastest in lambda.
    """

    def __init__(self, spectrum: Spectrum) -> None:
        values, functions = _positive_part(spectrum)
        self._set(spectrum, functions / values, linked=False)


def _positive_part(spectrum: Spectrum) -> tuple[Floats, Floats]:
    """Eigenpairs without the constants of the components, which carry no distance."""
    components = int(vertex_components(spectrum.mesh).max()) + 1
    null = spectrum.eigenvalues * spectrum.mass.sum() < 1e-6
    null[components:] = False
    return spectrum.eigenvalues[~null], spectrum.eigenfunctions[:, ~null]

"""A surface in one metric."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geodesics import CommuteTimeDistance, Mesh, Spectrum
from geodesics.arrays import Floats, Integers
from geodesics.caching import cached_property
from geodesics.sampling import Cells, farthest_point_cells

SAMPLING_FUNCTIONS = 20  # of a commute-time distance, for choosing samples: the rest hardly moves them; set by hand


@dataclass(frozen=True, eq=False)
class View:
    """A surface seen in one metric, scaled to unit area: eigenvalues (k,) and eigenfunctions (n, k), sec. 4.

    Vertices that do not belong to the surface have mass 0 and functions 0.
    """

    mesh: Mesh
    spectrum: Spectrum

    def __repr__(self) -> str:
        return f"View({self.spectrum!r})"

    @classmethod
    def of(cls, spectrum: Spectrum) -> View:
        """The view of a spectrum, whatever the area of its metric."""
        area = spectrum.mass.sum()
        values, functions = spectrum.eigenvalues * area, spectrum.eigenfunctions * np.sqrt(area)
        return cls(spectrum.mesh, Spectrum(spectrum.mesh, spectrum.mass / area, values, functions))

    @property
    def functions(self) -> Floats:
        """Eigenfunctions (n, k), the first constant."""
        return self.spectrum.eigenfunctions

    @property
    def eigenvalues(self) -> Floats:
        """Eigenvalues (k,), ascending from 0, of the metric of unit area."""
        return self.spectrum.eigenvalues

    @cached_property
    def usable(self) -> Integers:
        """Vertices that belong to the surface."""
        return np.flatnonzero(self.spectrum.mass > 0)

    def first(self, count: int) -> View:
        """The view with its first `count` eigenfunctions alone."""
        spectrum = self.spectrum
        values, functions = spectrum.eigenvalues[:count], spectrum.eigenfunctions[:, :count]
        return View(self.mesh, Spectrum(self.mesh, spectrum.mass, values, functions))

    def distance(self, count: int) -> CommuteTimeDistance:
        """The commute-time distance (3.2) by the first `count` eigenfunctions."""
        return CommuteTimeDistance(self.first(count).spectrum)

    @cached_property
    def commute_time_embedding(self) -> Floats:
        """The embedding (n, k - 1) whose Euclidean distances are commute-time distances (3.2)."""
        return self.distance(len(self.eigenvalues)).embedding

    def samples(self, count: int) -> Integers:
        """Farthest points (at most `count`) in commute-time distance, from the point farthest from all others."""
        most = max(self.sampled, default=0)
        return self.sampled[most].samples[:count] if count <= most else self.cells(count).samples

    def cells(self, count: int) -> Cells:
        """These samples with their Voronoi cells."""
        count = min(count, len(self.usable))
        if count not in self.sampled:
            distance = self.distance(SAMPLING_FUNCTIONS)
            first = int((distance.embedding**2).sum(axis=1).argmax())
            fewer = max((number for number in self.sampled if number < count), default=None)
            begun = None if fewer is None else self.sampled[fewer]
            self.sampled[count] = farthest_point_cells(distance, count, first, begun)
        return self.sampled[count]

    @cached_property
    def sampled(self) -> dict[int, Cells]:
        """The cells that were asked for, by the number of samples: those of fewer begin those of more."""
        return {}

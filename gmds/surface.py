"""A surface measured once for matching: brought to unit area, then seen in one or more metrics."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geodesics import CommuteTimeDistance, Mesh, Metric, Spectrum, eigenpairs, embedded, scale_invariant
from geodesics.curvature import mean_curvature
from geodesics.intrinsic import areas, squared_lengths
from geodesics.orientation import orient_faces
from geodesics.sampling import Cells, farthest_point_cells
from geodesics.threads import cached_property
from geodesics.topology import vertex_components
from gmds.errors import TooFewVertices

Array = NDArray[np.float64]
Index = NDArray[np.int64]

FEWEST_VERTICES = 12  # below this there are not enough eigenfunctions to start from
EIGENFUNCTIONS = 100
ROUGH_FUNCTIONS = 60  # in the metrics that only rough maps are made in
ENOUGH_EIGENFUNCTIONS = 30
SMOOTHING = 2e-2  # of the curvature: the starts want its large features, not its details
DETAIL = 1e-3  # smoothing of the mean curvature that tells the chest from the back
FLAT = 1e-6  # mean curvature of a surface of unit area below which it is rounding
EXPONENTS = (1.0, 0.5)  # of |K|, beside 0: what suits parts that grew much, a little, and not at all
SAMPLING_FUNCTIONS = 20  # of a commute-time distance, for choosing samples: the rest does not move them much


@dataclass(frozen=True, eq=False)
class View:
    """A surface seen in one metric, scaled to unit area: eigenvalues (k,) and eigenfunctions (n, k), sec. 4.

    Vertices that do not belong to the surface have mass 0 and functions 0.
    """

    mesh: Mesh
    spectrum: Spectrum

    @classmethod
    def of(cls, spectrum: Spectrum) -> View:
        """The view of a spectrum, whatever the area of its metric."""
        area = spectrum.mass.sum()
        values, functions = spectrum.eigenvalues * area, spectrum.eigenfunctions * np.sqrt(area)
        return cls(spectrum.mesh, Spectrum(spectrum.mesh, spectrum.mass / area, values, functions))

    @property
    def functions(self) -> Array:
        """Eigenfunctions (n, k), the first constant."""
        return self.spectrum.eigenfunctions

    @property
    def eigenvalues(self) -> Array:
        """Eigenvalues (k,), ascending from 0, of the metric of unit area."""
        return self.spectrum.eigenvalues

    @cached_property
    def usable(self) -> Index:
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
    def embedding(self) -> Array:
        """The embedding (n, k - 1) whose Euclidean distances are commute-time distances (3.2)."""
        return self.distance(len(self.eigenvalues)).embedding

    def samples(self, count: int) -> Index:
        """Farthest points (at most `count`) in commute-time distance, from the point farthest from all others."""
        most = max(self.sampled, default=0)
        return self.sampled[most].samples[:count] if count <= most else self.cells(count).samples

    def cells(self, count: int) -> Cells:
        """These samples with their Voronoi cells."""
        count = min(count, len(self.usable))
        if count not in self.sampled:
            distance = self.distance(SAMPLING_FUNCTIONS)
            first = int((distance.embedding**2).sum(axis=1).argmax())
            self.sampled[count] = farthest_point_cells(distance, count, first)
        return self.sampled[count]

    @cached_property
    def sampled(self) -> dict[int, Cells]:
        """The cells that were asked for, by the number of samples: those of fewer begin those of more."""
        return {}


@dataclass(frozen=True, eq=False)
class Surface:
    """The largest part of a mesh, with all vertices kept, brought to unit area and oriented.

    `mesh` has the vertices of `original`, moved and scaled, and the faces `face_index` of it, the largest first.
    """

    original: Mesh
    mesh: Mesh
    face_index: Index

    def view(self, metric: Callable[[Mesh], Metric]) -> View:
        """The surface in a metric in which rough maps are made."""
        return View.of(eigenpairs(metric(self.mesh), min(ROUGH_FUNCTIONS, self._most)))

    @cached_property
    def views(self) -> tuple[View, ...]:
        """The surface in members of the family |K|^a g, from the scale-invariant metric (2.1) to that of space."""
        curved = [functools.partial(scale_invariant, exponent=a, smoothing=SMOOTHING) for a in EXPONENTS]
        return (*(self.view(metric) for metric in curved), self.regular)

    @cached_property
    def regular(self) -> View:
        """The surface in the metric of space."""
        return View.of(eigenpairs(embedded(self.mesh), self.count))

    @cached_property
    def count(self) -> int:
        """Number of eigenfunctions in the metric of space."""
        return min(EIGENFUNCTIONS, self._most)

    @cached_property
    def _most(self) -> int:
        """Number of eigenfunctions there are."""
        return len(np.unique(self.mesh.faces)) - 1

    @cached_property
    def areas(self) -> Array:
        """Area (n,) around each vertex."""
        return self.regular.spectrum.mass

    @cached_property
    def reflection(self) -> Surface:
        """The mirror image of the surface."""
        return measure(self.original, reflected=True)

    @cached_property
    def derived(self) -> dict[str, Any]:
        """What `gmds.derived` keeps here, by name."""
        return {}

    @cached_property
    def squashed_curvature(self) -> Array:
        """Mean curvature (n,), squashed to [-1, 1] so that finger tips do not outvote the rest."""
        curvature = mean_curvature(self.mesh, DETAIL)
        typical = np.median(np.abs(curvature[self.regular.usable]))
        return np.tanh(curvature / typical) if typical > FLAT else np.zeros_like(curvature)


def measure(mesh: Mesh, *, reflected: bool = False) -> Surface:
    """The largest part of `mesh`, or of its mirror image, ready for matching. Raises `TooFewVertices` (E113)."""
    label = vertex_components(mesh)
    of_face = label[mesh.faces[:, 0]]
    area = areas(squared_lengths(mesh.vertices, mesh.faces))
    size = np.bincount(of_face, area)
    kept = np.flatnonzero(of_face == size.argmax())
    kept = kept[np.argsort(-area[kept], kind="stable")]  # the order of the faces in the file is to have no say
    used = np.flatnonzero(label == size.argmax())
    if len(used) < FEWEST_VERTICES:
        raise TooFewVertices(
            f"the largest part of {mesh!r} has {len(used)} vertices; matching needs {FEWEST_VERTICES}; refine the mesh"
        )
    shift = mesh.vertices[used].mean(axis=0)
    place, faces = (mesh.vertices - shift) / np.sqrt(size.max()), mesh.faces[kept]
    if reflected:
        place, faces = place * (-1.0, 1.0, 1.0), faces[:, [0, 2, 1]]  # what faced outward still does
    return Surface(mesh, orient_faces(Mesh(place, faces)), kept)


def view_of(distance: object, surface: Surface) -> View:
    """The surface in the metric that a distance measures in; in the metric of space when it does not say."""
    spectrum = getattr(distance, "spectrum", None)
    if isinstance(spectrum, Spectrum) and len(spectrum.eigenvalues) >= min(ENOUGH_EIGENFUNCTIONS, surface.count):
        return View.of(spectrum)
    metric = getattr(distance, "metric", None)
    return surface.view(lambda mesh: metric) if isinstance(metric, Metric) else surface.regular

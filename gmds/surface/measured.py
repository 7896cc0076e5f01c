"""A surface measured once for matching: brought to unit area, then seen in one or more metrics."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from geodesics import Mesh, Metric, Spectrum, eigenpairs, embedded, scale_invariant
from geodesics.arrays import Floats, Integers
from geodesics.caching import cached_property, memoized
from geodesics.curvature import mean_curvature
from geodesics.intrinsic import areas, squared_lengths
from geodesics.repair.cleaning import CleanCopy, cleaned
from geodesics.smoothing import DETAIL
from geodesics.smoothing import LARGE_FEATURES as SMOOTHING
from geodesics.topology.components import component_areas, largest_component
from geodesics.topology.orientation import orient_faces
from gmds.errors import TooFewVertices
from gmds.surface.view import View

FEWEST_VERTICES = 12  # a bound: below it there are not enough eigenfunctions to start from
# In the metric of space 150 were hardly better than 100 on development pairs (benchmarks/results/notes.md,
# "Eigenfunctions in the registration"); 60 in the metrics of rough maps save 0.5 CPU seconds ("Faster by a third").
EIGENFUNCTIONS = 100
ROUGH_FUNCTIONS = 60
ENOUGH_EIGENFUNCTIONS = 30  # of a given distance, for its spectrum to serve as the view; set by hand
FLAT = 1e-6  # mean curvature of a surface of unit area below which it is rounding: a bound
# Of |K|, beside 0: no one metric serves all pairs (benchmarks/results/notes.md, "Starts: which metric finds the right
# map"): parts that changed size much, a little, and not at all.
EXPONENTS = (1.0, 0.5)


@dataclass(frozen=True, eq=False)
class Surface:
    """The largest part of a mesh, with all vertices kept, brought to unit area and oriented.

    `mesh` has the vertices of `original`, moved and scaled, and the faces `face_index` of it, the largest first; all of
    them `turned` inside out where that is meant. Where the mesh that was given has faults, `original` is its `clean`
    copy.
    """

    original: Mesh
    mesh: Mesh
    face_index: Integers
    turned: bool = False
    clean: CleanCopy | None = None

    def __repr__(self) -> str:
        return f"Surface(unit area, {self.mesh!r})"

    @property
    def given(self) -> Mesh:
        """The mesh that was measured, as it was given."""
        return self.original if self.clean is None else self.clean.given

    def view(self, metric: Callable[[Mesh], Metric]) -> View:
        """The surface in a metric in which rough maps are made."""
        return View.of(eigenpairs(metric(self.mesh), min(ROUGH_FUNCTIONS, self._most)))

    @property
    def views(self) -> tuple[View, ...]:
        """The surface in members of the family |K|^a g, from the scale-invariant metric (2.1) to that of space."""
        return (*(self.curved(exponent) for exponent in EXPONENTS), self.regular)

    @memoized
    def curved(self, exponent: float) -> View:
        """The surface in the metric |K|^a g, a the exponent."""
        return self.view(functools.partial(scale_invariant, exponent=exponent, smoothing=SMOOTHING))

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
    def areas(self) -> Floats:
        """Area (n,) around each vertex."""
        return self.regular.spectrum.mass

    @property
    def reflected(self) -> bool:
        """Whether `mesh` is the mirror image of its part of the original, with x the other way round."""
        used = np.unique(self.mesh.faces)
        x = self.original.vertices[used, 0]
        return bool((x - x.mean()) @ self.mesh.vertices[used, 0] < 0)

    @property
    def reverses(self) -> bool:
        """Whether what preserves orientation here reverses it on the original."""
        return self.reflected != self.turned

    @cached_property
    def reflection(self) -> Surface:
        """The mirror image of the surface."""
        return measured_as_it_is(self.original, reflected=True)

    @cached_property
    def inside_out(self) -> Surface:
        """The same surface with all faces turned."""
        return replace(self, mesh=Mesh(self.mesh.vertices, self.mesh.faces[:, [0, 2, 1]]), turned=not self.turned)

    @cached_property
    def squashed_curvature(self) -> Floats:
        """Mean curvature (n,), squashed to [-1, 1] so that finger tips do not outvote the rest."""
        curvature = mean_curvature(self.mesh, DETAIL)
        typical = np.median(np.abs(curvature[self.regular.usable]))
        return np.tanh(curvature / typical) if typical > FLAT else np.zeros_like(curvature)


def measure(mesh: Mesh, *, reflected: bool = False) -> Surface:
    """The largest part of a mesh, ready for matching: what is computed of it for one match serves the next.

    Parameters
    ----------
    mesh : Mesh
        Any surface; parts that do not hang together with the largest are left out. One with vertices doubled or on
        edges along seams, or that is no manifold, is measured as a clean copy (see `geodesics.repair.cleaning`).
    reflected : bool
        Whether its mirror image is meant.

    Returns
    -------
    Surface
        Brought to unit area and oriented; `match` takes it in place of the mesh.

    Raises
    ------
    TooFewVertices
        When the largest part has fewer than 12 vertices (E113).

    See Also
    --------
    match : Measures what it is given.
    """
    clean = cleaned(mesh := Mesh.from_object(mesh))
    if clean is None:
        return measured_as_it_is(mesh, reflected=reflected)
    return replace(measured_as_it_is(clean.mesh, reflected=reflected), clean=clean)


def measured_as_it_is(mesh: Mesh, *, reflected: bool = False) -> Surface:
    """The largest part of a mesh that is clean, or is to be measured with its faults; as `measure` otherwise."""
    area = areas(squared_lengths(mesh.vertices, mesh.faces))
    kept = np.flatnonzero(largest_component(mesh))
    kept = kept[np.argsort(-area[kept], kind="stable")]  # the order of the faces in the file is to have no say
    used = np.unique(mesh.faces[kept])
    places = len(used) if len(used) < FEWEST_VERTICES else len(np.unique(mesh.vertices[used], axis=0))
    if places < FEWEST_VERTICES:
        raise TooFewVertices(_too_few(mesh, len(used), places))
    shift = mesh.vertices[used].mean(axis=0)
    place, faces = (mesh.vertices - shift) / np.sqrt(component_areas(mesh).max()), mesh.faces[kept]
    if reflected:
        place, faces = place * (-1.0, 1.0, 1.0), faces[:, [0, 2, 1]]  # what faced outward still does
    return Surface(mesh, orient_faces(Mesh(place, faces)), kept)


def _too_few(mesh: Mesh, count: int, places: int) -> str:
    """Why a mesh cannot be matched, and what to do."""
    doubled = mesh.n_vertices - len(np.unique(mesh.vertices, axis=0))
    what = f"{count} vertices" if places == count else f"{count} vertices in {places} places"
    hint = f"join {doubled} vertices at equal positions: gmds repair --weld" if doubled else "refine the mesh"
    parts = len(component_areas(mesh))
    if parts > 1 and not doubled:
        hint = f"it falls into {parts} parts that share no vertices: weld it in the program that wrote it, or refine it"
    return f"the largest part of {mesh!r} has {what}; matching needs {FEWEST_VERTICES}; {hint}"


def view_of(distance: object, surface: Surface) -> View:
    """The surface in the metric that a distance measures in; in the metric of space when it does not say."""
    spectrum = getattr(distance, "spectrum", None)
    if isinstance(spectrum, Spectrum) and len(spectrum.eigenvalues) >= min(ENOUGH_EIGENFUNCTIONS, surface.count):
        return View.of(spectrum)
    metric = getattr(distance, "metric", None)
    return surface.view(lambda mesh: metric) if isinstance(metric, Metric) else surface.regular

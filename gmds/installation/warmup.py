"""Compiling every kernel ahead of time, so that the first real match does not wait for it."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

VERTICES = 300  # enough for everything to have work, few enough for seconds; tests say that no kernel is left out
SPARSE = 1200  # vertices; below some hundred, spectra are computed densely, by other means


@dataclass(frozen=True)
class Warmth:
    """`compiled`: how many kernels were compiled now, not read from disk; `seconds`: how long it all took.

    `folder` keeps what was compiled; it is None where none can be written: every process then compiles for itself.
    """

    compiled: int
    seconds: float
    folder: str | None


def warm_up(progress: Callable[[str, float], None] | None = None) -> Warmth:
    """Compile all kernels by a tiny match and a few geodesic distances; once they are kept, this takes seconds."""
    from geodesics import GeodesicDistance, SurfacePoints, eigenpairs, farthest_point_sampling, scale_invariant
    from geodesics.compiling import cache_folder, reporting_compilation
    from gmds.matching.pair import simplified
    from gmds.matching.pipeline import match
    from gmds.mds.problem import Problem
    from gmds.mds.solver import solve
    from gmds.parts.alignments import Judged, alignments
    from gmds.shapes import quadruped
    from gmds.surface.measured import measure

    started = time.perf_counter()
    compiled = 0

    def compiling(begins: bool) -> None:
        nonlocal compiled
        compiled += begins

    with reporting_compilation(compiling):
        source, target = (quadruped(pose, n_vertices=VERTICES) for pose in ("stand", "walk"))
        distance = GeodesicDistance(scale_invariant(source))
        distance.field(SurfacePoints(source, np.array([0]), np.full((1, 3), 1 / 3)))
        few = farthest_point_sampling(distance, 4)
        solve(Problem(distance, few, distance), few)
        eigenpairs(scale_invariant(quadruped(n_vertices=SPARSE)), 10)
        match(source, target, distance=lambda mesh: GeodesicDistance(scale_invariant(mesh)), n_samples=12)
        match(source, target, progress=progress)
        ours, theirs = (Judged(surface, simplified(surface)) for surface in map(measure, (source, target)))
        alignments(ours, theirs, (0.9, 1.1), 1)
    return Warmth(compiled, time.perf_counter() - started, cache_folder())

"""The pair of `gmds demo` with few vertices, and a `match` that does the same work once, for code on pages."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

import gmds
from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Floats
from gmds import Correspondence
from gmds.matching import pipeline
from gmds.matching.pipeline import SAMPLES
from gmds.pictures.software import Shot, software
from gmds.shapes import Figure, quadruped, truth
from gmds.surface.measured import Surface

N = 300  # vertices; fewer are matched badly
FEW = 80  # samples, where a page asks for the default: in a given distance they take most of the time
DEFAULTS = ("None", "0", "'preserve'", "'auto'", repr(gmds.LeastSquares()), str(SAMPLES))  # of the options of `match`


def small_pair() -> tuple[Figure, Figure, SurfacePoints]:
    """As `gmds.shapes.demo_pair`, with fewer vertices, and in single precision: the very meshes of the files."""
    exact = quadruped(n_vertices=N), quadruped("walk", head_scale=2.0, n_vertices=N + 10, seed=1)
    source, target = (Figure(mesh.vertices.astype(np.float32), mesh.faces, mesh.rest) for mesh in exact)
    return source, target, truth(source, target)


def small_pictures(shots: Sequence[Shot]) -> list[Floats]:
    """In place of pyvista, which takes a second a picture in a process of its own: so small that it takes none."""
    return software([replace(shot, pixels=40) for shot in shots])


def import_error(module: str) -> str:
    """In place of an import in a process of its own, which `.ci/run` has `gmds doctor` try: is there such a module?"""
    return "" if importlib.util.find_spec(module) else "not found"


def remembering(match: Callable[..., Correspondence]) -> Callable[..., Correspondence]:
    """`match` that does the same work once: for equal meshes and options it gives the answer it gave before."""
    known: dict[Any, Correspondence] = {}

    def of(one: Mesh | Surface) -> tuple[Mesh, ...]:
        return (one.original, one.mesh) if isinstance(one, Surface) else (one,)

    def remembered(source: Any, target: Any, *, progress: Any = None, **options: Any) -> Correspondence:
        meshes = [mesh for one in (source, target) for mesh in of(one)]
        given = tuple(a.tobytes() for mesh in meshes for a in (mesh.vertices, mesh.faces))
        chosen = [(name, repr(value)) for name, value in sorted(options.items()) if repr(value) not in DEFAULTS]
        key = (given, tuple(chosen))
        if key not in known:
            known[key] = match(source, target, progress=progress, **options)
        answer = known[key]
        if isinstance(source, Surface):  # which holds its mesh, and no one asks for that very object
            return answer

        def here(points: SurfacePoints) -> SurfacePoints:
            return SurfacePoints(target, points.face, points.barycentric)

        others = tuple(replace(other, points=here(other.points)) for other in answer.candidates)
        return replace(answer, source=source, target=target, points=here(answer.points), candidates=others)

    return remembered


def remember() -> None:
    """In a worker of a cluster: pairs of stored shapes that several pages match are matched once."""
    pipeline.match = remembering(pipeline.match)


match = remembering(gmds.match)


def match_on_pages(source: Mesh, target: Mesh, *, n_samples: int | None = None, **options: Any) -> Correspondence:
    """The same with few samples."""
    if n_samples in (None, SAMPLES) and source.n_vertices > FEW:
        n_samples = FEW
    return match(source, target, n_samples=n_samples, **options)

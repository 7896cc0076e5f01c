"""The pair of `gmds demo` with few vertices, and a `match` that does the same work once, for code on pages."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

import gmds
from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Floats
from gmds import Correspondence
from gmds.installation import diagnosis
from gmds.matching.pipeline import SAMPLES
from gmds.pictures.software import Shot, software
from gmds.shapes import Figure, quadruped, truth

N = 300  # vertices; fewer are matched badly
DEFAULTS = ("None", "0", "'preserve'", "'auto'", repr(gmds.LeastSquares()), str(SAMPLES))  # of the options of `match`


def small_pair() -> tuple[Figure, Figure, SurfacePoints]:
    """As `gmds.shapes.demo_pair`, with fewer vertices, and in single precision: the very meshes of the files."""
    exact = quadruped(n_vertices=N), quadruped("walk", head_scale=2.0, n_vertices=N + 10, seed=1)
    source, target = (Figure(mesh.vertices.astype(np.float32), mesh.faces, mesh.rest) for mesh in exact)
    return source, target, truth(source, target)


def small_pictures(shots: Sequence[Shot]) -> list[Floats]:
    """In place of pyvista, which takes a second a picture in a process of its own: so small that it takes none."""
    return software([replace(shot, pixels=40) for shot in shots])


import_error = functools.cache(diagnosis._import_error)
"""Of each package once: every import takes a process of its own, and `gmds doctor` stands on several pages."""


def remembering(match: Callable[..., Correspondence]) -> Callable[..., Correspondence]:
    """`match` that does the same work once: for equal meshes and options it gives the answer it gave before."""
    known: dict[Any, Correspondence] = {}

    def remembered(source: Mesh, target: Mesh, *, progress: Any = None, **options: Any) -> Correspondence:
        given = tuple(a.tobytes() for mesh in (source, target) for a in (mesh.vertices, mesh.faces))
        chosen = [(name, repr(value)) for name, value in sorted(options.items()) if repr(value) not in DEFAULTS]
        key = (given, tuple(chosen))
        if key not in known:
            known[key] = match(source, target, progress=progress, **options)
        answer = known[key]

        def here(points: SurfacePoints) -> SurfacePoints:
            return SurfacePoints(target, points.face, points.barycentric)

        others = tuple(replace(other, points=here(other.points)) for other in answer.candidates)
        return replace(answer, source=source, target=target, points=here(answer.points), candidates=others)

    return remembered


match = remembering(gmds.match)

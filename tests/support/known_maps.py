"""Maps that are known exactly."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from generated_shapes import bumpy_sphere, icosphere, subdivided

from geodesics import Mesh, SurfacePoints
from geodesics.closest import closest_on_triangles
from gmds.correspondence import Correspondence
from gmds.maps.point_map import Candidate, MatchStatus

SOURCE, TARGET = bumpy_sphere(1), icosphere(2)


def identity(mesh: Mesh) -> Correspondence:
    return Correspondence.from_points(mesh, SurfacePoints.at_vertices(mesh, np.arange(mesh.n_vertices)))


def subvertex_map(coarse: int = 2) -> tuple[Correspondence, Mesh, Mesh]:
    """The exact map from a subdivided surface to the surface it was cut from: points at vertices and edge midpoints."""
    target = bumpy_sphere(coarse)
    source = subdivided(target)
    face, weights, gap = closest_on_triangles(source.vertices, target.vertices, target.faces)
    assert gap.max() < 1e-12
    return Correspondence.from_points(source, SurfacePoints(target, face, weights)), source, target


def make_answer() -> Correspondence:
    """A map with everything that a file can hold."""
    rng = np.random.default_rng(0)
    n = SOURCE.n_vertices
    points = SurfacePoints(TARGET, rng.integers(0, TARGET.n_faces, n), rng.dirichlet(np.ones(3), n))
    meta = {"seed": 3, "parameters": {"n_samples": np.int64(7), "weights": np.arange(2.0)}, "timings": {"solve": 0.5}}
    valid, distortion = rng.random(n) > 0.2, rng.random(n).astype(np.float32).astype(np.float64)
    return Correspondence(SOURCE, TARGET, points, valid, distortion, MatchStatus.AMBIGUOUS, (), meta)


def with_candidates(count: int = 3) -> Correspondence:
    """The same with so many candidates, weights of some of which are halves, or all at one corner."""
    rng, n = np.random.default_rng(1), SOURCE.n_vertices
    weights = [rng.dirichlet(np.ones(3), n), np.tile([0.0, 0.5, 0.5], (n, 1)), np.tile([0.0, 0.0, 1.0], (n, 1))]
    faces = rng.integers(0, TARGET.n_faces, (count, n))
    points = [SurfacePoints(TARGET, face, weights[i % 3]) for i, face in enumerate(faces)]
    candidates = tuple(Candidate(one, 0.01 * i + 0.001, 0.5 - i) for i, one in enumerate(points))
    return replace(make_answer(), candidates=candidates)


def members(path: Path) -> dict[str, Any]:
    """The arrays of a file, by numpy alone."""
    with np.load(path, allow_pickle=False) as archive:
        return {name: archive[name] for name in archive.files}


def load(path: Path) -> Correspondence:
    """A map between SOURCE and TARGET."""
    return Correspondence.load(path, SOURCE, TARGET)

"""Copies that lost something, as `moves.py` and `damages.py` say. Every measurement and match answers or says why not.

    python -m benchmarks.fuzzing.damaged --meshes 200 --pairs 20

Generated surfaces, each damaged in every way below, are measured (every metric with its spectrum, distances, curvature)
and matched with what they were, either way round. Warnings count as errors. An answer has numbers alone, +inf where a
distance cannot be reached; anything else is a typed error with a code. Writes results/damaged.md; exit code 1 when
there is a raw error of a library, or an answer that is no number.
"""

from __future__ import annotations

import argparse
import sys
import warnings
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import generated_shapes as shapes
import numpy as np
from numpy.typing import NDArray

import gmds
from benchmarks.fuzzing.damages import DAMAGES, Faces, Points, hurt
from benchmarks.fuzzing.metamorphic import generated
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from geodesics import CommuteTimeDistance, GeodesicDistance, Mesh, SurfacePoints, eigenpairs, embedded, metrics
from geodesics.check import check
from geodesics.curvature import gaussian_curvature, mean_curvature
from geodesics.repair.repairing import repair

EIGENVALUES = 12  # of each mesh; set by hand
FINE = 3  # one mesh in so many is finer, as eigenpairs of more than 400 vertices are found in another way


def measurements(vertices: Points, faces: Faces) -> Iterator[Callable[[], Any]]:
    """What is asked of one surface, each giving numbers."""
    made = lambda: Mesh(vertices, faces)  # noqa: E731
    for metric in metrics.ALL:
        yield lambda metric=metric: eigenpairs(metric(made()), EIGENVALUES).eigenvalues
    yield lambda: _reached(GeodesicDistance(embedded(made())), made())
    yield lambda: _reached(CommuteTimeDistance(eigenpairs(embedded(made()), EIGENVALUES)), made())
    yield lambda: gaussian_curvature(made())
    yield lambda: mean_curvature(made())
    yield lambda: repair(made())[0].vertices
    yield lambda: len(check(made()))


def _reached(distance: Any, mesh: Mesh) -> NDArray[np.float64]:
    """Distances from a vertex, 0 where there are none."""
    field = distance.field(SurfacePoints.at_vertices(mesh, [int(mesh.faces[0, 0])]))
    return np.where(np.isposinf(field), 0.0, field)


def matches(vertices: Points, faces: Faces, whole: Mesh) -> Iterator[Callable[[], Any]]:
    """The damaged copy with what it was, either way round."""
    copy = lambda: Mesh(vertices, faces)  # noqa: E731
    yield lambda: _numbers(gmds.match(copy(), whole, n_samples=60))
    yield lambda: _numbers(gmds.match(whole, copy(), n_samples=60))


def _numbers(answer: Any) -> NDArray[np.float64]:
    return np.concatenate([answer.points.positions.ravel(), answer.distortion])


def outcome(ask: Callable[[], Any]) -> str:
    """ "answered", the code of a typed error, or what went wrong."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            return "answered" if np.all(np.isfinite(ask())) else "WRONG: not a number"
        except Exception as error:
            code = getattr(error, "code", None)
            return code if isinstance(code, str) else f"WRONG: {type(error).__name__}: {error!s:.60}"


def page(meshes: int, pairs: int, found: dict[str, tuple[Counter[str], Counter[str]]]) -> str:
    """The table."""
    lines = [
        "# Damaged copies",
        "",
        f"`python -m benchmarks.fuzzing.damaged --meshes {meshes} --pairs {pairs}`: how often",
    ]
    lines += [
        "what was asked of each copy was answered, warnings being errors, and the codes of the errors otherwise.",
        "",
    ]
    cell = lambda counts: ", ".join(f"{word} {n}" for word, n in sorted(counts.items())) or "-"  # noqa: E731
    rows = ([damage, *map(cell, counts)] for damage, counts in found.items())
    return "\n".join([*lines, *table(["damage", "measured", "matched"], rows)])


def main() -> int:
    """Run, write as it goes, judge."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--meshes", type=int, default=200)
    parser.add_argument("--pairs", type=int, default=20)
    parser.add_argument("--output", type=Path, default=RESULTS)
    options = parser.parse_args()
    found: dict[str, tuple[Counter[str], Counter[str]]] = defaultdict(lambda: (Counter(), Counter()))
    for i in range(max(options.meshes, options.pairs)):
        mesh, whole = generated(i), shapes.bumpy_sphere(2, seed=i)
        mesh = shapes.subdivided(mesh) if i % FINE == 0 else mesh
        for name in DAMAGES:
            if i < options.meshes:
                found[name][0].update(outcome(ask) for ask in measurements(*hurt(name, mesh, i)))
            if i < options.pairs:
                found[name][1].update(outcome(ask) for ask in matches(*hurt(name, whole, i), whole))
        text = page(min(i + 1, options.meshes), min(i + 1, options.pairs), found)
        (options.output / "damaged.md").write_text(text, encoding="utf-8")
        print(i + 1, file=sys.stderr)
    print(text)
    return int(any(word.startswith("WRONG") for both in found.values() for counts in both for word in counts))


if __name__ == "__main__":
    sys.exit(main())

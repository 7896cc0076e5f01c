"""Copies that lost something: digits, vertices, a dimension. Every measurement and every match answers or says why not.

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
from benchmarks.fuzzing.metamorphic import generated
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from geodesics import CommuteTimeDistance, GeodesicDistance, Mesh, SurfacePoints, eigenpairs, embedded, metrics
from geodesics.check import check
from geodesics.curvature import gaussian_curvature, mean_curvature
from geodesics.repair.repairing import repair

EIGENVALUES = 12  # of each mesh; set by hand
FINE = 3  # one mesh in so many is finer, as eigenpairs of more than 400 vertices are found in another way
Points = NDArray[np.float64]
Damage = Callable[[Points, NDArray[np.int64], np.random.Generator], Points]


def quantised(steps: int) -> Damage:
    """On a grid of so many steps along the longest side."""

    def change(v: Points, _: object, __: object) -> Points:
        step = np.ptp(v, axis=0).max() / steps
        return np.round(v / step) * step

    return change


def single(extents: float) -> Damage:
    """In single precision, so many extents away from the origin."""
    return lambda v, _, __: (v + extents * np.ptp(v, axis=0).max()).astype(np.float32).astype(np.float64)


def far(extents: float) -> Damage:
    """In double precision, so many extents away from the origin."""
    return lambda v, _, __: v + extents * np.ptp(v, axis=0).max()


def pressed(factor: float, axes: int = 1) -> Damage:
    """Flat along one axis, or a line."""
    return lambda v, _, __: v * ((1.0,) * (3 - axes) + (factor,) * axes)


def collapsed(share: float, apart: float = 0.0) -> Damage:
    """A share of the vertices on a neighbour, or so far from it."""

    def change(v: Points, faces: NDArray[np.int64], rng: np.random.Generator) -> Points:
        changed = v.copy()
        corners = faces[rng.permutation(len(faces))[: max(1, int(share * len(v)))]]
        changed[corners[:, 0]] = v[corners[:, 1]] + apart * rng.standard_normal((len(corners), 3))
        return changed

    return change


def gathered(share: float) -> Damage:
    """A share of the vertices in one point."""

    def change(v: Points, _: object, rng: np.random.Generator) -> Points:
        changed = v.copy()
        changed[rng.permutation(len(v))[: int(share * len(v))]] = v[0]
        return changed

    return change


def spiked(length: float) -> Damage:
    """One vertex so many times farther from the origin."""

    def change(v: Points, _: object, rng: np.random.Generator) -> Points:
        changed = v.copy()
        changed[rng.integers(len(v))] *= length
        return changed

    return change


DAMAGES: dict[str, Damage] = {
    **{f"on a grid of {steps} steps": quantised(steps) for steps in (1000, 100, 30, 10, 4, 2)},
    **{f"single precision, {d:.0e} extents away": single(d) for d in (1e3, 1e5, 1e6, 3e6, 1e7, 1e8)},
    **{f"double precision, {d:.0e} extents away": far(d) for d in (1e8, 1e12, 1e14, 1e15)},
    **{f"flat to {f:.0e}": pressed(f) for f in (1e-3, 1e-6, 1e-9, 1e-15, 0.0)},
    **{f"a line to {f:.0e}": pressed(f, 2) for f in (1e-3, 1e-6, 1e-9, 1e-15)},
    **{f"{s:.1%} on a neighbour": collapsed(s) for s in (0.005, 0.1, 0.3, 0.9)},
    **{f"10 % a {d:.0e} from a neighbour": collapsed(0.1, d) for d in (1e-6, 1e-9, 1e-12, 1e-15)},
    **{f"{s:.0%} in one point": gathered(s) for s in (0.1, 0.5, 0.9)},
    **{f"a spike of {s:.0e}": spiked(s) for s in (1e3, 1e6, 1e9, 1e14)},
}


def measurements(vertices: Points, faces: NDArray[np.int64]) -> Iterator[Callable[[], Any]]:
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


def matches(vertices: Points, whole: Mesh) -> Iterator[Callable[[], Any]]:
    """The damaged copy with what it was, either way round."""
    copy = lambda: Mesh(vertices, whole.faces)  # noqa: E731
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
        for name, damage in DAMAGES.items():
            if i < options.meshes:
                hurt = damage(mesh.vertices, mesh.faces, np.random.default_rng(i))
                found[name][0].update(outcome(ask) for ask in measurements(hurt, mesh.faces))
            if i < options.pairs:
                hurt = damage(whole.vertices, whole.faces, np.random.default_rng(i))
                found[name][1].update(outcome(ask) for ask in matches(hurt, whole))
        text = page(min(i + 1, options.meshes), min(i + 1, options.pairs), found)
        (options.output / "damaged.md").write_text(text, encoding="utf-8")
        print(i + 1, file=sys.stderr)
    print(text)
    return int(any(word.startswith("WRONG") for both in found.values() for counts in both for word in counts))


if __name__ == "__main__":
    sys.exit(main())

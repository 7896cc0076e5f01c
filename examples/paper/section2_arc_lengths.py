"""How geodesic distances in the metrics of sec. 2 and (7.1) change when a surface is resized, bent or mapped affinely.

The number is mean |d' - d| / mean d over pairs of samples, in percent, from the surface to its image with the same
triangles. `vase` is half a vase of revolution, wound tighter about its axis: an exact isometry, measured away from its
boundary. `egg` is a smooth convex body: affine curvature wants one. `animal` has everything; its bent copy is as nearly
isometric as can be, its scaled one has limbs twice and half as large.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import trimesh
from common import Z_UP, copies, grid, options, picture, publish, save, shapes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from geodesics import GeodesicDistance, Mesh, Metric, SurfacePoints, embedded, farthest_point_sampling, min_curvature
from geodesics.metrics import ALL, scale_invariant
from gmds.deformations import bending

Change = tuple[Mesh, Mesh, NDArray[np.int64]]  # before, after, vertices between which is measured
UNIMODULAR = np.array([[1.3, 0.4, 0.0], [0.0, 0.8, 0.3], [0.2, 0.0, 1.0]])
UNIMODULAR /= np.cbrt(np.linalg.det(UNIMODULAR))


def vase(bend: float, n: int) -> Mesh:
    """Radius r(s) times bend, angle over bend."""
    s, angle = (a.ravel() for a in np.meshgrid(np.linspace(0, 3, n), np.linspace(0, np.pi, n), indexing="ij"))
    slope = 0.7 * np.cos(2 * np.linspace(0, 3, 4001))
    height = np.cumsum(np.sqrt(1 - (bend * slope) ** 2) * 3 / 4000)  # so that s stays arc length
    radius, z = bend * (1 + 0.35 * np.sin(2 * s)), np.interp(s, np.linspace(0, 3, 4001), height)
    i = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = np.concatenate([np.stack([i, i + n, i + 1], 1), np.stack([i + 1, i + n, i + n + 1], 1)])
    return Mesh(np.stack([radius * np.cos(angle / bend), radius * np.sin(angle / bend), z], axis=1), faces)


def egg(subdivisions: int) -> Mesh:
    """A sphere, pulled longer at one end and flattened at a side."""
    ball = trimesh.creation.icosphere(subdivisions)
    x, y, z = ball.vertices.T
    return Mesh(np.stack([x * (1.3 + 0.15 * z), y * (1 + 0.1 * x), z * (1 + 0.12 * y + 0.1 * z)], axis=1), ball.faces)


def changes(settings: Any, animal: Mesh) -> dict[str, Change]:
    """What is done to which surface."""
    n = 30 if settings.small else 60
    inside = np.flatnonzero((np.indices((n, n)) % (n // 6) == n // 12).all(axis=0).ravel())
    body, whole = egg(3 if settings.small else 5), vase(1.0, n)
    on_body, on_animal = (farthest_point_sampling(GeodesicDistance(embedded(mesh)), 30) for mesh in (body, animal))
    return {
        "vase, twice as big": (whole, Mesh(2 * whole.vertices, whole.faces), inside),
        "vase, bent": (whole, vase(0.6, n), inside),
        "animal, bent": (animal, bending(animal, 40, rng=1)[0], on_animal),
        "animal, limbs scaled": (animal, copies(animal)["same triangles"][0], on_animal),
        "egg, unimodular map": (body, Mesh(body.vertices @ UNIMODULAR.T, body.faces), on_body),
        "egg, affine map": (body, Mesh(2 * body.vertices @ UNIMODULAR.T, body.faces), on_body),
        "animal, unimodular map": (animal, Mesh(animal.vertices @ UNIMODULAR.T, animal.faces), on_animal),
    }


def percent(measure: Callable[[Mesh], Metric], change: Change) -> float:
    """Change of geodesic distances in a metric."""
    before, after, samples = change
    old, new = (
        GeodesicDistance(measure(mesh)).field(SurfacePoints.at_vertices(mesh, samples))[:, samples]
        for mesh in (before, after)
    )
    return round(100 * float(np.abs(new - old).mean() / old.mean()), 2)


def table(numbers: dict[str, dict[str, float]]) -> Figure:
    """Numbers by metric and change; dark is unchanged."""
    rows, columns = list(numbers), list(next(iter(numbers.values())))
    values = np.array([[numbers[row][column] for column in columns] for row in rows])
    figure = Figure(figsize=(9.5, 4.6), dpi=110, layout="constrained")
    axis = figure.subplots()
    axis.imshow(np.log10(values.clip(0.1, 100)), cmap="cividis", aspect="auto")
    axis.set_xticks(range(len(columns)), [c.replace(", ", ",\n") for c in columns], fontsize=8)
    axis.set_yticks(range(len(rows)), [r.replace("_", " ") for r in rows], fontsize=8)
    for (i, j), value in np.ndenumerate(values):
        axis.text(j, i, f"{value:.1f}", ha="center", va="center", color="black" if value > 4 else "white", fontsize=9)
    axis.set_title("Change of geodesic distances, %", fontsize=11)
    return figure


def main() -> None:
    settings = options("Sec. 2 and (7.1)")
    animal = next(shapes(settings))[1]
    what = changes(settings, animal)
    numbers = {metric.__name__: {name: percent(metric, change) for name, change in what.items()} for metric in ALL}
    publish(settings.output, "section2_arc_lengths", table(numbers), numbers)

    rows: list[tuple[str, list[np.ndarray]]] = []
    for name in ("animal", "animal, bent", "animal, limbs scaled"):
        mesh = what[name][1] if name in what else animal
        grown = embedded(mesh).mass * 4 * np.pi / mesh.area
        density = [np.log10(measure(mesh).mass / grown) for measure in (scale_invariant, min_curvature)]
        rows.append((name, [picture(mesh, values, Z_UP, (0, 2.5), like=animal) for values in density]))
    title = "Growth of area in two metrics,\nfrom 1 (blue) to 300 (yellow)"
    save(settings.output / "section7_min_curvature.png", grid(rows, ["$|K| g$", "$\\kappa_{min}^2 g$"], title))


if __name__ == "__main__":
    main()

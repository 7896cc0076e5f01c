"""Eigenfunctions of a shape and of its locally scaled copy, in two metrics (Fig. 2, Fig. 3).

The number is the mean |correlation| over the shape of its eigenfunctions 1 to 10 with those of the copy (1 to 15),
carried back by the truth and paired one to one so that the correlations add up to most: `paired`. An eigenfunction is
defined up to a rotation among those of the same eigenvalue, and where eigenvalues of the shape follow each other within
5 %, a small change of the surface does rotate them: `rotated` is the number after the best rotation within such groups.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from common import METRICS, copies, grid, options, picture, publish, shapes
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from geodesics import Spectrum, SurfacePoints, eigenpairs

Array = NDArray[np.float64]
COUNT, AMONG, SHOWN, CLOSE = 10, 15, 3, 0.05


def correlations(old: Spectrum, new: Spectrum, truth: SurfacePoints) -> Array:
    """Correlation (COUNT, AMONG) over the old surface, constants left out."""
    weight = old.mass / old.mass.sum()
    a, b = old.eigenfunctions[:, 1 : COUNT + 1], truth.interpolate(new.eigenfunctions[:, 1 : AMONG + 1])
    a, b = ((f - weight @ f) / np.sqrt(weight @ (f - weight @ f) ** 2) for f in (a, b))
    return a.T @ (weight[:, None] * b)


def rotated(paired: Array, eigenvalues: Array) -> Array:
    """|correlation| of each pair after the best rotation within groups of close eigenvalues of the old surface."""
    group = np.cumsum(np.append(False, np.diff(eigenvalues) > CLOSE * eigenvalues[1:]))
    result = np.empty(len(paired))
    for number in np.unique(group):
        rows = np.flatnonzero(group == number)
        u, _, vt = np.linalg.svd(paired[np.ix_(rows, rows)])
        result[rows] = np.abs(np.diag(paired[np.ix_(rows, rows)] @ (u @ vt).T))
    return result


def main() -> None:
    settings = options("Figs. 2 and 3")
    numbers: dict[str, Any] = {}
    rows: list[tuple[str, list[np.ndarray]]] = []
    for name, mesh, up in shapes(settings):
        pictures: dict[str, list[np.ndarray]] = {"": [], "copy": []}
        numbers[name] = {}
        made = copies(mesh)
        for metric, measure in METRICS.items():
            old = eigenpairs(measure(mesh), AMONG + 1)
            for copy, (other, truth) in made.items():
                new = eigenpairs(measure(other), AMONG + 1)
                every = correlations(old, new, truth)
                partner = linear_sum_assignment(-np.abs(every))[1]
                paired = every[:, partner]
                numbers[name].setdefault(copy, {})[metric] = {
                    "paired": np.abs(paired.diagonal()).mean().round(4),
                    "rotated": rotated(paired, old.eigenvalues[1 : COUNT + 1]).mean().round(4),
                    "each": np.abs(paired.diagonal()).round(3).tolist(),
                }
            for i in range(SHOWN):
                f = old.eigenfunctions[:, 1 + i]
                g = np.sign(paired[i, i]) * new.eigenfunctions[:, 1 + partner[i]]
                for panel, surface, values in (("", mesh, f), ("copy", other, g)):
                    top = np.quantile(np.abs(values), 0.99)
                    pictures[panel].append(picture(surface, values, up, (-top, top), like=mesh))
        rows += [(f"{name} {panel}".strip(), images) for panel, images in pictures.items()]
    columns = [f"{metric} $\\phi_{{{i + 1}}}$" for metric in METRICS for i in range(SHOWN)]
    title = "Eigenfunctions of shapes, and their partners on locally scaled, remeshed copies"
    publish(settings.output, "fig2_eigenfunctions", grid(rows, columns, title, size=0.75), numbers)


if __name__ == "__main__":
    main()

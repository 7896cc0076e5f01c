"""Thirty farthest points from a tip, and their Voronoi cells in diffusion distance, in two metrics (Fig. 6).

The number is the share of the area of the shape that is in the same cell on its copy. `own`, as in the paper: both are
sampled on their own from the same tip on. Which point is the farthest may hang by a hair, most of all on symmetric
shapes, and all later numbers with it; so cells are paired one to one for the largest common area. `carried`: the copy
has the samples of the shape, carried by the truth, so that only the cells may differ.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from common import METRICS, copies, grid, options, picture, publish, shapes
from scipy.optimize import linear_sum_assignment

from geodesics import DiffusionDistance, eigenpairs, embedded, farthest_point_sampling, voronoi_cells
from gmds.deformations.limbs import extremities

COUNT, TIME = 30, 0.05


def main() -> None:
    settings = options("Fig. 6")
    numbers: dict[str, Any] = {}
    rows: list[tuple[str, list[np.ndarray]]] = []
    for name, mesh, up in shapes(settings):
        weight, tip = embedded(mesh).mass / mesh.area, int(extremities(mesh)[0][0])
        made, images = copies(mesh), []
        numbers[name] = {}
        for metric, measure in METRICS.items():
            distance = DiffusionDistance(eigenpairs(measure(mesh), 100), TIME)
            samples = farthest_point_sampling(distance, COUNT, first=tip)
            cells = voronoi_cells(distance, samples)
            for copy, (other, truth) in made.items():
                place = truth.nearest_vertices()
                there = DiffusionDistance(eigenpairs(measure(other), 100), TIME)
                carried = voronoi_cells(there, place[samples])[place]
                own = voronoi_cells(there, farthest_point_sampling(there, COUNT, first=int(place[tip])))
                common = np.zeros((COUNT, COUNT))
                np.add.at(common, (own[place], cells), weight)
                partner = linear_sum_assignment(-common)[1]
                numbers[name].setdefault(copy, {})[metric] = {
                    "own": common[np.arange(COUNT), partner].sum().round(3),
                    "carried": weight[carried == cells].sum().round(3),
                }
            images += [picture(mesh, cells, up), picture(other, partner[own], up, like=mesh)]
        rows.append((name, images))
    columns = [f"{metric}, {which}" for metric in METRICS for which in ("shape", "copy")]
    title = "Voronoi cells of farthest points, found on the shape and on its locally scaled, remeshed copy alone"
    publish(settings.output, "fig6_voronoi", grid(rows, columns, title), numbers)


if __name__ == "__main__":
    main()

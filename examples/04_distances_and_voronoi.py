"""Thirty farthest points from the nose and their Voronoi cells, before and after the head grows (Fig. 6)."""

import geodesics
from geodesics import DiffusionDistance, eigenpairs, farthest_point_sampling, voronoi_cells
from gmds.deformations import local_scaling
from gmds.pictures.values import write_values
from gmds.shapes import quadruped

before = quadruped(n_vertices=1500)
head = 1 / (1 + 2.718 ** (-20 * (before.rest[:, 0] - 0.8)))  # 1 on the head, 0 on the body
after, truth = local_scaling(before, 0.7 * head)
print(f"area {before.area:.2f} before, {after.area:.2f} after")

nose = int(before.vertices[:, 0].argmax())
weight = geodesics.embedded(before).mass / before.area
for metric in (geodesics.embedded, geodesics.scale_invariant):
    cells = []
    for mesh in (before, after):
        distance = DiffusionDistance(eigenpairs(metric(mesh), 80), 0.01)
        cells.append(voronoi_cells(distance, farthest_point_sampling(distance, 30, first=nose)))
    same = weight[cells[0] == cells[1]].sum()
    print(f"{metric.__name__:16} {100 * same:.0f} % of the surface keep their cell")
    write_values(f"{metric.__name__}.png", [("before", before, cells[0]), ("after", after, cells[1])], labels=True)

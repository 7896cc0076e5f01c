"""How far apart shapes are: bounds of the Gromov-Hausdorff and Gromov-Wasserstein distance (abstract, sec. 5)."""

import itertools

import numpy as np

import geodesics
import gmds
from gmds.shapes import humanoid, quadruped

shapes = {
    "standing": quadruped(n_vertices=1000),
    "walking": quadruped("walk", n_vertices=1000, seed=1),
    "large head": quadruped(head_scale=1.6, n_vertices=1000, seed=2),
    "person": humanoid(n_vertices=1000),
}
metrics = {"space": 0.0, "invariant": 1.0}
samples = 80
apart = {name: np.zeros((len(shapes), len(shapes))) for name in metrics}
for name, exponent in metrics.items():
    matrices = []
    for mesh in shapes.values():
        metric = geodesics.scale_invariant(mesh, exponent=exponent, smoothing=0.02)
        distance = geodesics.GeodesicDistance(metric)
        among = geodesics.distance_matrix(distance, geodesics.farthest_point_sampling(distance, samples))
        matrices.append(among / among.mean())
    for (i, one), (j, other) in itertools.combinations(enumerate(shapes), 2):
        most = gmds.gromov_hausdorff_bounds(matrices[i], matrices[j])
        mean = gmds.gromov_wasserstein_bounds(matrices[i], matrices[j])
        apart[name][i, j] = apart[name][j, i] = mean.upper
        print(
            f"{name:9} {one + ', ' + other:22} Hausdorff {most.lower:.2f} to {most.upper:.2f}, "
            f"Wasserstein {mean.lower:.3f} to {mean.upper:.3f}"
        )

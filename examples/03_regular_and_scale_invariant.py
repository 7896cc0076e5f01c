"""Grow some limbs and shrink others: which metric still measures the same distances?"""

import numpy as np

import geodesics
from geodesics import CommuteTimeDistance, DiffusionDistance, GeodesicDistance, SurfacePoints, eigenpairs
from gmds.deformations import branch_log_scale, local_scaling
from gmds.shapes import quadruped

before = quadruped(n_vertices=1500)
after, truth = local_scaling(before, branch_log_scale(before, 2.0, count=4, rng=1))

distances = {
    "diffusion": lambda metric: DiffusionDistance(eigenpairs(metric, 60), 0.02),
    "commute time": lambda metric: CommuteTimeDistance(eigenpairs(metric, 60)),
    "geodesic": GeodesicDistance,
}
samples = geodesics.farthest_point_sampling(GeodesicDistance(geodesics.embedded(before)), 60)
for metric in (geodesics.embedded, geodesics.scale_invariant):
    for name, distance in distances.items():
        old = distance(metric(before)).field(SurfacePoints.at_vertices(before, samples))[:, samples]
        new = distance(metric(after)).field(truth[samples])[:, truth.nearest_vertices()[samples]]
        new *= old.mean() / new.mean()  # one factor for the whole surface is free
        change = np.sqrt(((new - old) ** 2).mean()) / old.mean()
        print(f"{metric.__name__:16} {name:13} distances change by {100 * change:5.1f} %")

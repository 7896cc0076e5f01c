"""Partial generalised multidimensional scaling: where samples go, and which of them have a counterpart (sec. 5)."""

import numpy as np

import geodesics
import gmds
from gmds.deformations import cut
from gmds.shapes import quadruped, truth

source, walking = quadruped(n_vertices=1200), quadruped("walk", n_vertices=1200, seed=1)
part = cut(walking, 0.3, normal=(-1, 0, 0))  # a plane takes away hind legs and tail
target, true = part.mesh, truth(source, walking)
missing = part.missing[true.nearest_vertices()]
distances = [gmds.TabulatedDistance(geodesics.GeodesicDistance(mesh), 100) for mesh in (source, target)]
samples = geodesics.farthest_point_sampling(distances[0], 100)
here = geodesics.SurfacePoints.at_vertices(source, samples)
shaken = true[samples].positions + np.random.default_rng(0).normal(0, 0.1, (100, 3))
start = geodesics.SurfacePoints.closest(target, shaken)


def error(points):
    kept = ~missing[samples]
    return 100 * np.linalg.norm(points.positions - true[samples].positions, axis=1)[kept].mean() / np.sqrt(walking.area)


whole = gmds.solve(gmds.Problem(distances[0], here, distances[1]), start)
found = gmds.solve_partial(distances[0], here, distances[1], start, share=0.7)
print(f"{'rough map':14} mean error x100 {error(start):5.2f}")
print(f"{'all samples':14} mean error x100 {error(whole.points):5.2f}")
print(f"{'a part of them':14} mean error x100 {error(found.solution.points):5.2f}")
print(f"stress of the part {found.stresses[0]:.2f} to {found.stresses[-1]:.2f}")
left, kept = found.weights[missing[samples]], found.weights[~missing[samples]]
print(f"mean weight of samples without counterpart {left.mean():.2f}, with {kept.mean():.2f}")
weights = found.weights[geodesics.distance_matrix(distances[0], samples, np.arange(1200)).argmin(axis=0)]

"""Spectral generalised multidimensional scaling beside that of points: a rough map improved by distances (sec. 5)."""

import time

import numpy as np

import geodesics
import gmds
from gmds.shapes import quadruped, truth

source, target = quadruped(n_vertices=1200), quadruped("walk", n_vertices=1200, seed=1)
true = truth(source, target)
shaken = true.positions + np.random.default_rng(0).normal(0, 0.15, (source.n_vertices, 3))
rough = geodesics.SurfacePoints.closest(target, shaken)
distances = [geodesics.GeodesicDistance(mesh) for mesh in (source, target)]
samples = geodesics.farthest_point_sampling(distances[0], 100)


def error(points, of=slice(None)):
    return 100 * gmds.geodesic_error(points, true[of]).mean()


print(f"{'rough map':26} mean error x100 {error(rough):5.2f}")
began = time.process_time()
placed = gmds.spectral_gmds(*distances, rough, count=40, samples=100)
told = f"{error(placed.points):5.2f} at all vertices, {time.process_time() - began:.1f} s"
print(f"{'orthogonal matrix':26} mean error x100 {told}")

began = time.process_time()
tables = [gmds.TabulatedDistance(distance, 100) for distance in distances]
problem = gmds.Problem(tables[0], geodesics.SurfacePoints.at_vertices(source, samples), tables[1])
solution = gmds.solve(problem, rough[samples], gmds.Huber())
told = f"{error(solution.points, samples):5.2f} at 100 samples, {time.process_time() - began:.1f} s"
print(f"{'points on the triangles':26} mean error x100 {told}")

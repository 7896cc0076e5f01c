"""The caricature |K|^gamma: a local scale that the surface itself suggests, undone by the metric of (2.1)."""

import numpy as np

import geodesics
from gmds.deformations import achieved_log_scale, caricature
from gmds.shapes import quadruped

mesh = quadruped(n_vertices=2000)
caricatures = {exponent: caricature(mesh, exponent)[0] for exponent in (0.0, 0.2, 0.4)}
samples = geodesics.farthest_point_sampling(geodesics.GeodesicDistance(mesh), 40)
for exponent, drawn in caricatures.items():
    growth = np.exp(achieved_log_scale(mesh, drawn))
    change = {}
    for metric in (geodesics.embedded, geodesics.scale_invariant):
        distances = [geodesics.GeodesicDistance(metric(m)) for m in (mesh, drawn)]
        before, after = (geodesics.distance_matrix(distance, samples) for distance in distances)
        before, after = before / before.mean(), after / after.mean()
        change[metric.__name__] = 100 * np.abs(after - before).mean()
    print(f"gamma {exponent:.1f}: parts grow by {growth.min():.2f} to {growth.max():.2f},", end=" ")
    print(f"distances change by {change['embedded']:4.1f} % in space, {change['scale_invariant']:4.1f} % in |K| g")

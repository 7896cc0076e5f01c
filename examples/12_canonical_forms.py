"""Canonical forms: two poses of an animal unbent into space, by three scalings and in two metrics (beside sec. 5)."""

import numpy as np

import geodesics
import gmds
from gmds.shapes import quadruped, truth

poses = {"stand": quadruped(n_vertices=1200), "walk": quadruped("walk", n_vertices=1200, seed=1)}
partner = truth(*poses.values()).nearest_vertices()


def gap(x, y):
    """The root mean square gap of points after the best rigid motion, over their spread."""
    x, y = x - x.mean(axis=0), y - y.mean(axis=0)
    u, _, vt = np.linalg.svd(x.T @ y)
    return np.linalg.norm(x @ u @ vt - y) / np.linalg.norm(y)


print(f"{'as they are':40} {100 * gap(poses['stand'].vertices, poses['walk'].vertices[partner]):5.1f} % apart")
forms = {}
for exponent in (0.0, 1.0):
    for method in ("least squares", "classical", "spectral"):
        pair = []
        for mesh in poses.values():
            distance = geodesics.GeodesicDistance(geodesics.scale_invariant(mesh, exponent=exponent, smoothing=0.02))
            pair.append(gmds.canonical_form(distance, 3, method=method, samples=150))
        forms[exponent, method] = pair
        apart = 100 * gap(pair[0].positions, pair[1].positions[partner])
        print(f"|K|^{exponent:g} g, {method:31} {apart:5.1f} % apart, stress {pair[0].stress:.3f}")

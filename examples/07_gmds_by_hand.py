"""Generalised multidimensional scaling step by step: samples, a start, a problem, three losses (sec. 5, Fig. 7)."""

import numpy as np

import geodesics
import gmds
from gmds.shapes import quadruped, truth

source = quadruped(n_vertices=1500)
target = quadruped("walk", head_scale=1.5, n_vertices=1500, seed=1)
d_source, d_target = (
    geodesics.CommuteTimeDistance(geodesics.eigenpairs(geodesics.scale_invariant(mesh), 40))
    for mesh in (source, target)
)
samples = geodesics.farthest_point_sampling(d_source, 40)
problem = gmds.Problem(d_source, geodesics.SurfacePoints.at_vertices(source, samples), d_target)

true = truth(source, target)[samples]
rough = true.positions + np.random.default_rng(0).normal(0, 0.1, (40, 3))  # off by a tenth of the height
nearest = np.linalg.norm(target.vertices[None] - rough[:, None], axis=2).argmin(axis=1)
start = geodesics.SurfacePoints.at_vertices(target, nearest)
print(f"start: mean error x100 {100 * gmds.geodesic_error(start, true).mean():.2f}")
for loss in (gmds.LeastSquares(), gmds.Huber(), gmds.Minimax()):
    solution = gmds.solve(problem, start, loss)
    error = 100 * gmds.geodesic_error(solution.points, true).mean()
    start = solution.points  # the next loss goes on from here: minimax wants a good start
    print(f"{type(loss).__name__:13} stress {solution.stress:.4f}, error x100 {error:.2f}; {solution.status.value}")

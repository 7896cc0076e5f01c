"""Eigenfunctions of a shape and of its locally scaled copy, in two metrics (Fig. 2, Fig. 3)."""

import numpy as np
from scipy.optimize import linear_sum_assignment

import geodesics
from gmds.deformations import branch_log_scale, local_scaling
from gmds.pictures.values import write_values
from gmds.shapes import quadruped

before = quadruped(n_vertices=1500)
after, _ = local_scaling(before, branch_log_scale(before, 2.0, count=4, rng=1))
for metric in (geodesics.embedded, geodesics.scale_invariant):
    old, new = (geodesics.eigenpairs(metric(mesh), 16) for mesh in (before, after))
    # correlations over the old surface, constants left out; eigenfunctions may change places and sign
    a, b = old.eigenfunctions[:, 1:11], new.eigenfunctions[:, 1:16]
    b = b - old.mass @ b / old.mass.sum()
    correlation = a.T @ (old.mass[:, None] * b) / np.sqrt(old.mass @ b**2)
    rows, columns = linear_sum_assignment(-np.abs(correlation))
    matched = np.abs(correlation[rows, columns])
    print(f"{metric.__name__:16} matched eigenfunctions correlate by {matched.mean():.3f}, worst {matched.min():.3f}")
    sign = np.sign(correlation[0, columns[0]])
    panels = [("before", before, a[:, 0]), ("after", after, sign * new.eigenfunctions[:, 1 + columns[0]])]
    write_values(f"{metric.__name__}.png", panels, title=f"first eigenfunction, {metric.__name__}")

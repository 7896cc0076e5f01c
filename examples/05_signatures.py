"""Heat kernel signatures of a shape and its locally scaled copy, in two metrics (Fig. 4, Fig. 5)."""

import numpy as np

import geodesics
from gmds.deformations import branch_log_scale, local_scaling
from gmds.shapes import quadruped

before = quadruped(n_vertices=1500)
after, _ = local_scaling(before, branch_log_scale(before, 2.0, count=4, rng=1))
times = np.geomspace(0.01, 0.3, 20)  # in units of the area of each surface
signatures = {
    "heat kernel": lambda spectrum: geodesics.heat_kernel_signature(spectrum, times),
    "scaled heat kernel": lambda spectrum: geodesics.scaled_heat_kernel_signature(spectrum, times),
    "scale-invariant heat kernel": geodesics.scale_invariant_heat_kernel_signature,
    "wave kernel": geodesics.wave_kernel_signature,
}
for metric in (geodesics.embedded, geodesics.scale_invariant):
    spectra = [geodesics.eigenpairs(metric(mesh), 100) for mesh in (before, after)]
    for name, signature in signatures.items():
        old, new = (signature(spectrum) for spectrum in spectra)
        change = np.linalg.norm(new - old, axis=1).mean() / np.linalg.norm(old - old.mean(axis=0), axis=1).mean()
        print(f"{metric.__name__:16} {name:28} moves by {change:.2f} of its spread over the surface")

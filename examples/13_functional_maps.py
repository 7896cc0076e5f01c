"""Functional maps: from descriptors, refined, to points and back, and of one surface in two metrics (sec. 4)."""

import numpy as np

import geodesics
import gmds
from gmds.shapes import quadruped, truth

source, target = quadruped(n_vertices=1200), quadruped("walk", n_vertices=1200, seed=1)
true = truth(source, target)
spectra = [geodesics.eigenpairs(mesh, 60) for mesh in (source, target)]

maps = {"descriptors": gmds.functional_map(*spectra, count=20)}
maps["zoomed out"] = maps["descriptors"].zoomed_out(60)
maps["mirrored"] = gmds.functional_map(*spectra, count=20, orientation="reverse").zoomed_out(60)
maps["from the truth"] = gmds.functional_map(*spectra, points=true, count=60)
for name, found in maps.items():
    error = 100 * gmds.geodesic_error(found.points(), true).mean()
    gram = found.matrix.T @ found.matrix
    off = np.abs(gram - np.eye(len(gram))).mean()
    print(f"{name:15} {found.matrix.shape[0]} functions, mean error x100 {error:5.2f}, from orthogonal {off:.3f}")

signatures = [gmds.self_functional_map(mesh, 12) for mesh in (source, target)]
change = np.abs(np.abs(signatures[0]) - np.abs(signatures[1])).mean() / np.abs(signatures[0]).mean()
print(f"self functional maps of both poses differ by {100 * change:.0f} %")

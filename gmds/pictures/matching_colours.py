"""Colours of a target, by which a map is read: smooth all over, and unlike each other at the tips of limbs."""

from __future__ import annotations

import numpy as np
from scipy.optimize import linear_sum_assignment

from geodesics import Mesh
from geodesics.arrays import Floats, Integers
from geodesics.caching import memoized
from geodesics.topology.components import vertex_components
from geodesics.topology.edge_paths import edge_distances
from gmds.pictures.colours import oklab_to_rgb, position_oklab

# OKLab of tips. Any two are 30 apart in CIEDE2000, 19 to eyes without green or red (Machado, Oliveira, Fernandes 2009),
# at least 32 degrees of hue, and 12 from the greys: the best of 120 local searches for the smallest of these
TIPS = np.array(
    [
        (0.38, 0.14, 0.0), (0.45, -0.04, -0.12), (0.52, 0.10, 0.10), (0.59, -0.10, 0.02),
        (0.66, 0.12, -0.18), (0.695, 0.0, 0.14), (0.835, -0.08, -0.06), (0.905, -0.08, 0.08),
    ]
)  # fmt: skip
SPREAD = 12  # farthest points among which tips are sought: limbs, head, ears and tail of an animal are 8; set by hand
# A tip is where nothing within 0.15 of the diameter is farther from all of these points by more than 3 %: four limbs of
# 44 built-in animals and people in all poses are found by 0.10 - 0.2 and 1 - 10 % alike
AROUND, SLACK = 0.15, 0.97


@memoized
def matching_colours(mesh: Mesh) -> Floats:
    """Colours (n, 3) in [0, 1] of the vertices: neighbours alike, limbs told apart, by the colour blind as well.

    Positions give the colour (`position_colours`), and each extremity one of eight colours that are far from each
    other, which fades out along the surface to half way to the next one.

    Examples
    --------
    >>> from gmds.shapes import quadruped
    >>> animal = quadruped(n_vertices=500)
    >>> matching_colours(animal).shape
    (500, 3)
    """
    lab = position_oklab(mesh.vertices)
    tips, distances = extremities(mesh)
    if len(tips) > 1:
        unlike = ((lab[tips, None] - TIPS) ** 2).sum(axis=2)
        colours = TIPS[linear_sum_assignment(unlike)[1]]
        gaps = distances[:, tips] + np.diag(np.full(len(tips), np.inf))
        near = (1 - 2 * distances / gaps.min(axis=1, keepdims=True)).clip(0, 1)
        share = near**2 * (3 - 2 * near)
        lab = lab * (1 - share.sum(axis=0))[:, None] + share.T @ colours
    return oklab_to_rgb(lab)


def extremities(mesh: Mesh) -> tuple[Integers, Floats]:
    """At most eight vertices (k,), farther from all else than those around them, and distances (k, n) from them.

    Distances are along edges, infinite on other components; tips are those of the component with the most vertices.
    """
    component = vertex_components(mesh)
    inside = component == np.bincount(component[component >= 0]).argmax()
    nearest = np.where(inside, edge_distances(mesh, inside.argmax())[0], -1)
    points, rows = np.zeros(SPREAD, dtype=np.int64), []
    for k in range(SPREAD):
        points[k] = nearest.argmax()
        rows.append(edge_distances(mesh, points[k])[0])
        nearest = np.minimum(nearest, rows[-1]) if k else np.where(inside, rows[0], -1)
    distances = np.array(rows)
    far = distances.mean(axis=0)
    reach = AROUND * distances[:, points].max()
    tips = [i for i, point in enumerate(points) if far[point] >= SLACK * far[distances[i] <= reach].max()]
    kept = [i for k, i in enumerate(tips) if points[i] not in points[tips[:k]]][: len(TIPS)]
    return points[kept], distances[kept]

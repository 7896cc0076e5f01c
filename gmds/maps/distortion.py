r"""What the distortion of a map is, as a formula.

Of an edge of the source with length :math:`l`, whose ends the map sends :math:`l'` apart in space,

.. math:: 1 - \frac{\min(l', s \, l)}{\max(l', s \, l)}

is 0 where the length stays and 1 where the edge collapses or tears; the scale :math:`s` of the map is the median of
:math:`l' / l`, so that a copy of another size has no distortion. A vertex takes the mean over its edges, and
`gmds.matching.result.distortion_of` averages that over the surface around it. On an exact isometry (the identity, a
mirror image, a copy that was moved) it is 0 up to rounding, and up to the length of edges where both have other
triangles.
"""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats
from geodesics.mesh import Mesh
from geodesics.topology.edges import edges

UNKNOWN = 1.0  # the distortion of a vertex on no edge that has a length: a convention


def edge_distortion(source: Mesh, images: Floats) -> Floats:
    """The mean over the edges of each vertex (n,), in [0, 1], of what their lengths change by.

    `images` (n, 3) are the positions of the images of the vertices.
    """
    ends = edges(source).ends
    before, after = (np.linalg.norm(x[ends[:, 0]] - x[ends[:, 1]], axis=1) for x in (source.vertices, images))
    proper = before > 0
    ends, before, after = ends[proper], before[proper], after[proper]
    scale = float(np.median(after / before)) if len(before) else 1.0
    before *= scale or 1.0
    change = 1 - np.minimum(before, after) / np.maximum(before, after)
    count = np.bincount(ends.ravel(), minlength=source.n_vertices)
    total = np.bincount(ends.ravel(), np.repeat(change, 2), source.n_vertices)
    return np.where(count > 0, total / np.maximum(count, 1), UNKNOWN)

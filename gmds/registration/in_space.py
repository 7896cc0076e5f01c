"""A map registered once more from the similarity that it is nearest to, for surfaces that keep their shape.

Registration lets every neighbourhood turn by itself, as limbs do. What has none slides in itself then, at next to no
cost: a tooth, a brain, a bone. From a map that is right but for that, a similarity takes what is right.
"""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats
from gmds.registration.deformable import DeformableMesh
from gmds.registration.register import Registered, settled
from gmds.registration.settings import AFFINE
from gmds.registration.similarity import nearest_similarity

# Root areas from a similarity within which anything keeps its shape, limbs or not: skulls lie at 0.008 - 0.014, people
# in one pose at 0.026 and more (benchmarks/results/notes.md, "Shapes without limbs").
HARDLY_BENT = 0.02


def similar(source: DeformableMesh, y: Floats) -> Floats:
    """Where the similarity that is nearest to vertices at y (n, 3) sends them, without mirroring."""
    return nearest_similarity(source.mesh.vertices, y, source.areas).moved(source.mesh.vertices)


def bent(source: DeformableMesh, y: Floats) -> float:
    """Root mean square distance, in root areas, between vertices at y (n, 3) and where a similarity sends them."""
    return float(np.sqrt(source.areas @ ((y - similar(source, y)) ** 2).sum(axis=1)))


def in_space(source: DeformableMesh, target: DeformableMesh, y: Floats) -> Registered:
    """The source laid on the target by the similarity nearest to y (n, 3), and from there as affinely as possible."""
    return settled(source, target, similar(source, y), AFFINE)

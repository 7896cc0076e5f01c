"""The left and right of an atlas: where each point of the mean shape is on its other side."""

from __future__ import annotations

from geodesics import Mesh, SurfacePoints
from gmds.atlases.registered import MIRROR
from gmds.maps.point_map import MatchStatus
from gmds.matching.pipeline import match

TURNED = [0, 2, 1]  # corners of a face of the mirror image, so that it still faces outward


def partners(mean: Mesh) -> tuple[SurfacePoints, MatchStatus]:
    """Where each vertex (n,) is on the other side: the map of a shape to its mirror image, and how far to trust it.

    As that map keeps orientation, on the shape itself it exchanges left and right. No plane need be known, nor need the
    pose be symmetric.
    """
    image = Mesh(mean.vertices * MIRROR, mean.faces[:, TURNED])
    answer = match(mean, image)
    return SurfacePoints(mean, answer.points.face, answer.points.barycentric[:, TURNED]), answer.status

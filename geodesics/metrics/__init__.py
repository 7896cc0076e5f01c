"""One metric a file; each is a function Mesh -> Metric.

To add a metric, add its file, and its name to `ALL`: every test of metrics then runs on it.
"""

from __future__ import annotations

from collections.abc import Callable

from geodesics.mesh import Mesh
from geodesics.metric import Metric
from geodesics.metrics.affine import affine
from geodesics.metrics.arc_lengths import (
    curvature_ratio_length,
    first_curvature_length,
    gaussian_curvature_length,
    second_curvature_length,
)
from geodesics.metrics.embedded import embedded
from geodesics.metrics.equi_affine import equi_affine
from geodesics.metrics.min_curvature import min_curvature
from geodesics.metrics.scale_invariant import scale_invariant

ALL: tuple[Callable[[Mesh], Metric], ...] = (
    embedded,
    scale_invariant,
    min_curvature,
    equi_affine,
    affine,
    first_curvature_length,
    second_curvature_length,
    curvature_ratio_length,
    gaussian_curvature_length,
)

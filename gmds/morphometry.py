"""How far apart two shapes are: the distortion of the best embedding of one in the other (sec. 5)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from geodesics import Mesh
from geodesics.threads import on_one_blas_thread
from gmds import initialization
from gmds.hypotheses import hypotheses
from gmds.profiles import distances_of, shares, views
from gmds.surface import View
from gmds.upsampling import SampledPair

Array = NDArray[np.float64]

KEPT = 8  # embeddings that each metric proposes


@on_one_blas_thread
def dissimilarity(a: Mesh, b: Mesh) -> float:
    """How far apart two shapes are, whatever their poses and sizes and, within limits, the sizes of their parts; >= 0.

    "Morphometric similarity" of the abstract: the mean |d_S(s, s') - d_Q(rho s, rho s')| over the mean distance, for
    the best map rho found of either surface into the other (sec. 5), in the scale-invariant metric (2.1); metrics and
    distance are those of `distance_profile`. Symmetric, and 0 for congruent shapes, moved, resized or mirrored, up to
    rounding. It takes seconds; `least_distortion` of two `distance_profile`s takes a millisecond, and finds no
    map. Raises `TooFewVertices` (E113), `MeshError`.
    """
    return embedding_distortion(views(Mesh.from_object(a)), views(Mesh.from_object(b)))


def embedding_distortion(ours: Sequence[View], theirs: Sequence[View]) -> float:
    """The distortion of the best map found from either surface to the other, given their `views` (sec. 5).

    Starts are refined in each metric; every map is judged by its mean distortion over all metrics.
    """
    return min(_one_way(ours, theirs), _one_way(theirs, ours))


def _one_way(source: Sequence[View], target: Sequence[View]) -> float:
    """The least distortion of the maps found from source to target."""
    here = [shares(view) for view in source]
    before = [distances_of(view, places) for view, places in zip(source, here, strict=True)]
    least = np.inf
    for views_of_one in zip(source, target, strict=True):
        pair = SampledPair.of(*views_of_one, sense=0)
        for images in hypotheses(pair, initialization.ALL, KEPT):
            gaps = [
                np.abs(known - distances_of(view, pair.carried(images, places, view.usable))).mean()
                for known, view, places in zip(before, target, here, strict=True)
            ]
            least = min(least, float(np.mean(gaps)))
    return least

"""What two shapes may be compared by before any map is known: a description of each, and how far two are apart."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from geodesics import Mesh
from geodesics.arrays import Floats
from gmds.comparison import profiles
from gmds.spectral_maps.self_functional_map import self_functional_features
from gmds.surface.measured import SMOOTHING, measure

COUNT = 20  # eigenfunctions in each metric, as `self_functional_features` has them


class Described(NamedTuple):
    """A way to describe a shape and to compare two; `settings` tell what is kept from what must be made anew."""

    folder: str
    settings: str
    words: str
    describe: Callable[[Mesh], Floats]
    gap: Callable[[Floats, Floats], float]


def _maps_of(mesh: Mesh) -> Floats:
    return self_functional_features(measure(mesh).mesh, COUNT)


def _apart(one: Floats, other: Floats) -> float:
    return float(np.linalg.norm(one - other))


BY_DISTANCES = Described(
    "profiles",
    f"{profiles.FUNCTIONS} {profiles.EQUAL_AREA_SAMPLES} {profiles.QUANTILES} {SMOOTHING}",
    "the bound, which no embedding that keeps area goes below",
    profiles.distance_profile,
    profiles.least_distortion,
)
"""Distributions of distances, `gmds.distance_profile` and `gmds.least_distortion`."""

BY_SELF_MAPS = Described(
    "self_functional_maps",
    f"{COUNT}",
    "the distance between self functional maps without signs (Halimi and Kimmel 2018)",
    _maps_of,
    _apart,
)
"""How the eigenfunctions of space and of the scale-invariant metric are made of each other."""

ALL = {"distances": BY_DISTANCES, "self-functional-maps": BY_SELF_MAPS}

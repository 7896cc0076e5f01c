"""Geodesic distance: the object, its seeds, its front."""

from __future__ import annotations

from geodesics.fast_marching.distance import GeodesicDistance
from geodesics.moved_paths import MOVED, names_moved

__all__ = ["GeodesicDistance"]


__getattr__ = names_moved(__name__, MOVED[__name__])

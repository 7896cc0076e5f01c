"""A mesh made from a mesh: repaired, cut, decimated, triangulated evenly, remeshed."""

from __future__ import annotations

from geodesics.moved_paths import MOVED, names_moved
from geodesics.repair.decimation import decimate
from geodesics.repair.remeshing import fill_holes, remesh
from geodesics.repair.repairing import Repaired, inverse_index, repair

__all__ = ["Repaired", "decimate", "fill_holes", "inverse_index", "remesh", "repair"]


__getattr__ = names_moved(__name__, MOVED[__name__])

"""`match` and `self_symmetry`: pair -> proposals -> candidates -> polishing -> result."""

from __future__ import annotations

from geodesics.moved_paths import names_moved
from gmds.moved_paths import MOVED

__getattr__ = names_moved(__name__, MOVED[__name__])

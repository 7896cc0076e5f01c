"""One surface, measured once: largest part, unit area, spectra in several metrics."""

from __future__ import annotations

from geodesics.moved_paths import names_moved
from gmds.moved_paths import MOVED
from gmds.surface.measured import Surface, measure, view_of
from gmds.surface.originals import on_original
from gmds.surface.view import View

__all__ = ["Surface", "View", "measure", "on_original", "view_of"]


__getattr__ = names_moved(__name__, MOVED[__name__])

"""Pictures without a screen: colours, camera, two renderers, panels."""

from __future__ import annotations

from geodesics.moved_paths import names_moved
from gmds.moved_paths import MOVED
from gmds.pictures.panels import write_picture
from gmds.pictures.values import write_coloured, write_values

__all__ = ["write_coloured", "write_picture", "write_values"]


__getattr__ = names_moved(__name__, MOVED[__name__])

"""How faces are connected: edges, components, orientation, invariants."""

from __future__ import annotations

from geodesics.moved_paths import MOVED, names_moved
from geodesics.topology.components import boundary_vertices, vertex_components

__all__ = ["boundary_vertices", "vertex_components"]

__getattr__ = names_moved(__name__, MOVED[__name__])

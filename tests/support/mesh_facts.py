"""What tests ask about a mesh: its area, and what is wrong with it."""

from __future__ import annotations

import numpy as np

from geodesics import Mesh
from geodesics.check import check


def area(mesh: Mesh) -> float:
    """Area of all faces."""
    a, b, c = mesh.vertices[mesh.faces.T]
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def warnings(mesh: Mesh) -> set[str]:
    """Codes of the warnings of `check`."""
    return {note.code for note in check(mesh) if note.severity == "warning"}

"""Positions moved to the surface that they were measured on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geodesics import Mesh, MeshError, SurfacePoints
from geodesics.arrays import Floats
from geodesics.errors import Note
from gmds.errors import LandmarkError

FARTHEST_LANDMARK = 0.05  # of the diagonal of the bounding box, off the surface: a convention, beyond is a mistake


def called_by(names: Sequence[str], i: int) -> str:
    """What an error calls landmark i: by its name, or by its row."""
    return f"landmark {names[i]!r}" if len(names) else f"landmark {i} (counted from 0)"


def snapped(given: NDArray[Any], mesh: Mesh, name: str, notes: list[Note], called: Sequence[str]) -> SurfacePoints:
    """The points of the mesh closest to positions (k, 3), and a note (W301) on how far they were moved."""
    try:
        points = SurfacePoints.closest(mesh, given)
    except MeshError as error:
        raise LandmarkError("E300", f"positions of the {name} landmarks: {error}") from error
    share = _off(points, given)
    worst = int(share.argmax())
    if share[worst] > FARTHEST_LANDMARK:
        raise LandmarkError(
            "E305",
            f"{called_by(called, worst)} lies {share[worst]:.1%} of the diagonal of the {name} off its surface "
            f"(at most 5 %); {_advice(given, mesh, worst)}",
        )
    moved = np.flatnonzero(share > 1e-6)
    if len(moved):
        message = (
            f"{len(moved)} landmarks of the {name} moved to its surface, by up to {share[worst]:.2%} of the diagonal"
        )
        notes.append(Note("W301", "info", message, tuple(moved.tolist())))
    return points


def _off(points: SurfacePoints, given: NDArray[Any]) -> Floats:
    """How far positions (k, 3) are from the points closest to them, in diagonals of the bounding box."""
    diagonal = np.linalg.norm(np.ptp(points.mesh.vertices[points.mesh.faces], axis=(0, 1)))
    return np.asarray(np.linalg.norm(points.positions - given, axis=1) / diagonal)


def _advice(given: NDArray[Any], mesh: Mesh, worst: int) -> str:
    """What may be the matter with positions off the surface: a missing one, the other frame of 3D Slicer, or the mesh.

    Programs write -1, 0, 9999 or the like three times for a landmark that is missing.
    """
    first = float(given[worst, 0])
    if (given[worst] == first).all() and first == round(first):
        return f"its coordinates are all {first:g}, as some programs write for one that is missing: write NA there"
    turned = given * np.array([-1.0, -1.0, 1.0])
    if _off(SurfacePoints.closest(mesh, turned), turned).max() <= FARTHEST_LANDMARK:
        return (
            "with the signs of x and y changed all lie on it, so mesh and landmarks are in different frames: "
            'say --space RAS (space="RAS" in Python), or LPS where RAS was said'
        )
    return "do landmarks and mesh belong together, in the same units and frame (--space RAS or LPS)?"

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
# The other frame is meant where the root mean square distance from the surface is more than this share of the diagonal
# in the one that was assumed, and less than a tenth of that in the other; both set by hand. Where a surface is much the
# same turned by half a circle about z both fit, and nothing is said.
OFF_IN_ONE_FRAME = 0.005
SHARE_IN_OTHER = 0.1
DIFFERENT = (
    'so mesh and landmarks are in different frames: say --space RAS (space="RAS" in Python), or LPS where RAS was said'
)


def called_by(names: Sequence[str], i: int) -> str:
    """What an error calls landmark i: by its name, or by its row."""
    return f"landmark {names[i]!r}" if len(names) else f"landmark {i} (counted from 0)"


def snapped(
    given: NDArray[Any], mesh: Mesh, name: str, notes: list[Note], called: Sequence[str], *, framed: bool = False
) -> SurfacePoints:
    """The points of the mesh closest to positions (k, 3), and a note (W301) on how far they were moved.

    `framed`: a file said the frame of the positions, so they are refused (E305) where they fit far better in the other.
    """
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
    if framed:
        _refuse_other_frame(given, mesh, name, share)
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


def _off_in_other_frame(given: NDArray[Any], mesh: Mesh) -> Floats:
    """As `_off`, with the signs of x and y changed."""
    turned = given * np.array([-1.0, -1.0, 1.0])
    return _off(SurfacePoints.closest(mesh, turned), turned)


def _refuse_other_frame(given: NDArray[Any], mesh: Mesh, name: str, share: Floats) -> None:
    """Raise E305 where positions, `share` (k,) of the diagonal off the surface, lie on it in the other frame."""
    here = float(np.sqrt(np.mean(share**2)))
    if here <= OFF_IN_ONE_FRAME:
        return
    there = float(np.sqrt(np.mean(_off_in_other_frame(given, mesh) ** 2)))
    if there < SHARE_IN_OTHER * here:
        raise LandmarkError(
            "E305",
            f"the landmarks of the {name} lie {here:.1%} of its diagonal off its surface (root mean square), "
            f"but {there:.2%} with the signs of x and y changed, {DIFFERENT}",
        )


def _advice(given: NDArray[Any], mesh: Mesh, worst: int) -> str:
    """What may be the matter with positions off the surface: a missing one, the other frame of 3D Slicer, or the mesh.

    Programs write -1, 0, 9999 or the like three times for a landmark that is missing.
    """
    first = float(given[worst, 0])
    if (given[worst] == first).all() and first == round(first):
        return f"its coordinates are all {first:g}, as some programs write for one that is missing: write NA there"
    if _off_in_other_frame(given, mesh).max() <= FARTHEST_LANDMARK:
        return f"with the signs of x and y changed all lie on it, {DIFFERENT}"
    return "do landmarks and mesh belong together, in the same units and frame (--space RAS or LPS)?"

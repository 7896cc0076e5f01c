"""Which of the specimens of one file belong to a surface."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from geodesics import Mesh
from geodesics.closest import closest_on_triangles
from gmds.landmarks.files.named_points import BadLandmarkFile, Landmarks, Specimens

ON_SURFACE = 1e-3  # of the diagonal of the bounding box: landmarks so near lie on a surface; set by hand, as the next
CLEARLY = 10  # times farther off the landmarks of every other specimen must be
SHOWN = 8  # names that an error lists


def only(specimens: Specimens, path: str | os.PathLike[str], wanted: str | None) -> Landmarks:
    """Those of the specimen of that name, or of the only one. Raises `BadLandmarkFile` (E306) with the names."""
    if wanted is None and len(specimens) == 1:
        return next(iter(specimens.values()))
    if wanted in specimens:
        return specimens[wanted]
    names = ", ".join(list(specimens)[:SHOWN]) + (", ..." if len(specimens) > SHOWN else "")
    if list(specimens) == [""]:
        raise BadLandmarkFile(f"{path} holds the landmarks of one surface, and there is no specimen {wanted!r}")
    if wanted is not None:
        raise BadLandmarkFile(f"{path} holds no specimen {wanted!r}; it has {names}")
    raise BadLandmarkFile(
        f"{path} holds {len(specimens)} specimens; say which: --specimen NAME, in Python specimen=; they are {names}"
    )


def belonging_to(specimens: Specimens, mesh: Mesh, mesh_file: Path) -> tuple[str, str] | None:
    """The specimen of a mesh among several, and why: it is named as its file, or it alone lies on its surface."""
    stem = mesh_file.stem.casefold()
    named = [name for name in specimens if stem in (name.casefold(), Path(name).stem.casefold())]
    if len(named) == 1:
        return named[0], f"it is named as {mesh_file.name}"
    off = {name: _farthest(one, mesh) for name, one in specimens.items()}
    nearest = min(off, key=lambda name: off[name])
    others = min((far for name, far in off.items() if name != nearest), default=np.inf)
    if off[nearest] <= ON_SURFACE and others > CLEARLY * max(off[nearest], ON_SURFACE):
        return nearest, f"its landmarks lie on {mesh_file.name}"
    return None


def _farthest(landmarks: Landmarks, mesh: Mesh) -> float:
    """How far off the surface the farthest landmark lies, in diagonals; infinitely far when they are no positions."""
    if landmarks.at.shape[1:] != (3,):
        return np.inf
    places = landmarks.at[landmarks.defined]
    _, _, distance = closest_on_triangles(places, mesh.vertices, mesh.faces)
    return float(np.asarray(distance).max() / np.linalg.norm(np.ptp(mesh.vertices[mesh.faces], axis=(0, 1))))

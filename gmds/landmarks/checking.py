"""Landmarks: known corresponding points, in any of the forms people have them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geodesics import Mesh, MeshError, SurfacePoints
from geodesics.arrays import Floats
from geodesics.errors import Note
from gmds.errors import LandmarkError
from gmds.landmarks.files import Landmarks, paired
from gmds.landmarks.placed import PlacedLandmarks
from gmds.landmarks.snapping import called_by, snapped
from gmds.landmarks.soft import SoftLandmarks

LARGEST_TOLERANCE = 1e6  # square roots of the area: a larger one says no more, and squares have to stay numbers


def check_landmarks(landmarks: Any, source: Mesh, target: Mesh) -> tuple[SurfacePoints, SurfacePoints]:
    """Corresponding points of both surfaces from what a user gives.

    Parameters
    ----------
    landmarks : array_like, pair or SoftLandmarks
        Two `Landmarks`, as files hold them, which names pair; an array (k, 2) of vertex index pairs; or a pair
        (on source, on target) whose halves are vertex indices (k,), positions in space (k, 3) that are moved to the
        closest surface point, rows (k, 4) of a face and three barycentric weights, or `SurfacePoints`. Two nested lists
        of two indices each are read as two index pairs.
    source, target : Mesh
        The surfaces.

    Returns
    -------
    on_source, on_target : SurfacePoints
        k points each.

    Raises
    ------
    LandmarkError
        For another form (E300), vertices or faces that do not exist (E301), points given twice (E302), unequal counts
        (E303), vertices on no face (E304), and positions more than 5 % of the diagonal off the surface, or of a file
        that says its frame and fits far better in the other one (E305).

    See Also
    --------
    match : Takes landmarks in all these forms.
    """
    placed = place_landmarks(landmarks, source, target)
    return placed.on_source, placed.on_target


def place_landmarks(landmarks: Any, source: Mesh, target: Mesh) -> PlacedLandmarks:
    """As `check_landmarks`, with tolerances, and a note (W301) on positions moved to the surface, and how far."""
    if isinstance(landmarks, PlacedLandmarks):
        return landmarks
    notes: list[Note] = []
    sides = []
    tolerance: ArrayLike = 0.0
    if isinstance(landmarks, SoftLandmarks):
        landmarks, tolerance = landmarks.landmarks, landmarks.tolerance
    called: tuple[Sequence[str], Sequence[str]] = (), ()
    if isinstance(landmarks, (tuple, list)) and len(landmarks) == 2 and _are_named(landmarks):
        landmarks, called = _both_have(*landmarks)
    meshes, titles = (source, target), ("source", "target")
    for given, mesh, name, names in zip(_halves(landmarks), meshes, titles, called, strict=True):
        sides.append(_place(given, mesh, name, notes, names))
    on_source, on_target = sides
    if len(on_source) != len(on_target):
        raise LandmarkError(
            "E303", f"{len(on_source)} landmarks on the source but {len(on_target)} on the target; give one for each"
        )
    held = _tolerances(tolerance, len(on_source))
    return PlacedLandmarks(on_source, on_target, held, tuple(notes), tuple(called[0]))


def place_on(given: Any, mesh: Mesh, name: str = "surface", called: Sequence[str] = ()) -> SurfacePoints:
    """Landmarks of one mesh, vertices (k,) or positions (k, 3), as points of it; raises as `check_landmarks`.

    `called`: the names (k,) by which errors call them; else their rows.
    """
    return _place(given, mesh, name, [], called)


def _are_named(landmarks: Sequence[Any]) -> bool:
    return all(isinstance(half, Landmarks) for half in landmarks)


def _both_have(source: Landmarks, target: Landmarks) -> tuple[Any, tuple[Sequence[str], Sequence[str]]]:
    """Landmarks as they are read from files, in one order, and their names."""
    ours, theirs, alone = paired(source, target)
    if alone:
        message = f"{len(alone)} landmarks are on one surface only ({', '.join(alone[:5])})"
        raise LandmarkError("E303", f"{message}; gmds.landmarks.files.paired gives those that both have")
    return (ours, theirs), (ours.distinct_names, theirs.distinct_names)


def _halves(landmarks: Any) -> tuple[Any, Any]:
    """The source half and the target half."""
    if isinstance(landmarks, (tuple, list)) and len(landmarks) == 2:
        halves: list[Any] = [x if isinstance(x, SurfacePoints | Landmarks) else _array(x) for x in landmarks]
        plain = all(isinstance(x, (tuple, list)) for x in landmarks)
        if not (plain and all(np.shape(x) == (2,) for x in halves)):
            return halves[0], halves[1]
    pairs = _array(landmarks)
    if pairs.ndim != 2 or pairs.shape[1] != 2:
        raise LandmarkError(
            "E300", f"landmarks must be index pairs (k, 2) or a pair (on source, on target), not shape {pairs.shape}"
        )
    return pairs[:, 0], pairs[:, 1]


def _array(values: Any) -> NDArray[Any]:
    if isinstance(values, Landmarks):
        if not values.defined.all():
            raise LandmarkError("E300", f"landmarks without a place: {', '.join(values.missing[:5])}; leave them out")
        values = values.at
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise LandmarkError("E300", f"landmarks do not form a rectangular array ({error})") from error
    if array.dtype.kind not in "iuf" or np.ma.is_masked(values):
        raise LandmarkError("E300", f"landmarks must be vertex indices or positions, not {array.dtype}")
    return array


def _place(given: Any, mesh: Mesh, name: str, notes: list[Note], called: Sequence[str] = ()) -> SurfacePoints:
    """One half of the landmarks on its mesh."""
    framed = isinstance(given, Landmarks) and given.framed
    given = given if isinstance(given, SurfacePoints) else _array(given)
    if isinstance(given, SurfacePoints):
        if given.mesh is not mesh:
            raise LandmarkError("E300", f"the landmarks of the {name} are points of another mesh")
        points = given
    elif given.ndim == 2 and given.shape[1] == 3:
        points = snapped(given, mesh, name, notes, called, framed=framed)
    elif given.ndim == 2 and given.shape[1] == 4:
        points = _on_faces(given, mesh, name)
    elif given.ndim == 1:
        return _at_vertices(given, mesh, name, called)
    else:
        raise LandmarkError(
            "E300", f"landmarks of the {name} must have shape (k,), (k, 3) or (k, 4), not {given.shape}"
        )
    _refuse_repeats(points.positions, name, called)
    return points


def _on_faces(given: NDArray[Any], mesh: Mesh, name: str) -> SurfacePoints:
    face = given[:, 0]
    if (~np.isfinite(face) | (face != np.floor(face)) | (face < 0) | (face >= mesh.n_faces)).any():
        raise LandmarkError(
            "E301", f"the {name} has faces 0 to {mesh.n_faces - 1}; a landmark says {face.tolist()!r:.60}"
        )
    try:
        return SurfacePoints(mesh, face.astype(np.int64), given[:, 1:])
    except MeshError as error:
        raise LandmarkError("E300", f"barycentric weights of the {name} landmarks: {error}") from error


def _tolerances(given: ArrayLike, count: int) -> Floats:
    try:
        tolerance = np.broadcast_to(np.asarray(given, dtype=np.float64), (count,)).copy()
    except (TypeError, ValueError) as error:
        raise LandmarkError("E300", f"the tolerance must be a number or {count} of them ({error})") from error
    if not (np.isfinite(tolerance) & (tolerance >= 0)).all():
        raise LandmarkError("E300", "a tolerance must be 0 or a positive number, in square roots of the area")
    return np.minimum(tolerance, LARGEST_TOLERANCE)


def _at_vertices(given: NDArray[Any], mesh: Mesh, name: str, called: Sequence[str]) -> SurfacePoints:
    if given.dtype.kind == "f" and (~np.isfinite(given) | (given != np.floor(given))).any():
        raise LandmarkError("E300", f"vertex indices of the {name} must be whole numbers")
    bad = np.flatnonzero((given < 0) | (given >= mesh.n_vertices))
    if len(bad):
        raise LandmarkError(
            "E301",
            f"{called_by(called, bad[0])}: the {name} has no vertex {given[bad[0]]}; it has {mesh.n_vertices}, from 0",
        )
    _refuse_repeats(given[:, None], name, called)
    lonely = np.flatnonzero(~np.isin(given, mesh.faces))
    if len(lonely):
        raise LandmarkError(
            "E304", f"{called_by(called, lonely[0])}: vertex {given[lonely[0]]} of the {name} is on no face"
        )
    return SurfacePoints.at_vertices(mesh, given)


def _refuse_repeats(rows: NDArray[Any], name: str, called: Sequence[str]) -> None:
    _, first, inverse = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    repeated = np.flatnonzero(first[inverse.reshape(-1)] != np.arange(len(rows)))
    if len(repeated):
        earlier = first[inverse.reshape(-1)][repeated[0]]
        both = f"{called_by(called, earlier)} and {called_by(called, repeated[0])}"
        raise LandmarkError("E302", f"{both} are the same point of the {name}")

"""Landmarks of one surface on another, by a map between the two."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geodesics import SurfacePoints
from geodesics.arrays import Bools, Floats
from gmds.errors import LandmarkError
from gmds.evaluation import geodesic_error
from gmds.landmarks.checking import place_on
from gmds.landmarks.files import Landmarks, paired
from gmds.maps.images import confidence_between, image
from gmds.maps.point_map import PointMap


@dataclass(frozen=True, eq=False)
class CarriedLandmarks:
    """Landmarks of the source of a map on its target, k each.

    Attributes
    ----------
    given : Landmarks
        The k landmarks of the source.
    on_source, on_target : SurfacePoints
        The k points; those of a landmark that has no place in `given` mean nothing.
    moved : float64 array of shape (k,)
        How far the given positions were from the surface of the source, in its units; 0 for vertices.
    valid : bool array of shape (k,)
        False where the landmark has no place on the source, or that place no counterpart on the target; such a point
        means nothing.
    distortion, confidence : float64 array of shape (k,)
        Those of the map there; the confidence is 0 where not `valid`, NaN where nobody rated the map.

    See Also
    --------
    carry_landmarks : Makes them.
    """

    given: Landmarks
    on_source: SurfacePoints
    on_target: SurfacePoints
    moved: Floats
    valid: Bools
    distortion: Floats
    confidence: Floats

    @property
    def names(self) -> tuple[str, ...]:
        """The names, (k,)."""
        return self.given.names

    def landmarks(self, *, vertices: bool = False) -> Landmarks:
        """The landmarks on the target, in the same order: missing where not `valid`, undefined as on the source.

        Parameters
        ----------
        vertices : bool
            Whether as the nearest corner of their face, rather than as positions.

        Returns
        -------
        Landmarks
            Ready for `write_landmarks`.
        """
        at = self.on_target.nearest_vertices() if vertices else self.on_target.positions.copy()
        at[~self.valid] = -1 if vertices else np.nan
        lost = self.given.defined & ~self.valid
        status = np.where(lost, "missing", np.array(self.given.status)).tolist()
        given = self.given
        return Landmarks(self.names, at, given.named, tuple(status), given.selected, given.lists)


def carry_landmarks(answer: PointMap, landmarks: Landmarks) -> CarriedLandmarks:
    """The landmarks of the source of a map on its target: put on the source, then sent along.

    Parameters
    ----------
    answer : Correspondence
        The map.
    landmarks : Landmarks
        k vertices, positions, or points of faces of its source; some may have no place.

    Returns
    -------
    CarriedLandmarks
        With how far each can be trusted.

    Raises
    ------
    LandmarkError
        For vertices that do not exist (E301), points given twice (E302), vertices on no face (E304), or positions more
        than 5 % of the diagonal off the surface (E305).

    See Also
    --------
    gmds.landmarks.files.read_landmarks, gmds.landmarks.files.write_landmarks : From and to files.
    """
    there = np.flatnonzero(landmarks.defined)
    if not len(there):
        raise LandmarkError("E300", "none of the landmarks has a place")
    named = [landmarks.distinct_names[i] for i in there] if landmarks.named else ()
    placed = place_on(landmarks[there], answer.source, "source", named)
    row = np.zeros(len(landmarks), dtype=np.int64)  # those without a place stand at the first one that has one
    row[there] = np.arange(len(there))
    on_source, moved = placed[row], np.zeros(len(landmarks))
    if landmarks.at.shape[1:] == (3,):
        moved[there] = np.linalg.norm(placed.positions - landmarks.at[there], axis=1)
    on_target, valid, distortion = image(answer, on_source)
    valid = valid & landmarks.defined
    confidence = np.where(valid, confidence_between(on_source, answer.confidence), 0.0)
    return CarriedLandmarks(landmarks, on_source, on_target, moved, valid, distortion, confidence)


def landmark_errors(carried: CarriedLandmarks, known: Landmarks) -> Floats:
    """How far carried landmarks are from where they are known to be, as `gmds.geodesic_error` has it.

    Parameters
    ----------
    carried : CarriedLandmarks
        k landmarks on the target of a map.
    known : Landmarks
        Those of the target, all or some, placed by hand say; they pair up by name where both have names, else by order.

    Returns
    -------
    float64 array of shape (k,)
        Errors, over the root of the target's area; NaN where the place is not known, or the map has none.

    Raises
    ------
    LandmarkError
        When none pairs up (E303), or for places that are not on the target (E301, E302, E304, E305).

    See Also
    --------
    carry_landmarks : Carries them.
    """
    rows = np.where(carried.valid, np.arange(len(carried.given)), -1)
    ours, theirs, _ = paired(Landmarks(carried.names, rows, carried.given.named), known)
    mesh = carried.on_target.mesh
    names = [theirs.distinct_names[i] for i in range(len(theirs))] if theirs.named else ()
    errors = np.full(len(carried.given), np.nan)
    errors[ours.at] = geodesic_error(carried.on_target[ours.at], place_on(theirs, mesh, "target", names))
    return errors

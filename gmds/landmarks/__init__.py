"""Known points: given by users, in files, placed on both surfaces, carried along a map."""

from __future__ import annotations

from geodesics.moved_paths import names_moved
from gmds.landmarks.checking import check_landmarks
from gmds.landmarks.soft import SoftLandmarks
from gmds.moved_paths import MOVED

__all__ = ["SoftLandmarks", "check_landmarks"]


__getattr__ = names_moved(__name__, MOVED[__name__])

"""Landmarks that may be off: what a user says of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from numpy.typing import ArrayLike

TOLERANCE = 0.05  # in root areas of the target: a convention


@dataclass(frozen=True, eq=False)
class SoftLandmarks:
    """Landmarks that pull rather than pin. One that is missed by many times its tolerance pulls ever less.

    Parameters
    ----------
    landmarks : array_like or pair
        In any form that `check_landmarks` takes, k of them.
    tolerance : float or array_like of shape (k,)
        To within how far each is right, in square roots of the area of the target; 0 makes it a hard one.

    See Also
    --------
    check_landmarks : The forms.
    match : Takes them.

    Examples
    --------
    >>> import gmds
    >>> gmds.SoftLandmarks([[0, 3], [7, 9]], 0.02)  # vertex 0 is about vertex 3, vertex 7 about vertex 9
    SoftLandmarks(landmarks=[[0, 3], [7, 9]], tolerance=0.02)
    """

    landmarks: Any
    tolerance: ArrayLike = TOLERANCE

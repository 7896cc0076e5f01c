"""The candidates of a map as arrays of a file: weights as whole numbers, as they are for looking and for comparing."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geodesics import Mesh, SurfacePoints
from gmds.maps.point_map import Candidate

STEPS = 65535  # of a weight from 0 to 1, as many as a uint16 has: a step is 1.5e-5 of an edge, by its width
DTYPES = {
    "candidate_face": "<i4",  # (c, n)
    "candidate_weights": "<u2",  # (c, n, 2): of the second and third corner, in `STEPS`; the first has the rest
    "candidate_stress": "<f8",  # (c,)
    "candidate_orientation": "<f8",  # (c,)
}
COUNTED = "candidate_stress"  # the member that says how many there are


def shapes(count: int, n: int) -> dict[str, tuple[int, ...]]:
    """Of the members, for so many candidates of a map with n rows."""
    return {
        "candidate_face": (count, n),
        "candidate_weights": (count, n, 2),
        "candidate_stress": (count,),
        "candidate_orientation": (count,),
    }


def candidate_members(candidates: Sequence[Candidate]) -> dict[str, NDArray[Any]]:
    """The arrays of candidates, best first, by the names of `DTYPES`; none without candidates."""
    if not candidates:
        return {}
    second, third = np.rint(STEPS * np.stack([one.points.barycentric[:, 1:] for one in candidates])).transpose(2, 0, 1)
    return {
        "candidate_face": np.stack([one.points.face for one in candidates]),
        "candidate_weights": np.stack([second, np.minimum(third, STEPS - second)], axis=2),
        "candidate_stress": np.array([one.stress for one in candidates]),
        "candidate_orientation": np.array([one.orientation for one in candidates]),
    }


def candidates_of(target: Mesh, arrays: Mapping[str, NDArray[Any]]) -> tuple[Candidate, ...]:
    """What `candidate_members` were made of. Raises `ValueError` where they are no points of the target."""
    if COUNTED not in arrays:
        return ()
    steps = arrays["candidate_weights"].astype(np.int64)
    weights = np.concatenate([STEPS - steps.sum(axis=2, keepdims=True), steps], axis=2) / STEPS
    rows = zip(*(arrays[name].tolist() for name in (COUNTED, "candidate_orientation")), strict=True)
    return tuple(
        Candidate(SurfacePoints(target, face, weight), stress, orientation)
        for face, weight, (stress, orientation) in zip(arrays["candidate_face"], weights, rows, strict=True)
    )

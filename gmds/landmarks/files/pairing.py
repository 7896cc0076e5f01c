"""Which landmarks of two surfaces belong together."""

from __future__ import annotations

from collections import Counter

import numpy as np

from gmds.errors import LandmarkError
from gmds.landmarks.files.named_points import Landmarks, occurrences


def paired(source: Landmarks, target: Landmarks) -> tuple[Landmarks, Landmarks, tuple[str, ...]]:
    """The landmarks that have a place on both surfaces, in one order: by name when both name theirs, else by order.

    Parameters
    ----------
    source, target : Landmarks
        Of either surface. Equal names pair up in their order when both surfaces have equally many of them.

    Returns
    -------
    source, target : Landmarks
        Those that both have, in one order.
    alone : tuple of str
        The names of those that only one has.

    Raises
    ------
    LandmarkError
        When no name is shared, when one is there more often on one surface, or when the order decides and the counts
        differ (E303).

    See Also
    --------
    check_landmarks : Takes what both give.
    """
    if not (source.named and target.named):
        if len(source) != len(target):
            raise LandmarkError(
                "E303",
                f"{len(source)} landmarks on the source but {len(target)} on the target, and no names to pair them by",
            )
        both = source.defined & target.defined
        if not both.any():
            raise LandmarkError("E303", "no landmark has a place on both the source and the target")
        names = zip(source.distinct_names, source.defined | target.defined, both, strict=True)
        return source[both], target[both], tuple(name for name, one, two in names if one and not two)
    ours, theirs = source[source.defined], target[target.defined]
    _refuse_unequal_counts(source.names, target.names)
    key, other = _places(source), _places(target)
    shared = [pair for pair in key if pair in other]
    if not shared:
        raise LandmarkError(
            "E303",
            f"the landmarks share no name: {_some(ours.names)} on the source, {_some(theirs.names)} on the target",
        )
    alone = tuple(name for name, _ in [*(p for p in key if p not in other), *(p for p in other if p not in key)])
    return ours[np.array([key[p] for p in shared])], theirs[np.array([other[p] for p in shared])], alone


def _places(landmarks: Landmarks) -> dict[tuple[str, int], int]:
    """For each landmark with a place, its name and occurrence in the whole list, the row among those with a place."""
    row = np.cumsum(landmarks.defined) - 1
    return {pair: int(row[i]) for i, pair in enumerate(occurrences(landmarks.names)) if landmarks.defined[i]}


def _refuse_unequal_counts(ours: tuple[str, ...], theirs: tuple[str, ...]) -> None:
    here, there = Counter(ours), Counter(theirs)
    for name in here.keys() & there.keys():
        if here[name] != there[name]:
            raise LandmarkError(
                "E303",
                f"{here[name]} landmarks of the source are called {name!r} and {there[name]} of the target; which "
                "belong together cannot be told: give them names of their own",
            )


def _some(names: tuple[str, ...]) -> str:
    return ", ".join(repr(name) for name in names[:3]) + (", ..." if len(names) > 3 else "")

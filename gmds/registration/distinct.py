"""Of many maps the likely ones that are apart from each other."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol, TypeVar

import numpy as np

from geodesics.arrays import Floats
from gmds.registration.register import Registered


class RegisteredMap(Protocol):
    """A map that a deformed source stands for, and how likely it is."""

    @property
    def registered(self) -> Registered: ...
    @property
    def neg_log_likelihood(self) -> float: ...


M = TypeVar("M", bound=RegisteredMap)


def distinct(
    maps: Sequence[M], areas: Floats, apart: float, *, count: int | None = None, within: float = np.inf
) -> list[M]:
    """The likeliest first, without those that lie within `apart` of a likelier one; `count` of them, at the most.

    Those whose log-likelihood falls short of the best by more than `within` are left out as well. `areas` (n,) of the
    vertices of the source sum to 1.
    """
    kept: list[M] = []
    for one in sorted(maps, key=lambda one: one.neg_log_likelihood):
        likely = not kept or one.neg_log_likelihood < kept[0].neg_log_likelihood + within
        room = count is None or len(kept) < count
        if likely and room and all(gap(one.registered, other.registered, areas) > apart for other in kept):
            kept.append(one)
    return kept


def gap(one: Registered, other: Registered, areas: Floats) -> float:
    """Root mean square distance between where two deformations bring the vertices of one source."""
    return float(np.sqrt(areas @ ((one.y - other.y) ** 2).sum(axis=1)))

"""What a model of shape is made from, and what it makes of one more shape."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from geodesics import Mesh
from geodesics.arrays import Bools, Floats, Integers


class Registered(Protocol):
    """What a model is made of: an atlas, or anything with its attributes."""

    @property
    def configurations(self) -> Floats: ...
    @property
    def faces(self) -> Integers: ...
    @property
    def valid(self) -> Bools: ...
    @property
    def names(self) -> Sequence[str]: ...


@dataclass(frozen=True, eq=False)
class FittedShape:
    """A shape as a model sees it: `scores` (c,), the `mesh` that they stand for, in its place, and what is left.

    `residual` (n,): the distance of each point of the model from the surface it was fitted to, in its units, NaN where
    that has no counterpart.
    """

    scores: Floats
    mesh: Mesh
    residual: Floats

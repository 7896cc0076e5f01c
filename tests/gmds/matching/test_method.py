"""A distance or a loss that is none is refused before anything is computed."""

from __future__ import annotations

from typing import Any

import pytest

import gmds
from geodesics.errors import BadArgument
from gmds.matching.method import loss_of
from gmds.mds.losses import ALL, Huber, LeastSquares
from gmds.shapes import quadruped

ANIMAL = quadruped(n_vertices=200)


@pytest.mark.parametrize(
    "wrong", [{"loss": "huber"}, {"loss": Huber}, {"loss": 2}, {"distance": "geodesic"}, {"distance": 1.0}]
)
def test_names_and_classes_are_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(BadArgument, match=f"E604: {next(iter(wrong))} must be"):
        gmds.match(ANIMAL, ANIMAL, **wrong)


def test_those_there_are_stay_as_they_are() -> None:
    assert isinstance(loss_of(None, None), LeastSquares)
    for made in (one() for one in ALL):
        assert loss_of(len, made) is made

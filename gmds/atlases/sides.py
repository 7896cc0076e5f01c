"""Specimens of the other side, and how far a mean shape moved: shapes laid on each other by their points."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geodesics import Mesh
from geodesics.arrays import Bools, Floats, Integers
from geodesics.errors import BadArgument
from gmds.atlases.registered import MIRROR
from gmds.morphometrics.procrustes import fitted

# By how much a mirror image must lie nearer to the template, as residuals of superposition, to be taken for one. Set by
# hand: of the built-in animals a mirrored one is nearer by 2 and more, others are farther.
NEARER = 0.9


def mirror_image(mesh: Mesh) -> Mesh:
    """The mesh with x the other way round, its faces still facing outward."""
    return Mesh(mesh.vertices * MIRROR, mesh.faces[:, [0, 2, 1]])


def is_mirror(template: Floats, places: Floats, valid: Bools) -> bool:
    """Whether points lie nearer to those of the template once they are mirrored."""
    plain, turned = (_misfit(one, template, valid) for one in (places, places * MIRROR))
    return bool(turned < NEARER * plain)


def _misfit(points: Floats, onto: Floats, used: Bools) -> float:
    return float(np.linalg.norm((fitted(points, onto, used)(points) - onto)[used]))


def moved(before: Floats, after: Floats) -> float:
    """How far a mean shape moved, over its centroid size."""
    move = fitted(after, before, np.ones(len(before), dtype=bool))
    return float(np.linalg.norm(move(after) - before) / np.linalg.norm(before - before.mean(axis=0)))


def side_pairs(individuals: NDArray[np.str_], sides: NDArray[np.str_]) -> tuple[list[str], Integers, Integers]:
    """Individuals of which there is one specimen of each of two sides, and the numbers of both.

    Raises `BadArgument` (E604) when there are other than two sides, or no pair.
    """
    kinds = sorted(set(sides.tolist()))
    if len(kinds) != 2:
        raise BadArgument(f"there must be two sides, not {', '.join(kinds)}")
    names, one, other = [], [], []
    for name in sorted(set(individuals.tolist())):
        rows = [np.flatnonzero((individuals == name) & (sides == kind)) for kind in kinds]
        if all(len(row) == 1 for row in rows):
            names.append(name)
            one.append(int(rows[0][0]))
            other.append(int(rows[1][0]))
    if not names:
        raise BadArgument("there is no individual with one specimen of each side")
    return names, np.array(one), np.array(other)

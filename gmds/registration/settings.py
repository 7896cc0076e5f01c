"""How a registration goes: in which stages, against which energy, and what takes part in it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

from gmds.registration.energies import AsRigidAsPossible, AsSimilarAsPossible, EnergyKind, NearlyAffine
from gmds.surface.view import View


class Stage(NamedTuple):
    """Some steps at one stiffness.

    Parameters
    ----------
    stiffness_weight : float
        An area: the square of the distance over which misfits are averaged.
    steps : int
        How often closest points are sought anew.
    """

    stiffness_weight: float
    steps: int


Stages = tuple[Stage, ...]

# Set by hand, from the size of limbs to that of a few faces, but for what is said: development pairs were only run with
# and without whole stages (benchmarks/results/notes.md).
TO_IMAGES: Stages = (Stage(3e-2, 6),)  # towards the images given, before the target is looked at
COARSE: Stages = (Stage(1e-2, 4), Stage(3e-3, 4))
FINE: Stages = (Stage(1e-3, 4), Stage(5e-4, 4))
REFINEMENT: Stages = (Stage(3e-3, 4), *FINE)  # of a map that is good already ("Speed of a match")
SPECTRAL: Stages = (Stage(1e-3, 5), Stage(5e-4, 4))  # with eigenfunctions, from where the source lies
WAY_BACK: Stages = (Stage(3e-3, 4), Stage(3e-3, 3), Stage(1e-3, 3))
AFTER_RETURN: Stages = (Stage(1e-3, 3), Stage(1e-3, 3), Stage(5e-4, 3))

# From the whole to a few faces, of surfaces that lie on each other nearly as they are: teeth still gained from the last
# stage but one, nothing did from more (benchmarks/results/notes.md, "Shapes without limbs").
IN_SPACE: Stages = tuple(Stage(area, 4) for area in (0.3, 0.1, 3e-2, 1e-2, 3e-3, 1e-3, 5e-4))
# Of all vertices, from where a copy with few was laid so: all stages from the similarity end within 0.01 of it, for
# three times the time (the same section).
IN_SPACE_AGAIN: Stages = tuple(Stage(area, 3) for area in (3e-3, 1e-3, 5e-4))


@dataclass(frozen=True, eq=False)
class RegistrationSettings:
    """How a source is deformed onto a target.

    Parameters
    ----------
    stages : tuple of Stage
        In the first the source follows the images given, in the others the closest points.
    energy : callable
        A function CotangentLaplacian -> Energy, such as `ThinShell`: what holds against that.
    partial : bool
        Whether what is closest to a boundary is left alone, as what it belongs to may be missing.
    views : pair of View, optional
        Of both undeformed surfaces: their eigenfunctions take part in the search for closest points.
    reciprocal : float, optional
        Root areas between a point of the target and the image of the source vertex closest to it, beyond which it does
        not pull: the source may have nothing there.
    restarts : bool
        Whether closest points are looked for everywhere as each stage begins, or only as the first does and near the
        last ones then.
    """

    stages: Stages = (*TO_IMAGES, *COARSE, *FINE)
    energy: EnergyKind = AsSimilarAsPossible
    partial: bool = False
    views: tuple[View, View] | None = None
    reciprocal: float | None = None
    restarts: bool = True

    def with_stages(self, stages: Stages) -> RegistrationSettings:
        """The same in other stages."""
        return replace(self, stages=stages)

    @property
    def reversed(self) -> RegistrationSettings:
        """The same with source and target exchanged."""
        return self if self.views is None else replace(self, views=(self.views[1], self.views[0]))


SIMPLIFIED = RegistrationSettings((*TO_IMAGES, *COARSE), AsRigidAsPossible)
"""Of simplified meshes: parts keep their sizes, or a wrong map could be explained by growth."""
FULL = RegistrationSettings((COARSE[0], *COARSE, *FINE), AsSimilarAsPossible, partial=True)
"""Of surfaces with all their faces: parts may change size, and parts may be missing."""
AFFINE = RegistrationSettings(IN_SPACE, NearlyAffine, partial=True)
"""Of surfaces with all their faces that are nearly affine images of each other, from where the source lies."""
AFFINE_AGAIN = AFFINE.with_stages(IN_SPACE_AGAIN)
"""The same once more, where it lies right but for details."""
ISOMETRIC = replace(FULL, restarts=False)
"""Of surfaces of which no part changes size: of 1.7 on FAUST nothing is lost, a fifth of the time is saved."""

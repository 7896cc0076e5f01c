"""One deformation energy a file: `local_step(y)`, `right_hand_side(local)`, `value(y, local)` and `system`."""

from gmds.registration.energies.as_rigid_as_possible import AsRigidAsPossible
from gmds.registration.energies.as_similar_as_possible import AsSimilarAsPossible
from gmds.registration.energies.base import Energy, EnergyKind, LocalGlobalEnergy
from gmds.registration.energies.nearly_affine import NearlyAffine
from gmds.registration.energies.thin_shell import ThinShell

ALL = (AsRigidAsPossible, AsSimilarAsPossible, NearlyAffine, ThinShell)
"""Every energy, each to be made of a `CotangentLaplacian` alone; the tests of energies run on all of them."""

__all__ = [
    "ALL",
    "AsRigidAsPossible",
    "AsSimilarAsPossible",
    "Energy",
    "EnergyKind",
    "LocalGlobalEnergy",
    "NearlyAffine",
    "ThinShell",
]

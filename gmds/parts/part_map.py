"""A simplified part deformed onto a simplified whole, and how likely it is to lie there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gmds.registration.deformable import DeformableMesh
from gmds.registration.energies import AsRigidAsPossible
from gmds.registration.register import Registered
from gmds.registration.settings import COARSE, TO_IMAGES, RegistrationSettings, Stage

RECIPROCAL = 0.08  # root areas between a point of the whole and the image of what it is closest to, beyond which the
# part has nothing there; chosen on the development half of the PFAUST pairs (benchmarks/results/notes.md, "Parts")

ONTO_WHOLE = RegistrationSettings((*TO_IMAGES, *COARSE), AsRigidAsPossible, partial=True, reciprocal=RECIPROCAL)
"""Of a simplified part onto a simplified whole: what either lacks does not pull."""
IN_PLACE = ONTO_WHOLE.with_stages((Stage(1e-2, 6), Stage(3e-3, 6)))
"""From where it nearly fits."""
# Closest points converge the slower the farther a surface has to slide along another (Rusinkiewicz and Levoy 2001), and
# a part that has not slid far enough stays too small, by a tenth. 200 steps at 0.1, and 100 at each, were worse on
# development scans, 600 no better (benchmarks/results/notes.md, "Parts").
CONVERGED = ONTO_WHOLE.with_stages((Stage(3e-2, 200), *COARSE))
"""From where it is right but for how far it has slid."""


@dataclass(frozen=True, eq=False)
class PartMap:
    """A simplified part `registered` on a simplified whole, `size` times as large as it is with unit area."""

    registered: Registered
    size: float

    @property
    def neg_log_likelihood(self) -> float:
        """Minus the log-likelihood up to a constant: of the energy for a part of unit area, and of the curvature.

        The way back says nothing where most of the whole has no counterpart, so it has no say.
        """
        residuals = self.registered.residuals
        unexplained = np.sqrt(1 - np.clip(residuals.curvature, 0.0, 0.999) ** 2)
        return float(np.log(max(np.sqrt(residuals.energy) / self.size, 1e-6)) + np.log(unexplained))

    @classmethod
    def of(cls, source: DeformableMesh, registered: Registered) -> PartMap:
        """As large as it is registered, in the mean."""
        local = source.energy(ONTO_WHOLE.energy).local_step(registered.y)
        size = float(np.sqrt(np.einsum("nab,nab->n", local, local) @ source.areas / 3))
        return cls(registered, max(size, 1e-6))

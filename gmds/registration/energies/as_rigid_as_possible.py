"""As rigid as possible, but for one size of the whole."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats
from gmds.registration.energies.base import LocalGlobalEnergy


class AsRigidAsPossible(LocalGlobalEnergy):
    """Sizes s_i are all alike: as rigid as possible (Sorkine and Alexa 2007), up to the size of the whole."""

    def sizes(self, sums: Floats) -> Floats:
        """The one size of least energy."""
        return np.full(len(sums), sums.sum() / self.rest_spread.sum())

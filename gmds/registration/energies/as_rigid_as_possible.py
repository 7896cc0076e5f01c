"""As rigid as possible, but for one size of the whole."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats
from gmds.registration.energies.base import LocalGlobalEnergy


class AsRigidAsPossible(LocalGlobalEnergy):
    """Sizes :math:`s_i` are all alike: as rigid as possible, up to the size of the whole.

    References
    ----------
    Sorkine, Alexa: As-rigid-as-possible surface modeling (2007).

    See Also
    --------
    AsSimilarAsPossible : Parts may change size.
    NearlyAffine : Nothing may turn by itself.
    ThinShell : Nothing may, and bending costs as well.
    """

    def sizes(self, sums: Floats) -> Floats:
        """The one size of least energy."""
        return np.full(len(sums), sums.sum() / self.rest_spread.sum())

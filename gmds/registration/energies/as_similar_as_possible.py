"""As similar as possible: parts may change size, slowly from place to place."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats
from gmds.registration.energies.base import LocalGlobalEnergy
from gmds.registration.stiffness import FAINT

# Heat time, in units of the area, over which the local size is averaged, and the logarithm of a size below which the
# change is rather noise: chosen on development pairs (benchmarks/results/notes.md, "Deforming the source").
SIZE_TIME = 1e-3
DOUBT = 0.05
LARGEST = 10.0  # local size, and one over the least: a bound


class AsSimilarAsPossible(LocalGlobalEnergy):
    r"""Sizes :math:`s_i` vary slowly over the surface.

    They are ratios of averages over a neighbourhood, shrunk to 1 the less they differ from it: a surface is the same
    size until there is reason to believe otherwise.

    .. math:: \log s_i = \frac{l_i^3}{l_i^2 + d^2}

    with :math:`l_i` the logarithm of the averaged ratio and the doubt :math:`d` = 0.05.

    See Also
    --------
    AsRigidAsPossible : One size.
    """

    def sizes(self, sums: Floats) -> Floats:
        """exp(l^3 / (l^2 + d^2)), l the logarithm of the averaged size and d the doubt."""
        smooth = self.laplacian.heat_step(SIZE_TIME)
        size = smooth(sums) / np.maximum(smooth(self.rest_spread), FAINT)
        log = np.log(np.clip(size, 1 / LARGEST, LARGEST))
        return np.asarray(np.exp(log**3 / (log**2 + DOUBT**2)), dtype=np.float64)

"""The metric the surface inherits from space."""

from __future__ import annotations

import numpy as np

from geodesics.mesh import Mesh
from geodesics.metric import Metric, conformal


def embedded(mesh: Mesh) -> Metric:
    r"""The embedded metric :math:`g_{ij} = \langle S_i, S_j \rangle` (sec. 2), inherited from space.

    Parameters
    ----------
    mesh : Mesh
        The surface.

    Returns
    -------
    Metric
        Its lengths are in the unit of the mesh.

    See Also
    --------
    scale_invariant : Divided by the local scale.
    """
    return conformal(mesh, np.ones(mesh.n_vertices))

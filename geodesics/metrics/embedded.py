"""The metric the surface inherits from space."""

from __future__ import annotations

import numpy as np

from geodesics.mesh import Mesh, of_a_mesh
from geodesics.metric import Metric, conformal


@of_a_mesh
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

    Examples
    --------
    >>> import geodesics
    >>> triangle = geodesics.Mesh([[0, 0, 0], [3, 0, 0], [0, 4, 0]], [[0, 1, 2]])
    >>> geodesics.embedded(triangle).l_sq.tolist()  # the squared length of the edge opposite each corner
    [[25.0, 16.0, 9.0]]
    """
    return conformal(mesh, np.ones(mesh.n_vertices))

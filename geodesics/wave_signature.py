"""Signatures of points from the wave equation, computed from eigenpairs."""

from __future__ import annotations

import numpy as np

from geodesics.arguments import real_numbers, whole_number
from geodesics.arrays import Floats
from geodesics.errors import BadArgument
from geodesics.mesh import Mesh
from geodesics.metric import Metric
from geodesics.spectrum import Spectrum, as_spectrum

# Range of the logarithms of eigenvalues: in a smaller one they are copies of one eigenvalue, as those of symmetric
# surfaces are but for discretisation. Set by hand, far above the errors of eigenvalues (1e-8).
NARROWEST = 1e-3
LEAST_WIDTH = 1e-6  # steps between energies: a bound, so that no square of it vanishes


def wave_kernel_signature(spectrum: Spectrum | Metric | Mesh, n_energies: int = 100, width: float = 7.0) -> Floats:
    r"""The wave-kernel signature of every vertex, beside the signatures of sec. 5.

    .. math:: \mathrm{WKS}(s, e) = \frac{\sum_i \phi_i(s)^2 w_i(e)}{\sum_i w_i(e)}, \qquad
              w_i(e) = \exp\Big( - \frac{(e - \log \lambda_i)^2}{2 \sigma^2} \Big)

    Where all eigenvalues are equal, all columns are about the same.
    Energies run evenly from :math:`\log \lambda_1 + 2 \sigma` to :math:`\log \lambda_{\max} - 2 \sigma`.

    Parameters
    ----------
    spectrum : Spectrum, Metric or Mesh
        k eigenpairs of the surface in some metric; of a metric, or a mesh with its embedded metric, the first 100.
    n_energies : int
        Number of energies e.
    width : float
        :math:`\sigma` in steps between energies.

    Returns
    -------
    array of shape (n, n_energies)
        Values in units of 1 / area.

    Raises
    ------
    ValueError
        When there are fewer than two positive eigenvalues, or for another number of energies or width (E604).

    References
    ----------
    Aubry, Schlickewei, Cremers: The wave kernel signature (2011).

    See Also
    --------
    heat_kernel_signature : Low-pass instead of band-pass.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> geodesics.wave_kernel_signature(sphere, n_energies=30).shape
    (162, 30)
    """
    spectrum = as_spectrum(spectrum)
    n_energies = whole_number(n_energies, "n_energies", 1)
    wide = real_numbers(width, "width")
    if wide.ndim or not LEAST_WIDTH <= wide < np.inf:
        raise BadArgument(
            f"width must be a number of steps between energies, at least {LEAST_WIDTH}, not {width!r:.40}"
        )
    positive = spectrum.eigenvalues * spectrum.mass.sum() > 1e-6
    if np.count_nonzero(positive) < 2:
        raise BadArgument("the wave kernel signature needs at least two positive eigenvalues")
    log = np.log(spectrum.eigenvalues[positive])
    sigma = width * max(log[-1] - log[0], NARROWEST) / (n_energies - 1 + 4 * width)
    energies = np.linspace(log[0] + 2 * sigma, log[-1] - 2 * sigma, n_energies)
    exponent = -((energies - log[:, None]) ** 2) / (2 * sigma**2)
    weights = np.exp(exponent - exponent.max(axis=0))
    return spectrum.eigenfunctions[:, positive] ** 2 @ (weights / weights.sum(axis=0))

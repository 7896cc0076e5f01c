"""Spectral scaling: distances from a few points, written in eigenfunctions, scaled for all vertices at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from geodesics import Spectrum
from geodesics.arrays import Floats, Integers
from gmds.canonical_forms._checked import square

# Weight of the samples against smoothness, in units of the first eigenvalue: set by hand. Interpolation follows the
# samples closely; what is left of them is below a thousandth of the mean distance with 100 eigenfunctions.
FIDELITY = 1e4


def squared_distances_in_eigenfunctions(
    spectrum: Spectrum, samples: ArrayLike, distances: ArrayLike, fidelity: float = FIDELITY
) -> Floats:
    r"""The matrix :math:`\alpha` of :math:`D^2(x, y) \approx \sum_{ij} \alpha_{ij} \phi_i(x) \phi_j(y)` (k, k).

    From the distances between samples, interpolated as smoothly as their fidelity allows:

    .. math:: \alpha = M D_s^2 M^T, \qquad M = (\Lambda / \lambda_1 + \mu \, \Phi_s^T \Phi_s)^{-1} \mu \, \Phi_s^T

    Never n x n: k x k numbers hold all distances of the surface.

    Parameters
    ----------
    spectrum : Spectrum
        k eigenpairs of the surface in some metric.
    samples : array_like of int, shape (p,)
        Vertices.
    distances : array_like of shape (p, p)
        Between them.
    fidelity : float
        :math:`\mu`, without unit: with eigenfunctions scaled to the unit mean square and a mean over the samples.

    Returns
    -------
    array of shape (k, k)
        Symmetric, in squared units of the distance, for eigenfunctions as the spectrum has them.

    References
    ----------
    Aflalo, Kimmel: Spectral multidimensional scaling (2013), (2) and (3).
    """
    chosen: Integers = np.asarray(samples, dtype=np.int64)
    area = spectrum.mass.sum()
    rows = spectrum.eigenfunctions[chosen] * np.sqrt(area)
    positive = spectrum.eigenvalues[spectrum.eigenvalues * area > 1e-9]
    roughness = spectrum.eigenvalues / (positive[0] if len(positive) else 1.0)
    normal = np.diag(roughness) + fidelity / len(chosen) * rows.T @ rows
    smooth = np.linalg.solve(normal, fidelity / len(chosen) * rows.T)
    return np.asarray(area * smooth @ square(distances) ** 2 @ smooth.T, dtype=np.float64)


def spectral_scaling(spectrum: Spectrum, squared: Floats, dimension: int) -> Floats:
    r"""Classical scaling of all vertices, from their squared distances in eigenfunctions.

    .. math:: X = \Phi \, V \, \Sigma^{1/2}, \qquad -\tfrac{1}{2} J \alpha J = V \Sigma V^T

    where :math:`J` removes the constant eigenfunctions, which is the centring of the whole surface by its mass.

    Parameters
    ----------
    spectrum : Spectrum
        k eigenpairs of the surface.
    squared : array of shape (k, k)
        :math:`\alpha` of `squared_distances_in_eigenfunctions`.
    dimension : int
        m, at least 1.

    Returns
    -------
    array of shape (n, m)
        Points for all vertices, the coordinates of largest spread first.

    References
    ----------
    Aflalo, Kimmel: Spectral multidimensional scaling (2013).

    See Also
    --------
    canonical_form : Computes the distances as well.
    """
    constant = spectrum.mass @ spectrum.eigenfunctions  # what the constant function is in them
    constant = constant / np.linalg.norm(constant)
    centring = np.eye(len(constant)) - np.outer(constant, constant)
    values, vectors = np.linalg.eigh(-0.5 * centring @ squared @ centring)
    values, vectors = values[::-1][:dimension], vectors[:, ::-1][:, :dimension]
    places = spectrum.eigenfunctions @ (vectors * np.sqrt(np.maximum(values, 0.0)))
    signs = np.sign(places[np.abs(places).argmax(axis=0), np.arange(places.shape[1])])
    return np.asarray(places * np.where(signs == 0, 1, signs), dtype=np.float64)

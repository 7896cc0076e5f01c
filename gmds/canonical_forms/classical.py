"""Classical scaling: the eigenvectors of the doubly centred squared distances."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arrays import Floats
from gmds.canonical_forms._checked import known_weights, square


def classical_scaling(distances: ArrayLike, dimension: int, weights: ArrayLike | None = None) -> Floats:
    r"""Points whose inner products are nearest to those that distances ask for.

    .. math:: \min_X \| X X^T + \tfrac{1}{2} J D^2 J^T \|_F, \qquad J = I - \mathbf{1} w^T

    with weights :math:`w` that sum to 1, and the norm weighted likewise. Exact where the distances are those of points
    in so many dimensions.

    Parameters
    ----------
    distances : array_like of shape (p, p)
        Symmetric and finite.
    dimension : int
        m, at least 1; coordinates beyond those that the distances support are 0.
    weights : array_like of shape (p,), optional
        How much each point counts, positive; equal unless given.

    Returns
    -------
    array of shape (p, m)
        Centred points, the coordinates of largest spread first, each with its largest entry positive.

    Raises
    ------
    ValueError
        For distances that are not square, symmetric and finite, or weights that are not positive.

    References
    ----------
    Torgerson: Multidimensional scaling, I. Theory and method (1952); Gower: Some distance properties of latent root and
    vector methods used in multivariate analysis (1966).

    See Also
    --------
    smacof : The distances themselves, not their squares, in the least-squares sense.
    """
    d, w = square(distances), known_weights(weights, len(np.asarray(distances)))
    squared = d**2
    mean = squared @ w
    gram = -0.5 * (squared - mean - mean[:, None] + w @ mean)
    root = np.sqrt(w)
    values, vectors = np.linalg.eigh(root[:, None] * gram * root)
    places = np.zeros((len(d), dimension))
    for k in range(min(dimension, len(d))):
        axis = vectors[:, -1 - k] / root * np.sqrt(max(values[-1 - k], 0.0))
        places[:, k] = axis * (np.sign(axis[np.abs(axis).argmax()]) or 1.0)
    return places

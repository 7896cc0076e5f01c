"""Eigenpairs of the Laplace-Beltrami operator."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse.linalg as sla
from numpy.typing import NDArray

from geodesics.laplacian import lumped_mass, stiffness
from geodesics.mesh import Mesh
from geodesics.metric import Metric


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Eigenvalues (count,) ascending from 0 and mass-orthonormal eigenfunctions (n, count)."""

    mesh: Mesh
    mass: NDArray[np.float64]
    eigenvalues: NDArray[np.float64]
    eigenfunctions: NDArray[np.float64]


def eigenpairs(metric: Metric, count: int) -> Spectrum:
    """The `count` smallest eigenpairs of W phi = lambda M phi (sec. 4), by shift-invert Lanczos."""
    w, m = stiffness(metric), lumped_mass(metric)
    start = np.random.default_rng(0).standard_normal(metric.mesh.n_vertices)
    total = metric.mass.sum()
    values, functions = sla.eigsh(w.tocsc(), count, m.tocsc(), sigma=-1e-2 / total, v0=start)
    order = np.argsort(values)
    return Spectrum(metric.mesh, metric.mass, np.maximum(values[order], 0), functions[:, order])

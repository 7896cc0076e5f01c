"""Point signatures from the heat and wave equation, all from eigenpairs.

Times are relative, t = time * area with the area of the surface in the metric of the spectrum, so that no signature
depends on the unit of length more than its formula says.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arrays import Floats
from geodesics.memory import table
from geodesics.points import SurfacePoints
from geodesics.spectrum import Spectrum


def heat_kernel(spectrum: Spectrum, time: float, points: SurfacePoints) -> Floats:
    """Heat kernel h_t(s, s') = sum_i exp(-lambda_i t) phi_i(s) phi_i(s') (sec. 3), from points to vertices: (p, n).

    `time` >= 0 in units of the surface area; values in units of 1 / area. Raises `WouldExceedMemory` (E501) when the
    table does not fit.
    """
    fade = np.exp(-spectrum.eigenvalues * (_times(time)[0] * spectrum.mass.sum()))
    result = table(len(points), len(spectrum.mass), "values of the heat kernel", "take fewer points at a time")
    return np.matmul(points.interpolate(spectrum.eigenfunctions) * fade, spectrum.eigenfunctions.T, out=result)


def heat_kernel_signature(spectrum: Spectrum, times: ArrayLike) -> Floats:
    """HKS(s, t) = h_t(s, s) = sum_i exp(-lambda_i t) phi_i(s)^2 (5.1) at every vertex: (n, number of times).

    `times` >= 0 in units of the surface area; values in units of 1 / area.
    """
    return spectrum.eigenfunctions**2 @ _fading(spectrum, times)


def scaled_heat_kernel_signature(spectrum: Spectrum, times: ArrayLike) -> Floats:
    """HKS(s, t) / integral over S of HKS(s, t) da(s), as plotted in Fig. 5 (sec. 5): (n, number of times)."""
    signature = heat_kernel_signature(spectrum, times)
    return signature / (spectrum.mass @ signature)


def scale_invariant_heat_kernel_signature(
    spectrum: Spectrum, times: ArrayLike | None = None, n_frequencies: int = 6
) -> Floats:
    """SI-HKS(s, xi) = |F d/d eta log HKS(s, eta)|, eta = log t (footnote 1): (n, n_frequencies), no unit.

    `times` must grow by a constant factor; by default 64 times over the range that the spectrum resolves. On the whole
    line scaling the surface shifts eta, and the Fourier magnitude forgets the shift (Bronstein, Kokkinos 2010); here
    times are relative to the area already, so it forgets the scale of the part around s. Vertices on no face get 0.
    """
    t = resolved_times(spectrum, 64) if times is None else _times(times)
    if len(t) < 3 or np.any(t <= 0) or not np.allclose(t[1:] / t[:-1], t[1] / t[0], rtol=1e-6):
        raise ValueError("times must be at least three positive numbers that grow by a constant factor")
    used = spectrum.mass > 0
    signature = heat_kernel_signature(spectrum, t)[used]
    # d log HKS / d eta = t HKS' / HKS, in closed form: no differences
    slope = -(spectrum.eigenfunctions[used] ** 2) @ (
        spectrum.eigenvalues[:, None] * spectrum.mass.sum() * t * _fading(spectrum, t)
    )
    result = np.zeros((len(used), n_frequencies))
    result[used] = np.abs(np.fft.fft(slope / signature, axis=1))[:, :n_frequencies] / len(t)
    return result


def wave_kernel_signature(spectrum: Spectrum, n_energies: int = 100, width: float = 7.0) -> Floats:
    """WKS(s, e) = sum_i phi_i(s)^2 w_i(e) / sum_i w_i(e): (n, n_energies); w_i is a Gaussian around log lambda_i.

    Aubry, Schlickewei, Cremers 2011 (beside the signatures of sec. 5). Energies run evenly from log lambda_1 + 2 sigma
    to log lambda_max - 2 sigma, sigma = `width` steps; values in units of 1 / area. Needs two positive eigenvalues.
    """
    positive = spectrum.eigenvalues * spectrum.mass.sum() > 1e-6
    if np.count_nonzero(positive) < 2:
        raise ValueError("the wave kernel signature needs at least two positive eigenvalues")
    log = np.log(spectrum.eigenvalues[positive])
    sigma = width * (log[-1] - log[0]) / (n_energies - 1 + 4 * width)
    energies = np.linspace(log[0] + 2 * sigma, log[-1] - 2 * sigma, n_energies)
    exponent = -((energies - log[:, None]) ** 2) / (2 * max(sigma, np.finfo(float).tiny) ** 2)
    weights = np.exp(exponent - exponent.max(axis=0))
    return spectrum.eigenfunctions[:, positive] ** 2 @ (weights / weights.sum(axis=0))


def resolved_times(spectrum: Spectrum, count: int) -> Floats:
    """Times (count,) in units of the area, log-spaced from 4 log 10 / lambda_max to 4 log 10 / lambda_1.

    The range of Sun, Ovsjanikov, Guibas 2009: at both ends the faded terms are below 1e-4.
    """
    relative = spectrum.eigenvalues * spectrum.mass.sum()
    positive = relative[relative > 1e-6]
    if len(positive) == 0:
        raise ValueError("the spectrum has no positive eigenvalue")
    return np.geomspace(4 * np.log(10) / positive[-1], 4 * np.log(10) / positive[0], count)


def _times(times: ArrayLike) -> Floats:
    t = np.atleast_1d(np.asarray(times, dtype=np.float64))
    if t.ndim != 1 or not np.all(t >= 0) or not np.all(np.isfinite(t)):
        raise ValueError("times must be finite numbers >= 0, in units of the area of the surface")
    return t


def _fading(spectrum: Spectrum, times: ArrayLike) -> Floats:
    """exp(-lambda_i t), shape (number of eigenpairs, number of times)."""
    return np.exp(-np.outer(spectrum.eigenvalues * spectrum.mass.sum(), _times(times)))

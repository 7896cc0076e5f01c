"""Signatures of points from the heat equation, computed from eigenpairs; times are in units of the area."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arguments import real_number, real_numbers, whole_number
from geodesics.arrays import Floats
from geodesics.distance import as_points
from geodesics.errors import BadArgument
from geodesics.memory import table
from geodesics.mesh import Mesh
from geodesics.metric import Metric
from geodesics.moved_paths import names_moved
from geodesics.points import SurfacePoints
from geodesics.spectrum import Spectrum, as_spectrum

TIME = "time (in units of the area of the surface)"
TIMES = 64  # of a signature, where none are given; set by hand


def heat_kernel(spectrum: Spectrum | Metric | Mesh, time: float, points: SurfacePoints | ArrayLike) -> Floats:
    r"""The heat kernel from points to all vertices (sec. 3).

    .. math:: h_t(s, s') = \sum_i e^{-\lambda_i t} \phi_i(s) \phi_i(s')

    Parameters
    ----------
    spectrum : Spectrum, Metric or Mesh
        k eigenpairs of the surface in some metric; of a metric, or a mesh with its embedded metric, the first 100.
    time : float
        :math:`t` in units of the area of the surface, not negative.
    points : SurfacePoints or array_like of int
        The p points s, or vertices.

    Returns
    -------
    array of shape (p, n)
        Values in units of 1 / area.

    Raises
    ------
    ValueError
        When the time is negative or not finite.
    WouldExceedMemory
        E501 when the table does not fit.

    See Also
    --------
    heat_kernel_signature : Its diagonal.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> kernel = geodesics.heat_kernel(sphere, 0.1, [0])
    >>> kernel.shape, int(kernel.argmax())
    ((1, 162), 0)
    """
    spectrum = as_spectrum(spectrum)
    points = as_points(spectrum.mesh, points)
    fade = np.exp(-spectrum.eigenvalues * (real_number(time, TIME, 0.0) * spectrum.mass.sum()))
    result = table(len(points), len(spectrum.mass), "values of the heat kernel", "take fewer points at a time")
    return np.matmul(points.interpolate(spectrum.eigenfunctions) * fade, spectrum.eigenfunctions.T, out=result)


def heat_kernel_signature(spectrum: Spectrum | Metric | Mesh, times: ArrayLike | None = None) -> Floats:
    r"""The heat-kernel signature (5.1) of every vertex.

    .. math:: \mathrm{HKS}(s, t) = h_t(s, s) = \sum_i e^{-\lambda_i t} \phi_i(s)^2

    Parameters
    ----------
    spectrum : Spectrum, Metric or Mesh
        k eigenpairs of the surface in some metric; of a metric, or a mesh with its embedded metric, the first 100.
    times : array_like of shape (q,), optional
        :math:`t` in units of the area of the surface, not negative; by default 64 over the range that the spectrum
        resolves.

    Returns
    -------
    array of shape (n, q)
        Values in units of 1 / area.

    Raises
    ------
    ValueError
        When a time is negative or not finite.

    References
    ----------
    (5.1) of Aflalo, Kimmel, Raviv 2013; Sun, Ovsjanikov, Guibas: A concise and provably informative multi-scale
    signature based on heat diffusion (2009).

    See Also
    --------
    scaled_heat_kernel_signature : Normalised at every time.
    scale_invariant_heat_kernel_signature : Its Fourier magnitudes.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> geodesics.heat_kernel_signature(sphere, [0.01, 0.1]).shape
    (162, 2)
    """
    spectrum = as_spectrum(spectrum)
    t = resolved_times(spectrum, TIMES) if times is None else times
    return spectrum.eigenfunctions**2 @ _fading(spectrum, t)


def scaled_heat_kernel_signature(spectrum: Spectrum | Metric | Mesh, times: ArrayLike | None = None) -> Floats:
    r"""The heat-kernel signature as plotted in Fig. 5 (sec. 5): divided by its integral over the surface.

    .. math:: \mathrm{HKS}(s, t) \Big/ \int_S \mathrm{HKS}(s, t) \, da(s)

    Parameters
    ----------
    spectrum : Spectrum, Metric or Mesh
        k eigenpairs of the surface in some metric; of a metric, or a mesh with its embedded metric, the first 100.
    times : array_like of shape (q,), optional
        :math:`t` in units of the area of the surface, not negative; by default 64 over the range that the spectrum
        resolves.

    Returns
    -------
    array of shape (n, q)
        Values in units of 1 / area.

    See Also
    --------
    heat_kernel_signature : Without the division.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> geodesics.scaled_heat_kernel_signature(geodesics.scale_invariant(sphere)).shape[0]
    162
    """
    spectrum = as_spectrum(spectrum)
    signature = heat_kernel_signature(spectrum, times)
    return signature / (spectrum.mass @ signature)


def scale_invariant_heat_kernel_signature(
    spectrum: Spectrum | Metric | Mesh, times: ArrayLike | None = None, n_frequencies: int = 6
) -> Floats:
    r"""The scale-invariant heat-kernel signature of every vertex (footnote 1).

    .. math:: \Big| \mathcal{F} \, \frac{d}{d \eta} \log \mathrm{HKS}(s, \eta) \Big| (\xi), \qquad \eta = \log t

    On the whole line scaling the surface shifts :math:`\eta`, and the Fourier magnitude does not depend on the shift.
    Here times are relative to the area already, so it is the scale of the part around s that cancels.

    Parameters
    ----------
    spectrum : Spectrum, Metric or Mesh
        k eigenpairs of the surface in some metric; of a metric, or a mesh with its embedded metric, the first 100.
    times : array_like of shape (q,), optional
        Positive times that grow by a constant factor, in units of the area; by default 64 over the range that the
        spectrum resolves.
    n_frequencies : int
        Number of frequencies :math:`\xi`, from 0; as many as there are times at the most.

    Returns
    -------
    array of shape (n, n_frequencies)
        Values without a unit; 0 at vertices on no face.

    Raises
    ------
    ValueError
        When there are fewer than three times, or they do not grow by a constant factor, or for more frequencies than
        times.

    References
    ----------
    Bronstein, Kokkinos: Scale-invariant heat kernel signatures for non-rigid shape recognition (2010).

    See Also
    --------
    heat_kernel_signature : The signature that is transformed.

    Examples
    --------
    >>> import geodesics, trimesh
    >>> sphere = geodesics.Mesh(trimesh.creation.icosphere(2))  # radius 1
    >>> geodesics.scale_invariant_heat_kernel_signature(sphere).shape
    (162, 6)
    """
    spectrum = as_spectrum(spectrum)
    t = resolved_times(spectrum, TIMES) if times is None else _times(times)
    if len(t) < 3 or np.any(t <= 0) or not np.allclose(t[1:] / t[:-1], t[1] / t[0], rtol=1e-6):
        raise BadArgument("times must be at least three positive numbers that grow by a constant factor")
    n_frequencies = whole_number(n_frequencies, "n_frequencies", 0, len(t), "as many as there are times")
    used = spectrum.mass > 0
    signature = heat_kernel_signature(spectrum, t)[used]
    # d log HKS / d eta = t HKS' / HKS, in closed form: no differences
    slope = -(spectrum.eigenfunctions[used] ** 2) @ (
        spectrum.eigenvalues[:, None] * spectrum.mass.sum() * t * _fading(spectrum, t)
    )
    result = np.zeros((len(used), n_frequencies))
    result[used] = np.abs(np.fft.fft(slope / signature, axis=1))[:, :n_frequencies] / len(t)
    return result


def resolved_times(spectrum: Spectrum, count: int) -> Floats:
    """Times (count,) in units of the area, log-spaced from 4 log 10 / lambda_max to 4 log 10 / lambda_1.

    The range of Sun, Ovsjanikov, Guibas 2009: at both ends the faded terms are below 1e-4.
    """
    relative = spectrum.eigenvalues * spectrum.mass.sum()
    positive = relative[relative > 1e-6]
    if len(positive) == 0:
        raise BadArgument("the spectrum has no positive eigenvalue")
    return np.geomspace(4 * np.log(10) / positive[-1], 4 * np.log(10) / positive[0], count)


def _times(times: ArrayLike) -> Floats:
    t = np.atleast_1d(real_numbers(times, "times"))
    if t.ndim != 1 or not np.all(t >= 0) or not np.all(np.isfinite(t)):
        raise BadArgument("times must be finite numbers >= 0, in units of the area of the surface")
    return t


def _fading(spectrum: Spectrum, times: ArrayLike) -> Floats:
    """exp(-lambda_i t), shape (number of eigenpairs, number of times)."""
    return np.exp(-np.outer(spectrum.eigenvalues * spectrum.mass.sum(), _times(times)))


__getattr__ = names_moved(__name__, ("geodesics.wave_signature",))

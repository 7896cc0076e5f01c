"""The metric of the target in which a map keeps area: parts of another size are rescaled before they are compared.

Two surfaces whose parts differ in scale are related by a map that is nearly conformal. In the metric rho g of the
target, with rho the area of the source that the map brings per area of the target, the map is nearly an isometry, and
distances can be compared as if no part had changed size. The scale-invariant metric needs no map to start from, but
measures curvature; this one needs a rough map, and measures areas only. Both are conformal to g, so stiffness is
shared.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg
import scipy.sparse as sp

from geodesics import Spectrum, embedded, stiffness
from geodesics.arrays import Floats
from geodesics.caching import cached_property, memoized
from geodesics.linalg.factors import lu_factors
from gmds.surface.measured import EXPONENTS, Surface
from gmds.surface.view import View

LARGEST_FACTOR = 100.0  # of areas, and one over the least: a bound
FINE = 60  # eigenfunctions of the scale-invariant metric, which resolve parts that are small in space; set by hand


@dataclass(frozen=True, eq=False)
class ConformalClass:
    """Metrics rho g of one surface, measured in the span of eigenfunctions it already has (Rayleigh-Ritz)."""

    surface: Surface

    @cached_property
    def basis(self) -> Floats:
        """Functions (n, q) orthonormal in area: eigenfunctions of space, and what those of (2.1) add to them."""
        regular, weight = self.surface.regular.functions, self.surface.areas[:, None]
        others = self.surface.curved(EXPONENTS[0]).functions[:, 1:FINE]
        others = others - regular @ (regular.T @ (weight * others))
        values, vectors = np.linalg.eigh(others.T @ (weight * others))
        kept = values > 1e-4
        return np.hstack([regular, others @ (vectors[:, kept] / np.sqrt(values[kept]))])

    @cached_property
    def energy(self) -> Floats:
        """Dirichlet energy (q, q) of the basis, the same in every conformal metric."""
        return self.basis.T @ (stiffness(embedded(self.surface.mesh)) @ self.basis)

    def view(self, factor: Floats, count: int) -> View:
        """The surface in the metric factor * g, factor (n,), with `count` eigenfunctions."""
        mass = factor * self.surface.areas
        mass /= mass.sum()
        gram = self.basis.T @ (mass[:, None] * self.basis)
        values, vectors = scipy.linalg.eigh(self.energy, gram, subset_by_index=(0, min(count, len(gram)) - 1))
        values[0] = 0.0  # the constant, up to rounding
        return View(self.surface.mesh, Spectrum(self.surface.mesh, mass, np.maximum(values, 0), self.basis @ vectors))

    @memoized
    def _heat_step(self, time: float) -> Callable[[Floats], Floats]:
        """Solves (time W + A) y = b on the vertices with area: an implicit step of the heat equation."""
        used = self.surface.regular.usable
        mass = sp.diags(self.surface.areas[used])
        weights = stiffness(embedded(self.surface.mesh))[used][:, used]
        return lu_factors((mass + time * weights).tocsc()).solve  # type: ignore[no-any-return]

    def density(self, amounts: Floats, time: float) -> Floats:
        """Amounts (n,) per area (n,), both smoothed by one implicit heat step of `time`, in units of the area."""
        used, solve = self.surface.regular.usable, self._heat_step(time)
        ratio = solve(amounts[used]) / solve(self.surface.areas[used])
        factor = np.ones(len(amounts))
        factor[used] = np.clip(ratio, 1 / LARGEST_FACTOR, LARGEST_FACTOR)
        return factor

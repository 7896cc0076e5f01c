"""What is left of a source deformed onto a target."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

CONGRUENT = 1e-9  # elastic energy below which a map is a congruence up to rounding: a bound, rounding leaves 1e-12
LEAST = 1e-6  # residuals below this are rounding: a bound, so that their logarithm is finite


@dataclass(frozen=True)
class Residuals:
    """What is left of a source deformed onto a target.

    `energy`: elastic energy; `misfit`, `misfit_back`: root mean square distance to the target, and from it to the
    source, in root areas; `curvature`, `curvature_back`: correlation of squashed mean curvature, both ways;
    `landmarks`: minus the log-likelihood of what they are missed by.
    """

    energy: float
    misfit: float
    misfit_back: float
    curvature: float
    curvature_back: float
    landmarks: float = 0.0

    @property
    def neg_log_likelihood(self) -> float:
        """Minus the log-likelihood up to a constant, with the spread of each residual at its best value.

        A Gaussian residual of spread s contributes log s: the root of the elastic energy; the distance from the target
        back, which is large where parts of it are left out; the unexplained part sqrt(1 - r^2) of the curvature, both
        ways, which distinguishes the chest from the back.
        """
        spreads = (np.sqrt(self.energy), *self._of_the_fit)
        return float(sum(np.log(max(spread, LEAST)) for spread in spreads)) + self.landmarks

    @property
    def unexplained(self) -> float:
        """The part of it that misfit and curvature account for, whatever the energy that was deformed against."""
        return float(sum(np.log(max(spread, LEAST)) for spread in self._of_the_fit))

    @property
    def unexplained_curvature(self) -> float:
        """The part of it that curvature accounts for."""
        return float(sum(np.log(max(spread, LEAST)) for spread in self._of_the_fit[1:]))

    @property
    def _of_the_fit(self) -> tuple[float, ...]:
        return (
            self.misfit_back,
            *(np.sqrt(1 - np.clip(r, 0.0, 1.0) ** 2) for r in (self.curvature, self.curvature_back)),
        )

    @property
    def is_congruence(self) -> bool:
        """Whether nothing is deformed but for rounding, and no landmark missed."""
        return self.energy + self.landmarks < CONGRUENT

    @property
    def cost(self) -> float:
        """The elastic energy, times what missed landmarks make of it in the likelihood."""
        return self.energy * float(np.exp(2 * self.landmarks))

r"""What other maps of a pair say against the likeliest: as a whole, and where they lead elsewhere.

A map c of negative log-likelihood :math:`L_c` has the odds :math:`e^{L_0 - L_c}` against the likeliest. Where both
send a point to places that are farther apart than twice the radius of confidence, not both can be right: the
likeliest is with probability

.. math:: u(x) = \Bigl(1 + \sum_{c:\, |P_c(x) - P_0(x)| > 2r} e^{L_0 - L_c}\Bigr)^{-1}

so far as one of them is. Maps that are others as a whole do not count there; they have the `margin`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from geodesics.arrays import Floats
from gmds.maps.confidence import RADIUS

ANOTHER_MAP = 0.1  # mean distance in root areas between the images of two maps that are two answers; set by hand


class Rivals(NamedTuple):
    """What speaks against the likeliest of some maps.

    `margin`: how much likelier it is than any that is another as a whole, a difference of log-likelihood, infinite
    where there is none; `undisputed`: the u (n,) of the formula, 1 where no other map leads elsewhere.
    """

    margin: float
    undisputed: Floats

    @classmethod
    def of(cls, likelihoods: Sequence[float], images: Sequence[Floats]) -> Rivals:
        """Of maps, the first of which is the likeliest.

        `likelihoods` are negative logarithms; `images` are where each map sends the vertices, (n, 3), in root areas.
        """
        margin, odds = np.inf, np.zeros(len(images[0]))
        for value, positions in zip(likelihoods[1:], images[1:], strict=True):
            apart = np.linalg.norm(positions - images[0], axis=1)
            if apart.mean() > ANOTHER_MAP:
                margin = min(margin, value - likelihoods[0])
            else:
                odds += np.where(apart > 2 * RADIUS, np.exp(likelihoods[0] - value), 0.0)
        return cls(float(margin), np.asarray(1 / (1 + odds), dtype=np.float64))

"""The model of confidence of plain maps (see `rating`), as `python -m benchmarks.trust.plain` wrote it."""

from __future__ import annotations

from gmds.matching.weights import Weight

# In the order of `CHOSEN`.
PLAIN_CONSTANT = -11.21
PLAIN_WEIGHTS = {
    "spectral": Weight(-1.099, -3.245, 0.3166),
    "stress": Weight(-0.9859, -4.89, -0.7996),
    "folds": Weight(0.1378, -8.602, 0.5873),
    "strain": Weight(-1.043, -1.386, 2.171),
    "folded": Weight(0.3915, 0.02369, 0.2744),
    "rival": Weight(-3.784, 0.0003355, 0.7021),
    "whole_energy": Weight(0.8347, -0.5665, 1.331),
    "simplified_misfit": Weight(-2.086, -4.25, -3.616),
}

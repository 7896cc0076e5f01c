"""From a rough map of all vertices to a good one, in the metric that suits the pair."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from gmds.conformal import ConformalClass
from gmds.functional_maps import nearest_rows, spectral_upsampling
from gmds.surface import Surface, View

Index = NDArray[np.int64]

# heat time, in units of the area, that smooths the factor, and the eigenfunctions used after; coarse to fine
ROUNDS: tuple[tuple[float, tuple[int, ...]], ...] = (
    (3e-3, (16, 20, 24, 28, 32, 40)),
    (2e-3, (20, 28, 40, 50)),
    (1e-3, (24, 40, 60)),
)
LADDER = (16, 20, 24, 28, 32, 40, 50, 60)


def align(
    source: Surface,
    target: ConformalClass,
    samples: Index,
    images: Index,
    rounds: Sequence[tuple[float, tuple[int, ...]]] = ROUNDS,
) -> tuple[Index, View]:
    """A map (n,) to target vertices, refined in the metric of the target in which it keeps area; and that view.

    Each round finds that metric for the map so far, and refines the map of the `samples` (p,) by spectral upsampling
    from few eigenfunctions to many.
    """
    view = target.surface.regular
    for time, sizes in rounds:
        amounts = np.bincount(images, source.areas, minlength=len(target.surface.areas))
        view = target.view(target.density(amounts, time), sizes[-1])
        images = upsample(source.regular, view, samples, images, sizes)
    return images, view


def upsample(source: View, target: View, samples: Index, images: Index, sizes: Sequence[int] = LADDER) -> Index:
    """A map (n,) to target vertices after spectral upsampling of its `samples` (p,) between two views."""
    most = min(source.functions.shape[1], target.functions.shape[1])
    steps = sorted({min(k, most) for k in sizes})
    usable = target.usable
    position = np.zeros(len(target.functions), dtype=np.int64)
    position[usable] = np.arange(len(usable))
    rows = target.functions[usable, : steps[-1]]
    matrix, _ = spectral_upsampling(source.functions[samples], rows, position[images[samples]], steps)
    return usable[nearest_rows(source.functions[:, : steps[-1]], rows @ matrix.T)]

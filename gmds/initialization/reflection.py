"""Self-maps of a surface that reverse its orientation: nearly every animal has one."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Integers
from gmds.initialization import eigenfunction_signs
from gmds.spectral.orientation import vertex_map_orientation
from gmds.spectral.sample_maps import COARSE, SampledPair
from gmds.surface.measured import Surface
from gmds.surface.view import View

# All set by hand.
FIRST_STEPS = 3  # of refinement, before the unlikely are dropped
KEPT = 16  # that are refined to the end
MOST_STRESS = 0.2  # relative change of distances above which a self-map is no symmetry
REVERSED = -0.3  # orientation score below which a self-map counts as reversing


def mirror(surface: Surface, view: View) -> Integers | None:
    """The best orientation-reversing self-map (n,) of a surface in one of its views; None when it has none.

    In the eigenfunctions of a symmetric surface a symmetry is a diagonal of signs (Ovsjanikov, Sun, Guibas 2008), so
    all signs of the first few are tried, and the likely ones refined to the end.
    """
    pair = SampledPair.of(view, view, -1)
    few = pair.coarse
    begun = few.all_refined(eigenfunction_signs(few), COARSE[:FIRST_STEPS])
    likely = np.argsort([few.stress(images) for images in begun], kind="stable")[:KEPT]
    maps = [pair.of_coarse(begun[i], COARSE[FIRST_STEPS - 1]) for i in likely]
    maps = pair.all_refined(maps, COARSE[FIRST_STEPS:])
    for i in np.argsort([pair.stress(images) for images in maps], kind="stable"):
        if pair.stress(maps[i]) > MOST_STRESS:
            return None
        images = pair.dense(maps[i])
        if vertex_map_orientation(surface.mesh, surface.mesh, images) < REVERSED:
            return images
    return None

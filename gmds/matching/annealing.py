r"""Proposals annealed from a few eigenfunctions to many, with positions, normals and spectrum compared together.

With the first k eigenfunctions :math:`\Phi_k` a surface x has the smooth shell :math:`\Phi_k \Phi_k^+ x`. A map P of
the source to the target sends the shell of the target back, :math:`y_k = \Phi_k \Phi_k^+ (y_T \circ P)`: where the
source lies when it is deformed by k functions alone. In turn, with ever larger k, every point of the source is sent to
the point of the target that is nearest in

.. math:: (y_k,\; 0.1\, n(y_k),\; w \Phi_k C / \sqrt{k}), \qquad C = \Phi_k^+ (\Psi_k \circ P),

and its own shell, normals and eigenfunctions :math:`\Psi_k` (Smooth Shells: Eisenberger, Laehner, Cremers 2020; here
without an energy of the deformation, as the simplified meshes are registered after it). Far from an isometry, where
eigenfunctions alone lead astray, space still says what a leg is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from geodesics.arrays import Floats
from geodesics.caching import cached_property
from geodesics.threads import side_by_side
from gmds.matching.pair import SurfacePair
from gmds.matching.proposals import Proposal
from gmds.registration.deformable import DeformableMesh
from gmds.spectral.functional_maps import nearest_rows
from gmds.surface.view import View

SIZES = (6, 7, 9, 11, 14, 18, 22, 27, 34, 42, 52, 65, 81, 100)  # numbers of eigenfunctions, in logarithmic steps
# Root areas that eigenfunctions of root mean square 1, all taken together, count as, and how many maps are annealed:
# 0.1 and 0.6, and 3 and 12 maps, found no better ones on development pairs (benchmarks/results/notes.md, "Annealing").
SPECTRAL_WEIGHT = 0.3
MOST_ANNEALED = 6
# Of log-likelihood, which the likeliest must gain: of six development pairs that gained less three lost accuracy, of
# five that gained more none did (the same section).
LEAST_GAIN = 0.1


def annealed(pair: SurfacePair, maps: Sequence[Proposal]) -> list[Proposal]:
    """The likeliest of some maps, each annealed and registered again on the simplified meshes.

    None if nothing is gained by it. What is gained is log-likelihood, `LEAST_GAIN` by the likeliest of them.
    """
    likeliest = sorted(maps, key=lambda one: one.neg_log_likelihood)[:MOST_ANNEALED]
    annealing = Annealing(*pair.simplified, (pair.source.regular, pair.target.regular))

    def again(one: Proposal) -> Proposal:
        return replace(Proposal.of(pair, annealing.annealed(one.registered.y)), improved=True)

    found = side_by_side(again, likeliest)
    gain = min(one.neg_log_likelihood for one in likeliest) - min(one.neg_log_likelihood for one in found)
    return found if gain > LEAST_GAIN else []


class Shell(NamedTuple):
    """The target smoothed by `k` functions (q, 3), that with normals (q, 6), and of the source the inverse (k, n)."""

    k: int
    smooth: Floats
    features: Floats
    inverse: Floats


@dataclass(frozen=True, eq=False)
class Annealing:
    """Of maps of a simplified source to a simplified target, seen in the `views` of what they are copies of."""

    source: DeformableMesh
    target: DeformableMesh
    views: tuple[View, View]

    @cached_property
    def _functions(self) -> tuple[Floats, Floats]:
        """Eigenfunctions (n, k), (q, k) at the vertices of both."""
        ours, theirs = self.views
        return ours.functions[self.source.origin], theirs.functions[self.target.origin]

    @cached_property
    def shells(self) -> list[Shell]:
        """The shells for every number of functions that both have."""
        (ours, theirs), view = self._functions, self.views[1]
        moments = view.functions.T @ (view.spectrum.mass[:, None] * view.mesh.vertices)
        weights = np.sqrt(self.source.areas)
        shells = []
        for k in (size for size in SIZES if size <= min(ours.shape[1], theirs.shape[1])):
            smooth = theirs[:, :k] @ moments[:k]
            inverse = np.asarray(np.linalg.pinv(weights[:, None] * ours[:, :k]) * weights, dtype=np.float64)
            shells.append(Shell(k, smooth, self.target.moved_features(smooth), inverse))
        return shells

    def annealed(self, places: Floats) -> Floats:
        """Where the map that sends the vertices of the source to `places` (n, 3) of the target sends them (n, 3)."""
        ours, theirs = self._functions
        images = self.target.places.query(places)[1]
        for k, smooth, features, inverse in self.shells:
            here, there, weight = ours[:, :k], theirs[:, :k], SPECTRAL_WEIGHT / np.sqrt(k)
            moved = self.source.moved_features(here @ (inverse @ smooth[images]))
            pulled_back = here @ (inverse @ there[images])
            images = nearest_rows(np.hstack([moved, weight * pulled_back]), np.hstack([features, weight * there]))
        return np.asarray(self.target.mesh.vertices[images], dtype=np.float64)

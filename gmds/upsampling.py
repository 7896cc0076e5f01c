"""Sample maps: a few hundred samples of the source placed on samples of the target, refined spectrally."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geodesics.euclidean import euclidean_distances
from geodesics.threads import cached_property
from gmds.functional_maps import functional_map, nearest_rows
from gmds.orientation import orientation_forms, pulled_back_forms
from gmds.surface import View

Array = NDArray[np.float64]
Index = NDArray[np.int64]

SOURCE_SAMPLES = 400
TARGET_SAMPLES = 1000
COARSE = (6, 7, 8, 10, 12, 14, 17, 20, 24)  # numbers of eigenfunctions while forms are compared too
FORM_WEIGHT = 0.6
JUDGED = 200  # samples and eigenfunctions that tell one start from another
FUNCTIONS = 40


@dataclass(frozen=True, eq=False)
class SampledPair:
    """Two views, each with its farthest points: `source_samples` (p,) are placed on `target_samples` (q,).

    A sample map is an index array (p,) into `target_samples`. `sense` is 1 where maps are to keep orientation, -1 where
    they are to reverse it, 0 where either will do.
    """

    source: View
    target: View
    source_samples: Index
    target_samples: Index
    sense: int = 1

    @classmethod
    def of(cls, source: View, target: View, sense: int = 1) -> SampledPair:
        """The pair with the usual numbers of samples."""
        return cls(source, target, source.samples(SOURCE_SAMPLES), target.samples(TARGET_SAMPLES), sense)

    @cached_property
    def source_rows(self) -> Array:
        """Eigenfunctions at the source samples (p, k)."""
        return self.source.functions[self.source_samples]

    @cached_property
    def target_rows(self) -> Array:
        """Eigenfunctions at the target samples (q, k)."""
        return self.target.functions[self.target_samples]

    @cached_property
    def _forms(self) -> tuple[Array, Array, Array]:
        """Forms of the source, scaled and rooted, of the target, and the scale of the source's."""
        here = _signed_root(orientation_forms(self.source, self.source_samples))
        scale = FORM_WEIGHT / np.maximum(np.sqrt((here**2).mean(axis=0)), np.finfo(float).tiny)
        there = self.sense * orientation_forms(self.target, self.target_samples)
        return here * scale * abs(self.sense), there, scale

    @cached_property
    def _inverses(self) -> dict[int, Array]:
        """Pseudo-inverses of the source rows, shared by all starts."""
        sizes = [k for k in COARSE if k <= self.source_rows.shape[1]]
        return {k: np.asarray(np.linalg.pinv(self.source_rows[:, :k]), dtype=np.float64) for k in sizes}

    def matrix(self, images: Index, k: int) -> Array:
        """The functional map (k, k) of a sample map."""
        if k in self._inverses:
            return self._inverses[k] @ self.target_rows[images, :k]
        return functional_map(self.source_rows[:, :k], self.target_rows[images, :k])

    def images(self, matrix: Array) -> Index:
        """The sample map of a functional map C (k, k), eigenfunctions and orientation forms taken together."""
        k = len(matrix)
        ours, theirs, scale = self._forms
        queries = np.hstack([self.source_rows[:, :k], ours])
        rows = np.hstack([self.target_rows[:, :k] @ matrix.T, _signed_root(pulled_back_forms(theirs, matrix)) * scale])
        return nearest_rows(queries, rows)

    def refined(self, images: Index, sizes: Iterable[int] = COARSE) -> Index:
        """A sample map refined with ever more eigenfunctions."""
        for k in sizes:
            if k <= min(self.source_rows.shape[1], self.target_rows.shape[1]):
                images = self.images(self.matrix(images, k))
        return images

    def dense(self, images: Index) -> Index:
        """The sample map carried to all vertices: target vertices (n,)."""
        return self.carried(images, np.arange(self.source.mesh.n_vertices), self.target.usable)

    def carried(self, images: Index, vertices: Index, goals: Index) -> Index:
        """The sample map carried to some source vertices (p,): for each the target vertex it goes to among `goals`."""
        k = min(COARSE[-1], self.source_rows.shape[1], self.target_rows.shape[1])
        rows = self.target.functions[goals, :k] @ self.matrix(images, k).T
        return goals[nearest_rows(self.source.functions[vertices, :k], rows)]

    @cached_property
    def source_distances(self) -> Array:
        """Commute-time distances between the first source samples, a square array."""
        rows = self.source.embedding[self.source_samples[:JUDGED], :FUNCTIONS]
        return euclidean_distances(rows, rows)

    @cached_property
    def _target_distances(self) -> Array:
        """The same between all target samples."""
        rows = self.target.embedding[self.target_samples, :FUNCTIONS]
        return euclidean_distances(rows, rows)

    def stress(self, images: Index) -> float:
        """Mean |d_S - d_Q| between the first samples over mean d_S, in commute-time distance."""
        first = images[:JUDGED]
        there = self._target_distances[first][:, first]
        return float(np.abs(self.source_distances - there).mean() / self.source_distances.mean())

    def gap(self, images: Index, others: Index) -> float:
        """How far two sample maps are apart: mean distance of their images over mean d_S."""
        e = self.target.embedding[self.target_samples, :FUNCTIONS]
        return float(np.linalg.norm(e[images] - e[others], axis=1).mean() / self.source_distances.mean())


def _signed_root(values: Array) -> Array:
    """sign(x) sqrt|x|: tames the tails of a product of two derivatives."""
    return np.sign(values) * np.sqrt(np.abs(values))

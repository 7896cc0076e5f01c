"""Sample maps: a few hundred samples of the source placed on samples of the target, refined spectrally."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geodesics.arrays import Floats, Integers
from geodesics.caching import cached_property
from geodesics.euclidean import euclidean_distances
from geodesics.threads import side_by_side
from gmds._kernels.sample_maps import mean_difference, placed, refined
from gmds.spectral.functional_maps import functional_map, nearest_rows
from gmds.spectral.orientation import orientation_forms
from gmds.surface.view import View

# Half of either was worse on two of twelve FAUST pairs (benchmarks/results/notes.md, "Faster by a third").
SOURCE_SAMPLES = 400
TARGET_SAMPLES = 1000
COARSE = (6, 7, 8, 10, 12, 14, 17, 20, 24)  # numbers of eigenfunctions while forms are compared too; set by hand
FORM_WEIGHT = 0.6  # root mean square of the forms, that of an eigenfunction being 1; set by hand
JUDGED = 200  # samples between which the stress of a sample map is measured; set by hand
FUNCTIONS = 40  # eigenfunctions of the commute-time distance that it is measured in; set by hand


@dataclass(frozen=True, eq=False)
class SampledPair:
    """Two views, each with its farthest points: `source_samples` (p,) are placed on `target_samples` (q,).

    A sample map is an index array (p,) into `target_samples`. `sense` is 1 where maps are to keep orientation, -1 where
    they are to reverse it, 0 where either will do.
    """

    source: View
    target: View
    source_samples: Integers
    target_samples: Integers
    sense: int = 1

    @classmethod
    def of(cls, source: View, target: View, sense: int = 1) -> SampledPair:
        """The pair with the usual numbers of samples."""
        return cls(source, target, source.samples(SOURCE_SAMPLES), target.samples(TARGET_SAMPLES), sense)

    @cached_property
    def coarse(self) -> SampledPair:
        """The pair with the first half of its samples, on which the first steps from a start cost a quarter."""
        halves = (
            self.source_samples[: len(self.source_samples) // 2],
            self.target_samples[: len(self.target_samples) // 2],
        )
        return SampledPair(self.source, self.target, *halves, self.sense)

    def of_coarse(self, images: Integers, k: int) -> Integers:
        """A sample map of the coarse pair on all samples, by its functional map of k eigenfunctions."""
        return self.images(self.coarse.matrix(images, k))

    @cached_property
    def source_rows(self) -> Floats:
        """Eigenfunctions at the source samples (p, k)."""
        return self.source.functions[self.source_samples]

    @cached_property
    def target_rows(self) -> Floats:
        """Eigenfunctions at the target samples (q, k)."""
        return self.target.functions[self.target_samples]

    @cached_property
    def _forms(self) -> tuple[Floats, Floats, Floats]:
        """Forms of the source, scaled and rooted, of the target, and the scale of the source's."""
        here = _signed_root(orientation_forms(self.source, self.source_samples))
        scale = FORM_WEIGHT / np.maximum(np.sqrt((here**2).mean(axis=0)), np.finfo(float).tiny)
        there = self.sense * orientation_forms(self.target, self.target_samples)
        return here * scale * abs(self.sense), there, scale

    @cached_property
    def _inverses(self) -> Floats:
        """Pseudo-inverses of the source rows (s, K, p), in the first rows of each, shared by all starts."""
        stacked = np.zeros((len(self._sizes), self._sizes[-1], len(self.source_rows)))
        for inverse, k in zip(stacked, self._sizes, strict=True):
            inverse[:k] = np.linalg.pinv(self.source_rows[:, :k])
        return stacked

    @cached_property
    def _sizes(self) -> list[int]:
        """Numbers of eigenfunctions that both have."""
        return [k for k in COARSE if k <= min(self.source_rows.shape[1], self.target_rows.shape[1])]

    @cached_property
    def _rows(self) -> tuple[NDArray[np.float32], Floats, NDArray[np.float32], Floats, Floats]:
        """What `gmds._kernels.sample_maps.placed` compares."""
        ours, theirs, scale = self._forms
        return self.source_rows.astype(np.float32), self.target_rows, ours.astype(np.float32), theirs, scale

    def matrix(self, images: Integers, k: int) -> Floats:
        """The functional map (k, k) of a sample map."""
        if k in self._sizes:
            return np.asarray(self._inverses[self._sizes.index(k), :k] @ self.target_rows[images, :k])
        return functional_map(self.source_rows[:, :k], self.target_rows[images, :k])

    def images(self, matrix: Floats) -> Integers:
        """The sample map of a functional map C (k, k), eigenfunctions and orientation forms taken together."""
        return placed(np.ascontiguousarray(matrix), *self._rows)

    def refined(self, images: Integers, sizes: Sequence[int] = COARSE) -> Integers:
        """A sample map refined with ever more eigenfunctions, as many as some of `COARSE` say."""
        steps = np.array([(i, k) for i, k in enumerate(self._sizes) if k in sizes], dtype=np.int64)
        return refined(images, steps, self._inverses, *self._rows) if len(steps) else images

    def all_refined(self, maps: Sequence[Integers], sizes: Sequence[int] = COARSE) -> list[Integers]:
        """Sample maps, each refined."""
        return side_by_side(lambda images: self.refined(images, sizes), maps)

    def dense(self, images: Integers) -> Integers:
        """The sample map extended to all vertices: target vertices (n,)."""
        return self.extended(images, np.arange(self.source.mesh.n_vertices), self.target.usable)

    def extended(self, images: Integers, vertices: Integers, goals: Integers) -> Integers:
        """The sample map extended to some source vertices (p,): for each the target vertex it goes to among `goals`."""
        k = min(COARSE[-1], self.source_rows.shape[1], self.target_rows.shape[1])
        rows = self.target.functions[goals, :k] @ self.matrix(images, k).T
        return goals[nearest_rows(self.source.functions[vertices, :k], rows)]

    @cached_property
    def source_distances(self) -> Floats:
        """Commute-time distances between the first source samples, a square array."""
        rows = self.source.commute_time_embedding[self.source_samples[:JUDGED], :FUNCTIONS]
        return euclidean_distances(rows, rows)

    @cached_property
    def _target_distances(self) -> Floats:
        """The same between all target samples."""
        rows = self.target.commute_time_embedding[self.target_samples, :FUNCTIONS]
        return euclidean_distances(rows, rows)

    def stress(self, images: Integers) -> float:
        """Mean |d_S - d_Q| between the first samples over mean d_S, in commute-time distance."""
        first = images[:JUDGED]
        return mean_difference(self.source_distances, self._target_distances, first) / self._mean_distance

    @cached_property
    def _mean_distance(self) -> float:
        return float(self.source_distances.mean())

    def gap(self, images: Integers, others: Integers) -> float:
        """How far two sample maps are apart: mean distance of their images over mean d_S."""
        e = self.target.commute_time_embedding[self.target_samples, :FUNCTIONS]
        return float(np.linalg.norm(e[images] - e[others], axis=1).mean() / self._mean_distance)


def _signed_root(values: Floats) -> Floats:
    """sign(x) sqrt|x|: tames the tails of a product of two derivatives."""
    return np.sign(values) * np.sqrt(np.abs(values))

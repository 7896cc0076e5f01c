"""One vector per surface: how much of its area says which word."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from geodesics import Mesh, Spectrum
from geodesics.arrays import Floats
from gmds.retrieval.descriptors import Described, Descriptor, signatures_of
from gmds.retrieval.vocabulary import Vocabulary, learn_vocabulary


def bag(assignment: Floats, mass: Floats) -> Floats:
    """Bag of features (Table 1): the mean of theta(x) (n, words) over the surface, by area: (words,), sums to 1."""
    return mass @ assignment / mass.sum()


def pair_bag(assignment: Floats, spectrum: Spectrum, time: float) -> Floats:
    """Spatially sensitive bag: the mean of theta_i(x) h_t(x, y) theta_j(y) over x, by area: (words, words), sums to 1.

    Words near one another by the heat kernel h_t of sec. 3, `time` in units of the area (Bronstein, Bronstein, Guibas,
    Ovsjanikov 2011). Symmetric; its rows sum to the bag itself.
    """
    area = spectrum.mass.sum()
    coefficients = (spectrum.mass[:, None] * assignment).T @ spectrum.eigenfunctions
    return (coefficients * np.exp(-spectrum.eigenvalues * time * area)) @ coefficients.T / area


@dataclass(frozen=True, eq=False)
class BagOfFeatures:
    """Turns a mesh into a vector that sums to 1 and depends on neither numbering, pose nor size (Table 1).

    With descriptors in a scale-invariant metric, the size of single parts does not matter either. Several descriptors
    have a vocabulary each, and their bags, one after another, an equal share in the sum.
    """

    descriptors: tuple[Descriptor, ...]
    vocabularies: tuple[Vocabulary, ...]

    def __call__(self, mesh: Mesh) -> Floats:
        """The bag of a mesh. Raises `MeshError` or `EigensolverFailed` where a metric cannot be measured."""
        return self.of(signatures_of(mesh, self.descriptors))

    def of(self, parts: Sequence[Described]) -> Floats:
        """The bag of a mesh from what the descriptors say of it."""
        found = [bag(v.assign(part.values), part.mass) for v, part in zip(self.vocabularies, parts, strict=True)]
        return np.concatenate(found) / len(found)


def learned(
    descriptors: Sequence[Descriptor], examples: Sequence[Sequence[Described]], n_words: int = 48, *, rng: int = 0
) -> BagOfFeatures:
    """A bag of features whose words come from some meshes, given by what the descriptors say of each."""
    samples = [[(part.values, part.mass) for part in parts] for parts in zip(*examples, strict=True)]
    words = tuple(learn_vocabulary(sample, n_words, rng=rng) for sample in samples)
    return BagOfFeatures(tuple(descriptors), words)

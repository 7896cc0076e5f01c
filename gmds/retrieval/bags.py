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
    r"""Turns a mesh into a vector that depends on neither numbering, pose nor size (Table 1).

    .. math:: f_i = \frac{1}{\mathrm{area}} \int \theta_i(x) \, da

    where :math:`\theta_i(x)` is how much the descriptor at x is like the i-th word of a vocabulary. With descriptors in
    a scale-invariant metric the sizes of single parts do not matter either. Several descriptors have a vocabulary each,
    and their bags, one after another, an equal share in the sum, which is 1.

    Parameters
    ----------
    descriptors : tuple of Descriptor
        A metric and a signature each.
    vocabularies : tuple of Vocabulary
        Words for each of them, as `gmds.retrieval.learned` finds them.

    See Also
    --------
    retrieve : Ranks a collection.

    References
    ----------
    Table 1; A. M. Bronstein, M. M. Bronstein, L. J. Guibas and M. Ovsjanikov, "Shape Google", ACM Trans. Graph. 30
    (2011).

    Examples
    --------
    >>> from gmds.retrieval import DEFAULT, learned, signatures_of
    >>> from gmds.shapes import humanoid, quadruped
    >>> parts = [signatures_of(mesh, DEFAULT) for mesh in (quadruped(n_vertices=200), humanoid(n_vertices=200))]
    >>> bags = learned(DEFAULT, parts)  # a `BagOfFeatures`
    >>> float(bags.of(parts[0]).sum().round(6))
    1.0
    """

    descriptors: tuple[Descriptor, ...]
    vocabularies: tuple[Vocabulary, ...]

    def __call__(self, mesh: Mesh) -> Floats:
        """The bag of a mesh.

        Parameters
        ----------
        mesh : Mesh
            The shape; it is mended first.

        Returns
        -------
        array of shape (words of all vocabularies,)
            Non-negative, with sum 1.

        Raises
        ------
        MeshError
            Where a metric cannot be measured.
        EigensolverFailed
            E402.
        """
        return self.of(signatures_of(mesh, self.descriptors))

    def of(self, parts: Sequence[Described]) -> Floats:
        """The bag of a mesh from its signatures.

        Parameters
        ----------
        parts : sequence of Described
            For each descriptor the signatures of all vertices, as `gmds.retrieval.signatures_of` gives them.

        Returns
        -------
        array of shape (words of all vocabularies,)
            Non-negative, with sum 1.
        """
        found = [bag(v.assign(part.values), part.mass) for v, part in zip(self.vocabularies, parts, strict=True)]
        return np.concatenate(found) / len(found)


def learned(
    descriptors: Sequence[Descriptor], examples: Sequence[Sequence[Described]], n_words: int = 48, *, rng: int = 0
) -> BagOfFeatures:
    """A bag of features whose words come from some meshes, given by what the descriptors say of each."""
    samples = [[(part.values, part.mass) for part in parts] for parts in zip(*examples, strict=True)]
    words = tuple(learn_vocabulary(sample, n_words, rng=rng) for sample in samples)
    return BagOfFeatures(tuple(descriptors), words)

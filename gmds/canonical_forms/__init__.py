"""Canonical forms: a surface bent into a Euclidean space that has its distances, by one scaling a file."""

from gmds.canonical_forms.canonical_form import CanonicalForm, canonical_form
from gmds.canonical_forms.classical import classical_scaling
from gmds.canonical_forms.smacof import smacof
from gmds.canonical_forms.spectral import spectral_scaling, squared_distances_in_eigenfunctions

__all__ = [
    "CanonicalForm",
    "canonical_form",
    "classical_scaling",
    "smacof",
    "spectral_scaling",
    "squared_distances_in_eigenfunctions",
]

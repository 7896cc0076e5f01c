"""Functional maps to work with: from descriptors, from points, from distances, of a surface with itself; and back."""

from gmds.spectral_maps.fitting import functional_map
from gmds.spectral_maps.representation import FunctionalMap
from gmds.spectral_maps.self_functional_map import self_functional_features, self_functional_map
from gmds.spectral_maps.spectral_gmds import SpectralPlacement, spectral_gmds

__all__ = [
    "FunctionalMap",
    "SpectralPlacement",
    "functional_map",
    "self_functional_features",
    "self_functional_map",
    "spectral_gmds",
]

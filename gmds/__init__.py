"""Placing one surface on another: generalised multidimensional scaling in scale-invariant geometry.

Names are imported when first used, so `import gmds` costs nothing.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from geodesics.moved_paths import keep_old_paths
from gmds._version import __version__ as __version__
from gmds.moved_paths import MOVED

if TYPE_CHECKING:
    from gmds.atlases import Atlas as Atlas
    from gmds.atlases import atlas as atlas
    from gmds.batch import match_collection as match_collection
    from gmds.canonical_forms import CanonicalForm as CanonicalForm
    from gmds.canonical_forms import canonical_form as canonical_form
    from gmds.comparison.distortion import dissimilarity as dissimilarity
    from gmds.comparison.gromov_hausdorff import gromov_hausdorff_bounds as gromov_hausdorff_bounds
    from gmds.comparison.gromov_wasserstein import gromov_wasserstein_bounds as gromov_wasserstein_bounds
    from gmds.comparison.profiles import distance_profile as distance_profile
    from gmds.comparison.profiles import least_distortion as least_distortion
    from gmds.correspondence import Correspondence as Correspondence
    from gmds.deformations import bending as bending
    from gmds.deformations import global_scale as global_scale
    from gmds.deformations import local_scaling as local_scaling
    from gmds.deformations import noise as noise
    from gmds.deformations import remeshing as remeshing
    from gmds.evaluation import ErrorSummary as ErrorSummary
    from gmds.evaluation import error_curve as error_curve
    from gmds.evaluation import geodesic_error as geodesic_error
    from gmds.evaluation import summary as summary
    from gmds.landmarks.soft import SoftLandmarks as SoftLandmarks
    from gmds.maps.growth import Growth as Growth
    from gmds.maps.growth import growth_between as growth_between
    from gmds.maps.growth import growth_of as growth_of
    from gmds.maps.point_map import Candidate as Candidate
    from gmds.maps.point_map import MatchStatus as MatchStatus
    from gmds.matching.pipeline import match as match
    from gmds.matching.symmetry import self_symmetry as self_symmetry
    from gmds.mds.ladder import solve_by_ladder as solve_by_ladder
    from gmds.mds.losses import Huber as Huber
    from gmds.mds.losses import LeastSquares as LeastSquares
    from gmds.mds.losses import Minimax as Minimax
    from gmds.mds.losses import Power as Power
    from gmds.mds.multiresolution import solve_multiresolution as solve_multiresolution
    from gmds.mds.partial import PartialSolution as PartialSolution
    from gmds.mds.partial import solve_partial as solve_partial
    from gmds.mds.problem import Problem as Problem
    from gmds.mds.solver import Solution as Solution
    from gmds.mds.solver import solve as solve
    from gmds.mds.status import Status as Status
    from gmds.mds.tabulated import TabulatedDistance as TabulatedDistance
    from gmds.morphometrics import ShapeModel as ShapeModel
    from gmds.retrieval import BagOfFeatures as BagOfFeatures
    from gmds.retrieval import retrieve as retrieve
    from gmds.spectral_maps import FunctionalMap as FunctionalMap
    from gmds.spectral_maps import SpectralPlacement as SpectralPlacement
    from gmds.spectral_maps import functional_map as functional_map
    from gmds.spectral_maps import self_functional_features as self_functional_features
    from gmds.spectral_maps import self_functional_map as self_functional_map
    from gmds.spectral_maps import spectral_gmds as spectral_gmds

# every public name, by the module it lives in
_NAMES = {
    "atlases": (
        "Atlas",
        "atlas",
    ),
    "batch": ("match_collection",),
    "canonical_forms": (
        "CanonicalForm",
        "canonical_form",
    ),
    "comparison.distortion": ("dissimilarity",),
    "comparison.gromov_hausdorff": ("gromov_hausdorff_bounds",),
    "comparison.gromov_wasserstein": ("gromov_wasserstein_bounds",),
    "comparison.profiles": (
        "distance_profile",
        "least_distortion",
    ),
    "correspondence": ("Correspondence",),
    "deformations": (
        "bending",
        "global_scale",
        "local_scaling",
        "noise",
        "remeshing",
    ),
    "evaluation": (
        "ErrorSummary",
        "error_curve",
        "geodesic_error",
        "summary",
    ),
    "spectral_maps": (
        "FunctionalMap",
        "SpectralPlacement",
        "functional_map",
        "self_functional_features",
        "self_functional_map",
        "spectral_gmds",
    ),
    "landmarks.soft": ("SoftLandmarks",),
    "maps.growth": (
        "Growth",
        "growth_between",
        "growth_of",
    ),
    "maps.point_map": (
        "Candidate",
        "MatchStatus",
    ),
    "matching.pipeline": ("match",),
    "matching.symmetry": ("self_symmetry",),
    "mds.ladder": ("solve_by_ladder",),
    "mds.losses": (
        "Huber",
        "LeastSquares",
        "Minimax",
        "Power",
    ),
    "mds.multiresolution": ("solve_multiresolution",),
    "mds.partial": (
        "PartialSolution",
        "solve_partial",
    ),
    "mds.problem": ("Problem",),
    "mds.solver": (
        "Solution",
        "solve",
    ),
    "mds.status": ("Status",),
    "mds.tabulated": ("TabulatedDistance",),
    "morphometrics": ("ShapeModel",),
    "retrieval": (
        "BagOfFeatures",
        "retrieve",
    ),
}
_SUBMODULES = ("benchmarking", "errors", "initialization", "landmarks", "pictures", "report", "shapes", "surface")
_HOME = {name: module for module, names in _NAMES.items() for name in names}

__all__ = sorted(_HOME)

keep_old_paths(MOVED)


def __getattr__(name: str) -> Any:
    if name in _HOME:
        value = getattr(importlib.import_module(f"gmds.{_HOME[name]}"), name)
        globals()[name] = value
        return value
    if name in _SUBMODULES or name in _NAMES:
        return importlib.import_module(f"gmds.{name}")
    raise AttributeError(f"module 'gmds' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

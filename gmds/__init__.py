"""Placing one surface on another: generalised multidimensional scaling in scale-invariant geometry.

Names are imported when first used, so `import gmds` costs nothing.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from gmds.batch import match_collection as match_collection
    from gmds.correspondence import Candidate as Candidate
    from gmds.correspondence import Correspondence as Correspondence
    from gmds.correspondence import MatchStatus as MatchStatus
    from gmds.deformations import bending as bending
    from gmds.deformations import global_scale as global_scale
    from gmds.deformations import local_scaling as local_scaling
    from gmds.deformations import noise as noise
    from gmds.deformations import remeshing as remeshing
    from gmds.evaluation import ErrorSummary as ErrorSummary
    from gmds.evaluation import error_curve as error_curve
    from gmds.evaluation import geodesic_error as geodesic_error
    from gmds.evaluation import summary as summary
    from gmds.landmarks import SoftLandmarks as SoftLandmarks
    from gmds.losses import Huber as Huber
    from gmds.losses import LeastSquares as LeastSquares
    from gmds.losses import Minimax as Minimax
    from gmds.losses import Power as Power
    from gmds.matching import match as match
    from gmds.morphometry import dissimilarity as dissimilarity
    from gmds.multiresolution import solve_multiresolution as solve_multiresolution
    from gmds.problem import Problem as Problem
    from gmds.profiles import distance_profile as distance_profile
    from gmds.profiles import least_distortion as least_distortion
    from gmds.retrieval import BagOfFeatures as BagOfFeatures
    from gmds.retrieval import retrieve as retrieve
    from gmds.solver import Solution as Solution
    from gmds.solver import solve as solve
    from gmds.status import Status as Status
    from gmds.symmetry import self_symmetry as self_symmetry
    from gmds.tabulated import TabulatedDistance as TabulatedDistance

# every public name, by the module it lives in
_NAMES = {
    "batch": ("match_collection",),
    "correspondence": ("Candidate", "Correspondence", "MatchStatus"),
    "deformations": ("bending", "global_scale", "local_scaling", "noise", "remeshing"),
    "evaluation": ("ErrorSummary", "error_curve", "geodesic_error", "summary"),
    "landmarks": ("SoftLandmarks",),
    "losses": ("Huber", "LeastSquares", "Minimax", "Power"),
    "matching": ("match",),
    "morphometry": ("dissimilarity",),
    "multiresolution": ("solve_multiresolution",),
    "problem": ("Problem",),
    "profiles": ("distance_profile", "least_distortion"),
    "retrieval": ("BagOfFeatures", "retrieve"),
    "solver": ("Solution", "solve"),
    "status": ("Status",),
    "symmetry": ("self_symmetry",),
    "tabulated": ("TabulatedDistance",),
}
_SUBMODULES = ("benchmarking", "datasets", "errors", "initialization", "pictures", "report", "shapes")
_HOME = {name: module for module, names in _NAMES.items() for name in names}

__all__ = sorted(_HOME)


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

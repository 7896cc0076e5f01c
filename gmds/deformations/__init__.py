"""Deformations with known truth, one a file.

Each takes a `Mesh` and gives the deformed `Mesh` with the truth: one point of the new mesh (`SurfacePoints`) per vertex
of the old one; where vertices go, `Part` says which. `compose` chains them; `deformed` makes those of Table 1 in five
strengths. Random choices take a seed and repeat exactly.
"""

from gmds.deformations.bending import bending
from gmds.deformations.caricature import caricature
from gmds.deformations.cut import cut
from gmds.deformations.global_scale import global_scale
from gmds.deformations.gluing import gluing
from gmds.deformations.holes import holes
from gmds.deformations.local_scaling import achieved_log_scale, branch_log_scale, local_scaling
from gmds.deformations.noise import noise
from gmds.deformations.remeshing import remeshing
from gmds.deformations.scan import scan
from gmds.deformations.shot_noise import shot_noise
from gmds.deformations.similarity import similarity
from gmds.deformations.strengths import KINDS, STRENGTHS, Kind, deformed, local_scale
from gmds.deformations.truths import Deformation, Part, carried, compose

__all__ = [
    "KINDS",
    "STRENGTHS",
    "Deformation",
    "Kind",
    "Part",
    "achieved_log_scale",
    "bending",
    "branch_log_scale",
    "caricature",
    "carried",
    "compose",
    "cut",
    "deformed",
    "global_scale",
    "gluing",
    "holes",
    "local_scale",
    "local_scaling",
    "noise",
    "remeshing",
    "scan",
    "shot_noise",
    "similarity",
]

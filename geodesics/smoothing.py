"""How much curvature is smoothed: all such constants, each with the reason for its value.

A smoothing is the time of one implicit heat step as a share of the area 4 pi / |K| of the sphere of the same curvature
(`geodesics.curvature.curvature_time`), so it has no unit. Less of it keeps smaller features, and more noise.
"""

from __future__ import annotations

# Gaussian and mean curvature, unless the caller says otherwise. Chosen together with FIRST_LOOK, which is a share of
# the area of the whole surface, on one half of the shapes of benchmarks/stability/curvature_stability.py.
DEFAULT_SMOOTHING = 4e-3
FIRST_LOOK = 3e-3

# The curvature of the equi-affine metric, which takes four derivatives of position instead of two. Set by hand.
EQUI_AFFINE = 2e-2

# The metric in which rough maps are proposed: the error of the proposals on development pairs was smaller than with the
# default (benchmarks/results/notes.md, "Starts: which metric finds the right map").
LARGE_FEATURES = 2e-2

# The metric in which maps of a surface to itself are proposed as well, a tenth of LARGE_FEATURES: it finds the symmetry
# of shapes with one limb enlarged (benchmarks/results/notes.md, "Self-symmetries").
SHARP = 2e-3

# The scale-invariant metric where it serves the whole match alone: the best of 4e-3, 1e-2, 2e-2 and 4e-2 on development
# pairs (benchmarks/results/notes.md, "Known failures").
WHOLE_MATCH = 4e-2

# The mean curvature that distinguishes the front of a body from its back: half-turns are recognised better than with
# the default (benchmarks/results/notes.md, "Choice").
DETAIL = 1e-3

"""How exact coordinates are, and what single precision does to a mesh."""

from __future__ import annotations

import numpy as np

from geodesics.arrays import Floats
from geodesics.mesh import Mesh
from geodesics.notes import Note
from geodesics.topology.edges import edges

# Of the median edge, how far vertices may be moved by rounding: a thousandth turns an edge by a milliradian. Curvature
# is smoothed over more than that; set by hand.
BEARABLE = 1e-3
EXACT = 1e-6  # of the median edge, how exact coordinates should be; set by hand
MOST_DIGITS = 7  # that programs write which round: six, or the seven of single precision
NEARLY_WHOLE = 1e-6  # steps; 1e8 of them in double precision are exact to 1e-8
FAR = 10.0  # extents from the origin at which a mesh lies far from it: single precision has lost a digit there


def median_edge(mesh: Mesh) -> float:
    """The median length of edges that have one, 0 where there are none."""
    ends = edges(mesh).ends
    if not len(ends):
        return 0.0
    a, b = mesh.vertices[ends.T]
    return float(np.median(np.linalg.norm(a - b, axis=1)))


def offset(mesh: Mesh) -> Floats | None:
    """The middle of a mesh that lies far from the origin, in whole single-precision numbers; None of any other."""
    used = mesh.vertices[np.unique(mesh.faces)]
    low, high = used.min(axis=0), used.max(axis=0)
    if np.abs(used).max() <= FAR * float((high - low).max()):
        return None
    return np.asarray((low / 2 + high / 2).astype(np.float32), dtype=np.float64)


def granularity(mesh: Mesh) -> float:
    """To what the coordinates were rounded before they came here: in single precision, or to decimal digits.

    The coarsest of the three axes; 0 where nothing shows that they were.
    """
    return max(_granularity(axis) for axis in mesh.vertices[np.unique(mesh.faces)].T)


def _granularity(values: Floats) -> float:
    largest = float(np.abs(values).max())
    if np.ptp(values) == 0:
        return 0.0  # a plane may well lie at a round number
    with np.errstate(over="ignore"):
        single = bool((values.astype(np.float32) == values).all())
    if single:
        return float(np.spacing(np.float32(largest)))
    power = float(np.floor(np.log10(largest)))
    for digits in range(3, MOST_DIGITS):
        step = 10.0 ** (power - digits)
        steps = values / step
        if np.abs(steps - np.round(steps)).max() < NEARLY_WHOLE:
            return step
    return 0.0


def precision_notes(mesh: Mesh) -> list[Note]:
    """Whether coordinates are so far from the origin that edges have lost their precision (W208)."""
    length = median_edge(mesh)
    if not length:
        return []
    step = float(np.spacing(np.abs(mesh.vertices).max()))
    if step > EXACT * length:
        message = (
            f"the coordinates are only exact to {step:.1e}, edges are {length:.1e} long; move the mesh to the origin"
        )
        return [Note("W208", "warning", message)]
    if offset(mesh) is not None and (step := granularity(mesh)) > BEARABLE * length:
        message = (
            f"the coordinates were rounded to {step:.1e} where the mesh lies, far from the origin, and edges are "
            f"{length:.1e} long: save it again around the origin, or in double precision, before it was rounded"
        )
        return [Note("W208", "warning", message)]
    return []


def rounding_notes(mesh: Mesh, suffix: str, *, centered: bool = True) -> list[Note]:
    """What is lost when a mesh goes into a file of that ending (W224).

    `centered`: whether a mesh far from the origin is written around its middle, with its place in the node of a .glb.
    """
    if suffix not in (".stl", ".glb"):
        return []
    center = offset(mesh) if suffix == ".glb" and centered else None
    there = np.zeros(3) if center is None else center
    moved = float(np.abs((mesh.vertices - there).astype(np.float32).astype(np.float64) + there - mesh.vertices).max())
    if moved > BEARABLE * median_edge(mesh):
        message = f"{suffix} has single precision, which moves vertices by up to {moved:.2g}; write .ply to keep them"
        return [Note("W224", "warning", message)]
    if center is not None:
        message = (
            f"the mesh lies far from the origin: {suffix} has single precision, so vertices are written around their "
            f"middle and the place {center.tolist()} in the node; they move by at most {moved:.2g}"
        )
        return [Note("W224", "info", message)]
    return []

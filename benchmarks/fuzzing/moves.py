"""Ways in which a mesh loses digits, vertices or a dimension: its vertices move."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Faces = NDArray[np.int64]
Move = Callable[[Points, Faces, np.random.Generator], Points]


def quantised(steps: int) -> Move:
    """On a grid of so many steps along the longest side."""

    def change(v: Points, _: object, __: object) -> Points:
        step = np.ptp(v, axis=0).max() / steps
        return np.round(v / step) * step

    return change


def single(extents: float) -> Move:
    """In single precision, so many extents away from the origin."""
    return lambda v, _, __: (v + extents * np.ptp(v, axis=0).max()).astype(np.float32).astype(np.float64)


def far(extents: float) -> Move:
    """In double precision, so many extents away from the origin."""
    return lambda v, _, __: v + extents * np.ptp(v, axis=0).max()


def pressed(factor: float, axes: int = 1) -> Move:
    """Flat along one axis, or a line."""
    return lambda v, _, __: v * ((1.0,) * (3 - axes) + (factor,) * axes)


def collapsed(share: float, apart: float = 0.0) -> Move:
    """A share of the vertices on a neighbour, or so far from it."""

    def change(v: Points, faces: Faces, rng: np.random.Generator) -> Points:
        changed = v.copy()
        corners = faces[rng.permutation(len(faces))[: max(1, int(share * len(v)))]]
        changed[corners[:, 0]] = v[corners[:, 1]] + apart * rng.standard_normal((len(corners), 3))
        return changed

    return change


def gathered(share: float) -> Move:
    """A share of the vertices in one point."""

    def change(v: Points, _: object, rng: np.random.Generator) -> Points:
        changed = v.copy()
        changed[rng.permutation(len(v))[: int(share * len(v))]] = v[0]
        return changed

    return change


def spiked(length: float) -> Move:
    """One vertex so many times farther from the origin."""

    def change(v: Points, _: object, rng: np.random.Generator) -> Points:
        changed = v.copy()
        changed[rng.integers(len(v))] *= length
        return changed

    return change


MOVES: dict[str, Move] = {
    **{f"on a grid of {steps} steps": quantised(steps) for steps in (1000, 100, 30, 10, 4, 2)},
    **{f"single precision, {d:.0e} extents away": single(d) for d in (1e3, 1e5, 1e6, 3e6, 1e7, 1e8)},
    **{f"double precision, {d:.0e} extents away": far(d) for d in (1e8, 1e12, 1e14, 1e15)},
    **{f"flat to {f:.0e}": pressed(f) for f in (1e-3, 1e-6, 1e-9, 1e-15, 0.0)},
    **{f"a line to {f:.0e}": pressed(f, 2) for f in (1e-3, 1e-6, 1e-9, 1e-15)},
    **{f"{s:.1%} on a neighbour": collapsed(s) for s in (0.005, 0.1, 0.3, 0.9)},
    **{f"10 % a {d:.0e} from a neighbour": collapsed(0.1, d) for d in (1e-6, 1e-9, 1e-12, 1e-15)},
    **{f"{s:.0%} in one point": gathered(s) for s in (0.1, 0.5, 0.9)},
    **{f"a spike of {s:.0e}": spiked(s) for s in (1e3, 1e6, 1e9, 1e14)},
}

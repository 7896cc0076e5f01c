"""Colours that people who confuse red and green can tell apart: differences go into lightness and blue to yellow."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial import cKDTree

from geodesics import Mesh
from geodesics.arrays import Floats, Integers
from geodesics.errors import BadArgument

FEW = 2_000  # known values, up to which they are dots: more would hide each other; set by hand
LEAST_REACH = 0.05  # either side of the middle of a range of growth: less is the error of a map (results/growth.md)
# OKLab lightness of the middle, how far it reaches either way, and chroma along the second and third axis: tips of
# limbs of ten shapes (built-in, FAUST, TOSCA) are a quarter farther apart than with less, to three kinds of eyes
LIGHT, REACH, GREEN_RED, BLUE_YELLOW = 0.66, 0.25, 0.12, 0.15
BARE = (0.88, 0.88, 0.88)  # sRGB, light grey of a surface on which only dots have values; set by hand
MISSING = (0.62, 0.62, 0.62)  # sRGB, grey for what has no counterpart or no value; set by hand

BELOW, ABOVE = (-0.02, -0.15), (0.09, 0.10)  # a and b of OKLab at either end, blue and orange; set by hand
# "cividis" (Nunez, Anderton, Renslow 2018) at ten even steps
_CIVIDIS = np.array(
    [
        (0, 34, 78), (18, 53, 112), (59, 73, 108), (87, 93, 109), (112, 113, 115),
        (138, 134, 120), (165, 156, 116), (195, 179, 105), (225, 204, 85), (254, 232, 56),
    ]
) / 255  # fmt: skip


def position_colours(vertices: ArrayLike) -> Floats:
    """Smooth colours (n, 3) in [0, 1] from positions (n, 3): neighbours alike, opposite ends unlike.

    The longest principal axis runs from dark to light; the other two are mixed so that each of them shows in blue
    to yellow as well as in green to red. Colours change fastest in the middle, so that limbs on either side of it,
    fore and hind legs say, differ.
    """
    return oklab_to_rgb(position_oklab(vertices))


def position_oklab(vertices: ArrayLike) -> Floats:
    """`position_colours` before they are sRGB: OKLab (n, 3) of positions (n, 3)."""
    v = np.asarray(vertices, dtype=np.float64)
    centred = v - v.mean(axis=0)
    extent = np.abs(centred).max()
    axes = np.linalg.svd(centred / (extent if extent > 0 else 1), full_matrices=False)[2]
    axes = axes * np.sign(axes[np.arange(len(axes)), np.abs(axes).argmax(axis=1)])[:, None]
    along = centred @ axes.T
    low, span = along.min(axis=0), np.ptp(along, axis=0)
    t, u, w = np.sin(np.pi * ((along - low) / np.where(span > 0, span, 1) - 0.5)).T
    return np.stack([LIGHT + REACH * t, GREEN_RED * (u - w), BLUE_YELLOW * (u + w)], axis=1)


def shown_range(values: Floats) -> tuple[float, float]:
    """From 0 to what 98 % of the finite values stay below, so that a few outliers do not hide the rest."""
    finite = values[np.isfinite(values)]
    return 0.0, float(np.quantile(finite, 0.98)) if len(finite) else 1.0


def symmetric_reach(values: Floats) -> float:
    """How far 98 % of the finite values are from 0, so that a range may be as wide below as above."""
    finite = values[np.isfinite(values)]
    return max(float(np.quantile(np.abs(finite), 0.98)) if len(finite) else 0.0, LEAST_REACH)


def per_vertex(values: ArrayLike, count: int) -> Floats:
    """Values as float64 (count,); ValueError when there is not one for every vertex."""
    v = np.asarray(values, dtype=np.float64)
    if v.shape != (count,):
        raise BadArgument(f"there must be one value for each of the {count} vertices, not an array of shape {v.shape}")
    return v


def nearest_known(mesh: Mesh, values: ArrayLike) -> Floats:
    """Values (n,) that are known at some vertices; at all others, which are not finite, those of the nearest of these.

    Nowhere known, they stay as they are.
    """
    v = per_vertex(values, mesh.n_vertices)
    known = np.flatnonzero(np.isfinite(v))
    return v[known[cKDTree(mesh.vertices[known]).query(mesh.vertices)[1]]] if len(known) else v


def few_known(values: Floats) -> Integers:
    """The vertices (k,) at which values (n,) are finite, where these are few enough to be drawn as dots; else none."""
    known = np.flatnonzero(np.isfinite(values))
    return known if 2 * len(known) <= len(values) and len(known) <= FEW else known[:0]


def value_colours(values: ArrayLike, low: float, high: float) -> Floats:
    """Colours (n, 3) from dark blue at `low` to yellow at `high`; grey where a value is not finite."""
    v = np.asarray(values, dtype=np.float64)
    fine = np.isfinite(v)
    span = high - low if high > low else 1.0
    t = np.where(fine, (np.where(fine, v, low) - low) / span, 0).clip(0, 1) * (len(_CIVIDIS) - 1)
    steps = np.arange(len(_CIVIDIS))
    colours = np.stack([np.interp(t, steps, channel) for channel in _CIVIDIS.T], axis=1)
    colours[~fine] = MISSING
    return colours


def diverging_colours(values: ArrayLike, reach: float) -> Floats:
    """Colours (n, 3) from blue at -`reach` through white at 0 to orange at `reach`; grey where a value is not finite.

    Lightness falls alike on both sides, and those who confuse red and green see blue and orange apart.
    """
    v = np.asarray(values, dtype=np.float64)
    fine = np.isfinite(v)
    t = np.where(fine, v, 0) / (reach if reach > 0 else 1.0)
    size = np.abs(t).clip(0, 1)
    hue = np.where((t < 0)[:, None], BELOW, ABOVE)
    colours = oklab_to_rgb(np.concatenate([(0.97 - 0.47 * size)[:, None], size[:, None] * hue], axis=1))
    colours[~fine] = MISSING
    return colours


def label_colours(labels: ArrayLike) -> Floats:
    """Colours (n, 3), one for each whole number in `labels` (n,); grey for negative ones."""
    numbers = np.asarray(labels).astype(np.int64)
    k = np.arange(max(int(numbers.max(initial=0)), 0) + 1)
    angle, light = 2 * np.pi * 0.381966 * k, 0.5 + 0.38 * ((k * 0.7548776662) % 1)
    palette = oklab_to_rgb(np.stack([light, 0.10 * np.cos(angle), 0.13 * np.sin(angle)], axis=1))
    colours = palette[numbers.clip(0)]
    colours[numbers < 0] = MISSING
    return colours


def css(colours: ArrayLike) -> list[str]:
    """Colours (n, 3) in [0, 1] as a style sheet names them."""
    levels = np.rint(255 * np.asarray(colours, dtype=np.float64).clip(0, 1)).astype(np.int64)
    return [f"#{number:06x}" for number in (levels @ [65536, 256, 1]).tolist()]


def oklab_to_rgb(lab: Floats) -> Floats:
    """sRGB in [0, 1] of OKLab colours (Ottosson 2020), clipped."""
    cone = lab @ np.array(
        [[1, 1, 1], [0.3963377774, -0.1055613458, -0.0894841775], [0.2158037573, -0.0638541728, -1.2914855480]]
    )
    linear = cone**3 @ np.array(
        [
            [4.0767416621, -1.2684380046, -0.0041960863],
            [-3.3077115913, 2.6097574011, -0.7034186147],
            [0.2309699292, -0.3413193965, 1.7076147010],
        ]
    )
    linear = linear.clip(0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)

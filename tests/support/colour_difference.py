"""How far apart two colours are to an eye, also to one that lacks a kind of cone: CIEDE2000 of sRGB colours."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arrays import Floats

# what is left of linear sRGB to eyes without medium, without long cones (Machado, Oliveira, Fernandes 2009, table 1)
EYES = {
    "all cones": np.eye(3),
    "deuteranopia": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    "protanopia": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
}
# IEC 61966-2-1: linear sRGB to XYZ, its white at (1, 1, 1)
XYZ = [[0.4123908, 0.3575843, 0.1804808], [0.2126390, 0.7151687, 0.0721923], [0.0193308, 0.1191948, 0.9505322]]


def lab(colours: ArrayLike, eyes: str = "all cones") -> Floats:
    """CIE L*a*b* (..., 3) of sRGB colours (..., 3) in [0, 1]."""
    c = np.asarray(colours, dtype=np.float64)
    linear = np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
    seen = (linear @ np.transpose(EYES[eyes])).clip(0, 1)
    t = seen @ np.transpose(XYZ) / np.sum(XYZ, axis=1)
    x, y, z = np.moveaxis(np.where(t > (6 / 29) ** 3, np.cbrt(t), t / (3 * (6 / 29) ** 2) + 4 / 29), -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def ciede2000(first: ArrayLike, second: ArrayLike) -> Floats:
    """The colour difference (...,) of L*a*b* colours (..., 3) (Sharma, Wu, Dalal 2005, eqs. 2-22)."""
    (l1, a1, b1), (l2, a2, b2) = np.moveaxis(np.broadcast_arrays(first, second), -1, 1)
    chroma = (np.hypot(a1, b1) + np.hypot(a2, b2)) / 2
    a1, a2 = (a * (1 + 0.5 * (1 - np.sqrt(chroma**7 / (chroma**7 + 25.0**7)))) for a in (a1, a2))
    c1, c2 = np.hypot(a1, b1), np.hypot(a2, b2)
    h1, h2 = np.degrees(np.arctan2(b1, a1)) % 360, np.degrees(np.arctan2(b2, a2)) % 360
    turn = np.where(c1 * c2 == 0, 0, (h2 - h1 + 180) % 360 - 180)
    light, grey = (l1 + l2) / 2, (c1 + c2) / 2
    hue = np.where(c1 * c2 == 0, h1 + h2, (h1 + turn / 2) % 360)
    t = 1 + sum(s * np.cos(np.radians(k * hue + o)) for s, k, o in TERMS)
    dl = (l2 - l1) / (1 + 0.015 * (light - 50) ** 2 / np.sqrt(20 + (light - 50) ** 2))
    dc = (c2 - c1) / (1 + 0.045 * grey)
    dh = 2 * np.sqrt(c1 * c2) * np.sin(np.radians(turn / 2)) / (1 + 0.015 * grey * t)
    rotated = -2 * np.sqrt(grey**7 / (grey**7 + 25.0**7)) * np.sin(np.radians(60 * np.exp(-(((hue - 275) / 25) ** 2))))
    return np.asarray(np.sqrt(dl**2 + dc**2 + dh**2 + rotated * dc * dh))


TERMS = ((-0.17, 1, -30), (0.24, 2, 0), (0.32, 3, 6), (-0.20, 4, -63))  # of T, Sharma, Wu, Dalal 2005, eq. 15

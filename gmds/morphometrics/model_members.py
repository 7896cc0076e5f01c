"""What a file of a shape model holds, and whether its arrays belong together."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geodesics import Mesh

VERSION = 1  # of the file
MEMBERS = (
    "mean",
    "components",
    "explained_variance",
    "explained_variance_ratio",
    "scores",
    "centroid_sizes",
    "faces",
    "aligned",
)
"""Attributes that are kept in a file."""


def checked_members(read: Mapping[str, NDArray[Any]]) -> Mapping[str, NDArray[Any]]:
    """What was read of a file. Raises `ValueError` or `KeyError` where it is no model, or its arrays disagree."""
    if str(read["format"]) != "gmds-model" or int(read["version"]) > VERSION:
        raise ValueError(f"its format is {read['format']}, version {read['version']}")
    n, (c, k) = len(read["mean"]), (len(read["components"]), len(read["scores"]))
    shapes = {
        "mean": (n, 3),
        "components": (c, 3 * n),
        "explained_variance": (c,),
        "explained_variance_ratio": (c,),
        "scores": (k, c),
        "centroid_sizes": (k,),
        "aligned": (k, n, 3),
    }
    for name, shape in shapes.items():
        array = read[name]
        if array.shape != shape or array.dtype.kind != "f" or not np.isfinite(array).all():
            raise ValueError(f"{name} is {array.dtype} of shape {array.shape}; finite numbers {shape} are expected")
    if len(read["faces"]):
        Mesh(read["mean"], read["faces"])
    return read

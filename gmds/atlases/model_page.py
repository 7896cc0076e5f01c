"""The page of a shape model: sliders move its components, and specimens are points that one can touch."""

from __future__ import annotations

import base64
import hashlib
import html
import json
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path
from string import Template

import numpy as np

from geodesics import SurfacePoints
from geodesics.arrays import Floats
from geodesics.io import atomic_write
from geodesics.repair.decimation import decimated
from gmds.morphometrics.shape_model import ShapeModel
from gmds.pictures.camera import Direction, broadside

FACES = 4000  # of the copy that is drawn: what a browser sorts and fills 30 times a second
SLIDERS = 6  # components that have one, a bound of the room there is
DIGITS = 4  # of coordinates, over the extent of the shape
PICTURED = 200  # specimens that are there as they are, 16 kB each: a page of 3 MB; the others as the model has them
STEP = 1e-4  # of their coordinates, over the extent of the shape: finer than a pixel


def write_model_page(model: ShapeModel, path: Path, *, title: str = "Shape model", up: Direction = (0, 0, 1)) -> None:
    """Write a page that loads nothing, atomically; raises `OSError`."""
    mean = model.mean
    copy = decimated(mean, FACES) or mean
    points = SurfacePoints.closest(mean, copy.vertices)
    view = broadside(mean, up, azimuth=0, elevation=0)
    known = [points.interpolate(one) @ view.T for one in model.aligned_[:PICTURED]]
    middle, extent = _frame(mean.vertices @ view.T, known)
    count = min(SLIDERS, model.n_components_)
    modes = [
        points.interpolate(axis.reshape(-1, 3)) * np.sqrt(variance) @ view.T / extent
        for axis, variance in zip(model.components_[:count], model.explained_variance_[:count], strict=True)
    ]
    spread = np.sqrt(model.explained_variance_[:count])
    placed = [(one - middle) / extent / STEP for one in known]
    short = np.clip(np.round(placed), -(2**15) + 1, 2**15 - 1).astype("<i2")
    data = {
        "vertices": _plain((copy.vertices @ view.T - middle) / extent),
        "faces": copy.faces.tolist(),
        "step": STEP,
        "specimens": base64.b64encode(short.tobytes()).decode(),
        "modes": [_plain(mode) for mode in modes],
        "shares": [round(float(share), 4) for share in model.explained_variance_ratio_[:count]],
        "names": list(model.names_) or [f"{i + 1}" for i in range(len(model.scores_))],
        "scores": np.round(model.scores_[:, :count] / np.where(spread > 0, spread, 1), 3).tolist(),
    }
    script = (files("gmds.atlases") / "model.js").read_text("utf-8")
    digest = base64.b64encode(hashlib.sha256(script.encode("utf-8")).digest()).decode()
    text = json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    page = Template((files("gmds.atlases") / "model.html").read_text("utf-8")).substitute(
        title=html.escape(title), hash=f"'sha256-{digest}'", data=text, script=script
    )
    with atomic_write(path) as stream:
        stream.write(page.encode("utf-8", "replace"))


def _frame(mean: Floats, specimens: Sequence[Floats]) -> tuple[Floats, float]:
    """The middle of the mean (n, 3), and an extent in which it and all specimens fit, turned as one likes."""
    middle = (mean.min(axis=0) + mean.max(axis=0)) / 2
    return middle, 2 * max(float(np.linalg.norm(one - middle, axis=1).max()) for one in (mean, *specimens))


def _plain(points: np.ndarray) -> list[float]:
    return [float(x) for x in np.round(points, DIGITS).ravel()]

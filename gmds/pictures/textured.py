"""A texture as colours of vertices: each face is cut into small ones, which take the colour of the image."""

from __future__ import annotations

from typing import Any

import numpy as np

from geodesics import Mesh, vertex_normals
from geodesics.arrays import Floats
from gmds.pictures.colours import MISSING
from gmds.pictures.software import Shot

SMALL_FACES = 150_000  # about so many in all, one or two pixels of a picture of the usual size each; set by hand
MOST_CUTS = 12  # of an edge, however few faces there are; set by hand


def textured(mesh: Mesh, uv: Floats, image: Any, view: Floats, pixels: int) -> Shot:
    """The mesh with an image (PIL) laid on it by texture coordinates (m, 3, 2) of corners; grey where one is NaN."""
    cuts = int(np.clip(round(np.sqrt(SMALL_FACES / max(mesh.n_faces, 1))), 1, MOST_CUTS))
    weights, small = _cut_triangle(cuts)
    places, normals = (np.einsum("kc,mcx->mkx", weights, x[mesh.faces]) for x in (mesh.vertices, vertex_normals(mesh)))
    spots = np.einsum("kc,mcx->mkx", weights, uv).reshape(-1, 2)
    faces = (len(weights) * np.arange(mesh.n_faces)[:, None, None] + small).reshape(-1, 3)
    fine = Mesh(places.reshape(-1, 3), faces)
    length = np.linalg.norm(normals, axis=2, keepdims=True)
    smooth = (normals / np.where(length > 0, length, 1)).reshape(-1, 3)
    return Shot(fine, _colours_at(spots, image), view, pixels, smooth=smooth)


def _cut_triangle(cuts: int) -> tuple[Floats, Any]:
    """Barycentric weights (k, 3) of the corners of a triangle cut into cuts x cuts, and their faces."""
    rows = [(i, j) for i in range(cuts + 1) for j in range(cuts + 1 - i)]
    number = {place: k for k, place in enumerate(rows)}
    weights = np.array([(cuts - i - j, i, j) for i, j in rows], dtype=np.float64) / cuts
    upright = [(number[i, j], number[i + 1, j], number[i, j + 1]) for i, j in rows if i + j < cuts]
    turned = [(number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]) for i, j in rows if i + j < cuts - 1]
    return weights, np.array(upright + turned, dtype=np.int64)


def _colours_at(spots: Floats, image: Any) -> Floats:
    """Colours (k, 3) of the pixels at texture coordinates (k, 2), from the lower left; the image repeats."""
    pixels = np.asarray(image.convert("RGB"), dtype=np.float64) / 255
    height, width = pixels.shape[:2]
    known = np.asarray(np.isfinite(spots).all(axis=1))
    u, v = (np.where(known[:, None], spots, 0) % 1.0).T
    colours = pixels[((1 - v) * height).astype(np.int64) % height, (u * width).astype(np.int64) % width]
    colours[~known] = MISSING
    return np.asarray(colours)

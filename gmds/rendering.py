"""A small picture maker: triangles with vertex colours into an array of pixels, by a depth buffer."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geodesics import Mesh, vertex_normals

Array = NDArray[np.float64]


def view_rotation(azimuth: float, elevation: float) -> Array:
    """Rotation (3, 3) into camera axes right, up, towards the viewer; degrees, z of the mesh points up."""
    a, e = np.radians(azimuth), np.radians(elevation)
    towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    return np.stack([right, np.cross(towards, right), towards])


def render(
    mesh: Mesh, colours: Array, *, rotation: Array, pixels: int = 600, oversampling: int = 2, sharp: bool = False
) -> Array:
    """An image (height, width, 3) in [0, 1] on white of the mesh with vertex colours (n, 3), seen along `rotation`.

    Parallel projection, one light at the viewer's shoulder, faces lit from both sides; `pixels` is the longer side.
    `sharp` gives each pixel the colour of the nearest corner instead of a blend.
    """
    camera = mesh.vertices @ rotation.T
    low, high = camera[:, :2].min(0), camera[:, :2].max(0)
    fine = pixels * oversampling
    scale = 0.94 * fine / (high - low).max()
    width, height = (np.ceil((high - low) * scale / oversampling) * oversampling + 0.06 * fine).astype(int)
    width, height = width - width % oversampling, height - height % oversampling
    xy = (camera[:, :2] - (low + high) / 2) * scale * [1, -1] + [width / 2, height / 2]
    pixel, face, weights = _visible(xy, camera[:, 2], mesh.faces, int(width), int(height))
    normals = vertex_normals(mesh) @ rotation.T
    image = np.ones((height * width, 3))
    image[pixel] = _shade(mesh.faces[face], weights, colours, normals, sharp)
    return image.reshape(height // oversampling, oversampling, width // oversampling, oversampling, 3).mean(axis=(1, 3))


def _visible(xy: Array, depth: Array, faces: NDArray[np.int64], width: int, height: int) -> tuple[NDArray, ...]:
    """For every covered pixel its index, the frontmost face and barycentric weights there."""
    corners = xy[faces]
    first = np.floor(corners.min(axis=1) - 0.5).astype(int).clip(0)
    size = np.ceil(corners.max(axis=1) + 0.5).astype(int).clip(0, [width, height]) - first
    count = size.prod(axis=1)
    face = np.repeat(np.arange(len(faces)), count)
    step = np.arange(len(face)) - np.repeat(np.cumsum(count) - count, count)
    x, y = first[face, 0] + step % size[face, 0], first[face, 1] + step // size[face, 0]
    a, b, c = (corners[:, k] for k in range(3))
    determinant = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    px, py = x + 0.5 - a[face, 0], y + 0.5 - a[face, 1]
    safe = np.where(determinant == 0, 1, determinant)  # edge-on faces cover no pixel
    v = (px * (c - a)[face, 1] - py * (c - a)[face, 0]) / safe[face]
    w = (py * (b - a)[face, 0] - px * (b - a)[face, 1]) / safe[face]
    weights = np.stack([1 - v - w, v, w], axis=1)
    inside = np.flatnonzero((weights >= -1e-9).all(axis=1) & (determinant != 0)[face])
    face, weights, pixel = face[inside], weights[inside], (y * width + x)[inside]
    order = np.lexsort(((weights * depth[faces[face]]).sum(axis=1), pixel))
    last = order[np.append(np.flatnonzero(np.diff(pixel[order])), len(order) - 1)] if len(order) else order
    return pixel[last], face[last], weights[last]


def _shade(corners: NDArray[np.int64], weights: Array, colours: Array, normals: Array, sharp: bool) -> Array:
    normal = (weights[:, :, None] * normals[corners]).sum(axis=1)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    light = np.array([-0.35, 0.45, 0.82])
    diffuse = np.abs(normal @ (light / np.linalg.norm(light)))
    weights = np.eye(3)[weights.argmax(axis=1)] if sharp else weights
    base = (weights[:, :, None] * colours[corners]).sum(axis=1)
    return np.clip(base * (0.45 + 0.58 * diffuse)[:, None], 0, 1)

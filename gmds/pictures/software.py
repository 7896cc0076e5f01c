"""A small picture maker: triangles with vertex colours into arrays of pixels, by a depth buffer."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from geodesics import Mesh, vertex_normals
from geodesics.arrays import Floats, Integers

OVERSAMPLING = 2  # pixels across for each that is kept, so that edges are not ragged; set by hand


def view_rotation(azimuth: float, elevation: float) -> Floats:
    """Rotation (3, 3) into camera axes right, up, towards the viewer; degrees, z of the mesh points up."""
    a, e = np.radians(azimuth), np.radians(elevation)
    towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    return np.stack([right, np.cross(towards, right), towards])


@dataclass(frozen=True, eq=False)
class Frame:
    """Where vertices are in an image of `width` x `height` pixels: xy (n, 2) from its upper left corner, depth (n,).

    Depth grows towards the viewer, and is in pixels as well.
    """

    xy: Floats
    depth: Floats
    width: int
    height: int


@dataclass(frozen=True, eq=False)
class Shot:
    """A mesh to be drawn, and from where.

    Parameters
    ----------
    mesh : Mesh
        Of n vertices.
    colours : array of shape (n, 3)
        Of vertices, sRGB in [0, 1].
    rotation : array of shape (3, 3)
        Rows right, up and towards the viewer in the coordinates of the mesh, as `gmds.pictures.camera` makes it.
    pixels : int
        The longer side of the image.
    sharp : bool
        Gives each place the colour of the nearest corner instead of a blend.
    smooth : array of shape (n, 3), optional
        Unit normals of the vertices, where the mesh is cut so that its own would show every face.
    """

    mesh: Mesh
    colours: Floats
    rotation: Floats
    pixels: int = 600
    sharp: bool = False
    smooth: Floats | None = None

    def frame(self, oversampling: int, places: Floats | None = None) -> Frame:
        """The image with so many times the pixels across: parallel projection, a margin of 3 % around the faces.

        What it says of vertices it says of `places` (k, 3) instead, where these are given.
        """
        used = np.unique(self.mesh.faces)
        camera = self.mesh.vertices @ self.rotation.T
        low, high = camera[used].min(axis=0), camera[used].max(axis=0)
        fine = self.pixels * oversampling
        scale = 0.94 * fine / (high - low)[:2].max()
        size = (np.ceil((high - low)[:2] * scale / oversampling) * oversampling + 0.06 * fine).astype(int)
        width, height = (size - size % oversampling).tolist()
        center = (low + high) / 2
        drawn = camera if places is None else places @ self.rotation.T
        xy = (drawn[:, :2] - center[:2]) * scale * [1, -1] + [width / 2, height / 2]
        return Frame(xy, (drawn[:, 2] - center[2]) * scale, width, height)

    @cached_property
    def normals(self) -> Floats:
        """Unit normals (n, 3) of the vertices as the camera sees them."""
        return np.asarray(
            (vertex_normals(self.mesh) if self.smooth is None else self.smooth) @ self.rotation.T, dtype=np.float64
        )


def software(shots: Sequence[Shot]) -> list[Floats]:
    """Draw by a depth buffer of our own, on any machine; one light at the viewer's shoulder, faces lit from both sides.

    Parameters
    ----------
    shots : sequence of Shot
        What is to be drawn.

    Returns
    -------
    list of arrays of shape (height, width, 3)
        Images in [0, 1], on white.

    See Also
    --------
    offscreen : By pyvista, where that can draw.
    """
    return [_drawn(shot, OVERSAMPLING) for shot in shots]


def _drawn(shot: Shot, oversampling: int) -> Floats:
    frame, faces = shot.frame(oversampling), shot.mesh.faces
    pixel, face, weights = _visible(frame.xy, frame.depth, faces, frame.width, frame.height)
    image = np.ones((frame.height * frame.width, 3))
    image[pixel] = _shade(faces[face], weights, shot.colours, shot.normals, shot.sharp)
    return averaged(image.reshape(frame.height, frame.width, 3), oversampling)


def render(
    mesh: Mesh, colours: Floats, *, rotation: Floats, pixels: int = 600, oversampling: int = 2, sharp: bool = False
) -> Floats:
    """One image (height, width, 3) in [0, 1] by `software`, of what `Shot` says."""
    return _drawn(Shot(mesh, colours, rotation, pixels, sharp), oversampling)


def averaged(image: Floats, block: int) -> Floats:
    """An image with every block of pixels made one."""
    height, width = image.shape[0] // block, image.shape[1] // block
    return image.reshape(height, block, width, block, 3).mean(axis=(1, 3))


def _visible(xy: Floats, depth: Floats, faces: Integers, width: int, height: int) -> tuple[NDArray, ...]:
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


def _shade(corners: Integers, weights: Floats, colours: Floats, normals: Floats, sharp: bool) -> Floats:
    normal = (weights[:, :, None] * normals[corners]).sum(axis=1)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    light = np.array([-0.35, 0.45, 0.82])
    diffuse = np.abs(normal @ (light / np.linalg.norm(light)))
    weights = np.eye(3)[weights.argmax(axis=1)] if sharp else weights
    base = (weights[:, :, None] * colours[corners]).sum(axis=1)
    return np.clip(base * (0.45 + 0.58 * diffuse)[:, None], 0, 1)

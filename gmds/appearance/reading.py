"""Vertex colours, texture coordinates and the image of a mesh file."""

from __future__ import annotations

import io
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geodesics import Mesh
from geodesics.arrays import Floats
from geodesics.errors import FormatError, MissingExtra
from geodesics.extras import how_to_install
from geodesics.io.opening import read_bytes
from geodesics.io.sniffing import sniff

KINDS = ("obj", "ply", "glb")


class BadLook(FormatError):
    """A file whose colours or texture cannot be used."""

    code = "E217"


@dataclass(frozen=True, eq=False)
class Look:
    """How a mesh of n vertices and m faces looks.

    Parameters
    ----------
    colours : array of shape (n, 3) or (n, 4), optional
        Red, green, blue and perhaps opacity of each vertex, uint8.
    uv : array of shape (m, 3, 2), optional
        Texture coordinates of the corners of faces, from (0, 0) at the lower left of the image to (1, 1).
    image : PIL.Image, optional
        What the coordinates lay on the surface.
    """

    colours: NDArray[np.uint8] | None = None
    uv: Floats | None = None
    image: Any = None


def read_look(path: Path, mesh: Mesh, texture: Path | None = None) -> Look:
    """The colours or the texture of a mesh file.

    Parameters
    ----------
    path : Path
        OBJ, PLY or GLB; other files have no look. No file is opened that was not named: materials of an OBJ are not
        followed.
    mesh : Mesh
        What was read from it.
    texture : Path, optional
        The image that its texture coordinates belong to. A GLB has its own inside.

    Returns
    -------
    Look
        Texture coordinates where there are some, else colours, else nothing.

    Raises
    ------
    BadLook
        E217, where faces are in another order than in the file, as with several materials, or for an image that cannot
        be read.
    MissingExtra
        E602, without Pillow.

    See Also
    --------
    carry_uv : Texture coordinates along a map.
    write_look : The mesh with its look.
    """
    data = read_bytes(path)
    kind = sniff(data, path)
    if kind not in KINDS:
        return Look()
    loaded = _loaded(data, kind, path)
    corners = loaded.vertices[loaded.faces]
    near = 1e-6 * np.abs(mesh.vertices).max()  # single precision has 24 bits, 6e-8
    if corners.shape != (mesh.n_faces, 3, 3) or np.abs(corners - mesh.vertices[mesh.faces]).max() > near:
        raise BadLook(
            f"{path}: its faces are not those of the mesh, as those of several parts, of several materials, or of more "
            "than three corners; join the parts, triangulate, and save it again"
        )
    visual = loaded.visual
    if getattr(visual, "uv", None) is not None:
        image = _image_inside(visual) if kind == "glb" else None
        image = image if texture is None else _image(texture)
        return Look(None, np.asarray(visual.uv, dtype=np.float64)[loaded.faces], image)
    if visual.kind == "vertex":
        colours = np.full((mesh.n_vertices, 4), 255, dtype=np.uint8)
        colours[mesh.faces] = np.asarray(visual.vertex_colors, dtype=np.uint8)[loaded.faces]
        return Look(colours if (colours[:, 3] < 255).any() else colours[:, :3])
    return Look()


def _loaded(data: bytes, kind: str, path: Path) -> Any:
    import trimesh

    try:
        loaded = trimesh.load(io.BytesIO(data), file_type=kind, process=False)
    except Exception as error:  # whatever a reader of others raises on what it does not know
        raise BadLook(f"{path}: its colours cannot be read ({type(error).__name__}: {error})") from error
    if isinstance(loaded, trimesh.Scene):
        loaded = loaded.to_geometry()
    return loaded


def _image_inside(visual: Any) -> Any:
    material = getattr(visual, "material", None)
    return getattr(material, "baseColorTexture", None) or getattr(material, "image", None)


def _image(path: Path) -> Any:
    try:
        from PIL import Image
    except ImportError as error:
        raise MissingExtra(f"textures need Pillow; install it with: {how_to_install('viz')}") from error
    data = read_bytes(path)
    try:
        image = Image.open(io.BytesIO(data))
        image.load()
    except Exception as error:  # of a dozen decoders, each with its own
        raise BadLook(f"{path} is no image that can be read ({type(error).__name__}: {error})") from error
    return image

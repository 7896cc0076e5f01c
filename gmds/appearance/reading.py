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
from geodesics.io.contents import Contents
from geodesics.io.opening import read_bytes
from geodesics.io.sniffing import sniff
from gmds.appearance.names import FaceNames
from gmds.appearance.surfaces import Shown, shown

KINDS = ("obj", "ply", "glb", "gltf")


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
    notes : tuple of str
        What of the file is not kept.
    names : FaceNames, optional
        Objects, groups and materials, by face.
    """

    colours: NDArray[np.uint8] | None = None
    uv: Floats | None = None
    image: Any = None
    notes: tuple[str, ...] = ()
    names: FaceNames | None = None


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
        E217, where the faces of the file are not those of the mesh, or for an image that cannot be read.
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
    found = _found(data, kind, path)
    contents = found.contents
    refuse_other_faces(contents, mesh, path)
    notes: tuple[str, ...] = ()
    if len(found.materials) > 1 and found.uv is not None:
        named = ", ".join(found.materials[:5])
        notes = (f"{path} has {len(found.materials)} materials ({named}), which get one image",)
    if found.uv is not None:
        return Look(None, found.uv, found.image if texture is None else _image(texture), notes, found.names)
    if found.colours is not None:
        colours = np.full((mesh.n_vertices, found.colours.shape[1]), 255, dtype=np.uint8)
        colours[mesh.faces] = found.colours[contents.triangles]
        transparent = colours.shape[1] == 4 and bool((colours[:, 3] < 255).any())
        return Look(colours if transparent else colours[:, :3], names=found.names)
    return Look(names=found.names)


def refuse_other_faces(contents: Contents, mesh: Mesh, path: Path) -> None:
    """`BadLook` where the faces of a file do not lie where those of a mesh do, one by one."""
    corners = contents.vertices[contents.triangles]
    near = 1e-6 * np.abs(mesh.vertices).max()  # single precision has 24 bits, 6e-8
    if corners.shape != (mesh.n_faces, 3, 3):
        raise BadLook(
            f"{path}: its faces are {len(corners)}, those of the mesh {mesh.n_faces}; give a file of the same faces"
        )
    if not np.abs(corners - mesh.vertices[mesh.faces]).max() <= near:
        raise BadLook(f"{path}: its faces lie elsewhere, or in another order, than those of the mesh")


def _found(data: bytes, kind: str, path: Path) -> Shown:
    try:
        with np.errstate(invalid="ignore"):  # as where meshes are read
            return shown(data, kind, path)
    except (KeyError, IndexError, TypeError, AttributeError, OverflowError, ValueError) as error:
        if hasattr(error, "code"):
            raise
        raise BadLook(f"{path}: its colours cannot be read ({type(error).__name__}: {error})") from error


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

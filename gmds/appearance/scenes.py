"""Colours, texture coordinates and images of a glTF scene, for the mesh that its parts are joined into."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geodesics.arrays import Floats
from geodesics.io.contents import Contents
from geodesics.io.glb import drawn, read_glb
from geodesics.io.gltf_accessor import read_accessor
from geodesics.io.gltf_container import Gltf, open_gltf
from geodesics.io.gltf_nodes import placed_meshes

Found = tuple[Contents, NDArray[np.uint8] | None, Floats | None, Any, tuple[str, ...]]


def scene_look(data: bytes, path: Path) -> Found:
    """Contents, colours (n, 4), texture coordinates (m, 3, 2), the image of the first that has one, and materials."""
    contents = read_glb(data, path)
    gltf = open_gltf(data, path)
    pieces = [each for place in placed_meshes(gltf) for each in drawn(place)]
    colours = np.full((len(contents.vertices), 4), 255, dtype=np.uint8)
    uv = np.zeros((len(contents.triangles), 3, 2))
    coloured, textured, image = False, False, None
    for part, piece in zip(contents.parts, pieces, strict=True):
        if "COLOR_0" in piece["attributes"]:
            colours[part.vertices.start : part.vertices.stop] = colours_of(gltf, piece)
            coloured = True
        texture = _texture(gltf, piece)
        moved = texture.get("extensions", {}).get("KHR_texture_transform", {})
        name = f"TEXCOORD_{moved.get('texCoord', texture.get('texCoord', 0))}"
        if name in piece["attributes"]:
            rows = slice(part.faces.start, part.faces.stop)
            places = _transformed(coordinates_of(gltf, piece, name), moved) * (1, -1) + (0, 1)  # v goes down
            uv[rows] = places[contents.triangles[rows] - part.vertices.start]
            textured = True
            image = _image(gltf, texture) if image is None else image
    materials = tuple(dict.fromkeys(part.material for part in contents.parts if part.material))
    if textured and np.isfinite(uv).all():
        return contents, None, uv, image, materials
    return contents, colours if coloured else None, None, None, materials


def coordinates_of(gltf: Gltf, piece: dict[str, Any], name: str) -> Floats:
    """Texture coordinates (n, 2) of a primitive, as they are in the file: v goes down."""
    values = read_accessor(gltf, piece["attributes"][name], "VEC2")
    quantised = "KHR_mesh_quantization" in gltf.tree.get("extensionsUsed", [])
    return np.asarray(values, dtype=np.float64) if quantised else _fractions(values)


def colours_of(gltf: Gltf, piece: dict[str, Any]) -> NDArray[np.uint8]:
    """Colours (n, 4) of the vertices of a primitive."""
    index = piece["attributes"]["COLOR_0"]
    values = _fractions(read_accessor(gltf, index, gltf.item("accessors", index)["type"]))
    colours = np.full((len(values), 4), 255, dtype=np.uint8)
    colours[:, : values.shape[1]] = np.rint(255 * np.clip(np.nan_to_num(values), 0, 1))
    return colours


def _transformed(uv: Floats, moved: dict[str, Any]) -> Floats:
    """Coordinates scaled, turned and moved as KHR_texture_transform says."""
    turn = float(moved.get("rotation", 0))
    rotation = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    scale, offset = (np.array(moved.get(name, [least] * 2), float) for name, least in (("scale", 1), ("offset", 0)))
    return np.asarray((uv * scale) @ rotation.T + offset, dtype=np.float64)


def _fractions(values: NDArray[Any]) -> Floats:
    """Numbers from 0 to 1, also where integers lack the word that they are meant as fractions."""
    scale = np.iinfo(values.dtype).max if values.dtype.kind in "iu" else 1
    return np.asarray(values.astype(np.float64) / scale)


def _texture(gltf: Gltf, piece: dict[str, Any]) -> dict[str, Any]:
    """The reference to the texture of a primitive's colour."""
    if "material" not in piece:
        return {}
    about = gltf.item("materials", piece["material"]).get("pbrMetallicRoughness", {})
    return dict(about.get("baseColorTexture", {}))


def _image(gltf: Gltf, texture: dict[str, Any]) -> Any:
    """The image, from within the file; None where it is in another or in a format that is not known."""
    if "index" not in texture:
        return None
    source = gltf.item("textures", texture["index"]).get("source")
    about = gltf.item("images", source) if source is not None else {}
    if "bufferView" not in about:
        return None
    content, _ = gltf.bytes_of_view(about["bufferView"], f"image {source}")
    try:
        from PIL import Image

        image = Image.open(io.BytesIO(content))
        image.load()
    except Exception:  # of a dozen decoders, each with its own; a picture that is none is no picture
        return None
    return image

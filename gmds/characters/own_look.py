"""A character that keeps its own look: parts, materials and textures of its own file, on the bones of another one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from geodesics.arrays import Floats
from geodesics.io.gltf_container import open_gltf
from geodesics.io.gltf_nodes import Placed
from geodesics.io.opening import read_bytes
from geodesics.io.sniffing import sniff
from gmds.characters.scene import Scene


def has_look(path: Path) -> bool:
    """Whether a file is a GLB or glTF file with materials, or with colours of vertices."""
    data = read_bytes(path)
    if sniff(data, path) not in ("glb", "gltf"):
        return False
    tree = open_gltf(data, path).tree
    primitives = [each for mesh in tree.get("meshes", []) for each in mesh["primitives"]]
    return bool(tree.get("materials")) or any("COLOR_0" in each["attributes"] for each in primitives)


def dressed(scene: Scene, own: Scene) -> Scene:
    """The bones of a scene, and the parts, materials, texture coordinates and colours of another one.

    Every part has all shapes to morph to, one place of the scene after the other.
    """
    names = [name for place in scene.places for name in _shape_names(scene, place)]
    weights = [weight for place in scene.places for weight in _shape_weights(scene, place)]
    skin = next((place.skin for place in scene.places if place.skin is not None), None)
    about = [(place, _named(place.mesh, names)) for place in own.places]
    places = [replace(place, mesh=mesh, node=None, weights=weights, skin=skin) for place, mesh in about]
    coordinates, colours = own.coordinates, own.colours
    return replace(scene, places=places, pieces=own.pieces, coordinates=coordinates, colours=colours, look=own.gltf)


def on_every_part(shapes: dict[int, Floats], own: Scene) -> dict[int, Floats]:
    """Displacements (k, n, 3) by place of `dressed`: those of all places of the scene, in a row."""
    everything = [shapes[place] for place in sorted(shapes)]
    return {place: np.concatenate(everything) for place in range(len(own.places))} if everything else {}


def _shape_names(scene: Scene, place: Placed) -> list[str]:
    count = len(scene.shapes.get(scene.places.index(place), ()))
    given = place.mesh.get("extras", {}).get("targetNames", [])
    return [*given[:count], *(f"{place.name} {k}" for k in range(len(given[:count]), count))]


def _shape_weights(scene: Scene, place: Placed) -> list[float]:
    count = len(scene.shapes.get(scene.places.index(place), ()))
    return [*place.weights[:count], *[0.0] * (count - len(place.weights[:count]))]


def _named(mesh: dict[str, Any], names: list[str]) -> dict[str, Any]:
    """The description of a mesh, its shapes called so."""
    extras = {key: value for key, value in mesh.get("extras", {}).items() if key != "targetNames"}
    extras |= {"targetNames": names} if names else {}
    return {key: value for key, value in mesh.items() if key != "extras"} | ({"extras": extras} if extras else {})

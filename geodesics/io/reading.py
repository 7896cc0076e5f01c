"""From a path to contents: the reader that the content asks for."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import numpy as np

from geodesics.arrays import Floats
from geodesics.errors import BadPolygon, Note
from geodesics.io.contents import Contents
from geodesics.io.glb import read_glb
from geodesics.io.neuro import read_freesurfer, read_freesurfer_ascii, read_gifti
from geodesics.io.obj import read_obj
from geodesics.io.off import read_off
from geodesics.io.opening import read_bytes
from geodesics.io.ply import read_ply
from geodesics.io.sniffing import sniff
from geodesics.io.stl import read_stl
from geodesics.io.tosca import read_tosca, tosca_paths
from geodesics.io.vtk import read_vtk
from geodesics.io.vtp import read_vtp

_READERS: dict[str, Callable[[bytes, Path], Contents]] = {
    "off": read_off,
    "obj": read_obj,
    "ply": read_ply,
    "stl": read_stl,
    "glb": read_glb,
    "gltf": read_glb,
    "vtk": read_vtk,
    "vtp": read_vtp,
    "gifti": read_gifti,
    "freesurfer": read_freesurfer,
    "freesurfer ascii": read_freesurfer_ascii,
    "tosca": lambda data, path: read_tosca(path),
}


def contents_of(path: str | os.PathLike[str]) -> Contents:
    """What the file of that name holds."""
    path = Path(path)
    if not path.exists() and tosca_paths(path)[0].exists():
        return read_tosca(path)
    data = read_bytes(path)
    try:
        with np.errstate(invalid="ignore"):  # a NaN that signals stays one in double precision, and is refused later
            return _READERS[sniff(data, path)](data, path)
    except BadPolygon as error:
        if not error.args[0].startswith("face "):
            raise
        raise BadPolygon(f"{path}: {error.args[0]}") from error  # from where no file is known


def with_positions(contents: Contents) -> tuple[Floats, list[Note]]:
    """Vertices, those without a position that no face needs put in the middle of those that faces have."""
    vertices = contents.vertices
    lost = np.asarray(~np.isfinite(vertices).all(axis=1))
    lost[contents.triangles] = False
    if not lost.any() or not len(contents.triangles):
        return vertices, []
    used = np.unique(contents.triangles)
    vertices = vertices.copy()
    with np.errstate(all="ignore"):  # a corner that is infinite is refused as a mesh
        vertices[lost] = np.nan_to_num(vertices[used].mean(axis=0), posinf=0.0, neginf=0.0)
    where = np.flatnonzero(lost)
    message = f"{len(where)} vertices on no face have no finite position and were put in the middle of the others"
    return vertices, [Note("W221", "warning", message, tuple(where[:10].tolist()), len(where))]

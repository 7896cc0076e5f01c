"""Reading and writing mesh files; strict, atomic, and without changing the order of anything.

| code | says |
|---|---|
| W210 | faces of more than three corners were split into triangles |
| W211 | the triangles of an STL file, which stand alone, were joined where corners are at exactly the same position |
"""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from geodesics.errors import MeshError, Note
from geodesics.io.atomic import atomic_write
from geodesics.io.glb import read_glb
from geodesics.io.obj import read_obj
from geodesics.io.off import read_off
from geodesics.io.opening import read_bytes, sniff
from geodesics.io.ply import read_ply
from geodesics.io.stl import read_stl
from geodesics.io.text import Contents
from geodesics.io.tosca import read_tosca, tosca_paths
from geodesics.io.writing import encode
from geodesics.mesh import Mesh

__all__ = ["atomic_write", "read_mesh", "read_with_notes", "write_mesh"]

_READERS: dict[str, Callable[[bytes, Path], Contents]] = {
    "off": read_off,
    "obj": read_obj,
    "ply": read_ply,
    "stl": read_stl,
    "glb": read_glb,
    "tosca": lambda data, path: read_tosca(path),
}


def read_mesh(path: str | os.PathLike[str]) -> Mesh:
    """Read a mesh from a file, vertices in the order of the file.

    The content decides the format, not the name. Larger polygons are split into triangles, and corners of an STL file
    at equal positions are welded; `read_with_notes` reports it. No other file is ever opened.

    Parameters
    ----------
    path : str or path
        An OFF, OBJ, PLY, STL or GLB file; of a TOSCA shape the .vert file, the .tri file, or their common stem.

    Returns
    -------
    Mesh
        In the unit of the file.

    Raises
    ------
    FormatError
        E201 - E209 and E222, naming the file and line.
    MeshError
        Where the content is no triangle mesh, naming the file.
    OSError
        When the path cannot be opened.

    See Also
    --------
    read_with_notes : With notes on what was changed.
    write_mesh : The inverse.
    """
    return read_with_notes(path)[0]


def read_with_notes(path: str | os.PathLike[str]) -> tuple[Mesh, list[Note]]:
    """Read a mesh from a file, with notes on what had to be changed.

    Parameters
    ----------
    path : str or path
        As of `read_mesh`.

    Returns
    -------
    mesh : Mesh
        In the unit of the file.
    notes : list of Note
        Split polygons (W210), welded corners (W211).

    Raises
    ------
    FormatError, MeshError, OSError
        As `read_mesh` does.
    """
    path = Path(path)
    if not path.exists() and tosca_paths(path)[0].exists():
        contents = read_tosca(path)
    else:
        data = read_bytes(path)
        contents = _READERS[sniff(data, path)](data, path)
    try:
        return Mesh(contents.vertices, contents.triangles), contents.notes
    except MeshError as error:
        raise type(error)(f"{path}: {error.args[0]}") from error


def write_mesh(mesh: Mesh, path: str | os.PathLike[str]) -> None:
    """Write a mesh in the format of the suffix. Each file is complete or untouched.

    OFF, OBJ, PLY and TOSCA keep every bit; STL and GLB are single precision.

    Parameters
    ----------
    mesh : Mesh or mesh object
        The mesh, or one of trimesh, pyvista, meshio or Open3D.
    path : str or path
        Ending in .off, .obj, .ply, .stl, .glb, .vert or .tri (either of these two writes both files).

    Raises
    ------
    FormatError
        E203 for another suffix.
    MeshError
        E102 when coordinates do not fit into single precision.
    OSError
        When the file cannot be written.

    See Also
    --------
    read_mesh : The inverse.
    """
    path = Path(path)
    for suffix, data in encode(Mesh.from_object(mesh), path.suffix.lower()).items():
        written_as = path.with_suffix(suffix.upper() if path.suffix.isupper() else suffix)
        with atomic_write(written_as) as stream:
            stream.write(data)

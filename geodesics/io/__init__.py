"""Reading and writing mesh files; strict, atomic, and without changing the order of anything.

| code | says |
|---|---|
| W210 | faces of more than three corners were split into triangles |
| W211 | the triangles of an STL file, which stand alone, were joined where corners are at exactly the same position |
| W220 | there is more in the file than it declares, which was passed over |
| W221 | vertices on no face that have no position, or an infinite one, were put in the middle of the others |
| W222 | parts that the file keeps apart were joined into one mesh |
| W223 | parts of points or lines, and faces of fewer than three corners, were passed over |
| W224 | single precision, which the format has, moves vertices |
| W227 | an STL file of text lacks its last line, and may be cut off |
"""

from __future__ import annotations

import gzip
import os
from pathlib import Path

from geodesics.errors import MeshError, Note, UnknownFormat
from geodesics.io.atomic import atomic_write
from geodesics.io.contents import Part
from geodesics.io.opening import unpacked_name
from geodesics.io.precision import rounding_notes
from geodesics.io.reading import contents_of, with_positions
from geodesics.io.writing import encode
from geodesics.mesh import Mesh

__all__ = ["Part", "atomic_write", "read_mesh", "read_parts", "read_with_notes", "write_mesh"]


def read_mesh(path: str | os.PathLike[str]) -> Mesh:
    """Read a mesh from a file, vertices in the order of the file.

    The content decides the format, not the name; a file packed by gzip is unpacked. Larger polygons are split into
    triangles, corners of an STL file at equal positions are welded, and the meshes of a glTF scene are joined;
    `read_with_notes` reports it, `read_parts` says which was which. No other file is ever opened.

    Parameters
    ----------
    path : str or path
        An OFF, OBJ, PLY, STL, GLB, glTF, VTK (legacy), VTP, GIFTI or FreeSurfer file; of a TOSCA shape the .vert file,
        the .tri file, or their common stem. GIFTI and FreeSurfer need the extra `neuro`.

    Returns
    -------
    Mesh
        In the unit of the file.

    Raises
    ------
    FormatError
        E201 - E209, E221 and E222, naming the file and line.
    MeshError
        Where the content is no triangle mesh, naming the file.
    OSError
        When the path cannot be opened.

    See Also
    --------
    read_with_notes : With notes on what was changed.
    write_mesh : The inverse.

    Examples
    --------
    >>> import geodesics
    >>> triangle = geodesics.Mesh([[0, 0, 0], [3, 0, 0], [0, 4, 0]], [[0, 1, 2]])
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = geodesics.write_mesh(triangle, f'{folder}/triangle.ply')
    ...     again = geodesics.read_mesh(f'{folder}/triangle.ply')
    >>> again.faces.tolist()
    [[0, 1, 2]]
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
        W210 and above: split polygons, welded corners, what the file has more or otherwise than it should.

    Raises
    ------
    FormatError, MeshError, OSError
        As `read_mesh` does.

    Examples
    --------
    >>> import geodesics
    >>> triangle = geodesics.Mesh([[0, 0, 0], [3, 0, 0], [0, 4, 0]], [[0, 1, 2]])
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = geodesics.write_mesh(triangle, f'{folder}/triangle.off')
    ...     mesh, notes = geodesics.read_with_notes(f'{folder}/triangle.off')
    >>> mesh.n_faces, notes
    (1, [])
    """
    contents, path = contents_of(path), Path(path)
    try:
        vertices, notes = with_positions(contents)
        return Mesh(vertices, contents.triangles), [*contents.notes, *notes]
    except MeshError as error:
        raise type(error)(f"{path}: {error.args[0]}") from error


def read_parts(path: str | os.PathLike[str]) -> list[Part]:
    """Which vertices and faces of a mesh come from which part of its file.

    Parameters
    ----------
    path : str or path
        As of `read_mesh`.

    Returns
    -------
    list of Part
        Name, material, and the ranges of vertices and faces of every primitive of a glTF scene; empty where the file
        is of one piece.

    Raises
    ------
    FormatError, MeshError, OSError
        As `read_mesh` does.
    """
    parts = contents_of(path).parts
    return parts if len(parts) > 1 else []


def write_mesh(mesh: Mesh, path: str | os.PathLike[str]) -> list[Note]:
    """Write a mesh in the format of the suffix. Each file is complete or untouched.

    OFF, OBJ, PLY, VTP and TOSCA keep every bit; STL and GLB are single precision. A mesh that lies far from the origin
    is written to GLB around the origin, with its place in the node.

    Parameters
    ----------
    mesh : Mesh or mesh object
        The mesh, or one of trimesh, pyvista, meshio or Open3D.
    path : str or path
        Ending in .off, .obj, .ply, .stl, .glb, .vtp, .vert or .tri (either of the last two writes both files), and
        perhaps .gz behind it.

    Returns
    -------
    list of Note
        W224 where single precision moves vertices by more than the shape can bear.

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

    Examples
    --------
    >>> import geodesics
    >>> triangle = geodesics.Mesh([[0, 0, 0], [3, 0, 0], [0, 4, 0]], [[0, 1, 2]])
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     notes = geodesics.write_mesh(triangle, f'{folder}/triangle.obj')
    >>> notes  # nothing was lost
    []
    """
    if not isinstance(path, (str, os.PathLike)):
        raise TypeError(f"a path is expected after the mesh, not {type(path).__name__}: write_mesh(mesh, path)")
    path, mesh = Path(path), Mesh.from_object(mesh)
    named = unpacked_name(path)
    if named != path and named.suffix.lower() in (".vert", ".tri"):
        raise UnknownFormat(f"{path}: the two files of TOSCA are not written packed")
    for suffix, data in encode(mesh, named.suffix.lower()).items():
        written_as = named.with_suffix(suffix.upper() if named.suffix.isupper() else suffix)
        with atomic_write(written_as if named == path else path) as stream:
            stream.write(data if named == path else gzip.compress(data, mtime=0))
    return rounding_notes(mesh, named.suffix.lower())

"""Landmarks of one surface in files: named points, in the formats in which people keep them.

| ending | what it holds | names | frame |
|---|---|---|---|
| `.csv` | `name,x,y,z`, `x,y,z`, `name,vertex` or `vertex` (from 0) a line; a header may order them | yes | by header |
| | or, below this header, `name,face,w0,w1,w2`: a face (from 0) and barycentric weights | | |
| | or, of several specimens, a column `specimen`, or a row a specimen as MorphoJ has it (read) | no | - |
| `.mrk.json`, `.json` | 3D Slicer markups, schema 1.x: the control points of every list; | yes | LPS or RAS |
| | curves stay curves, and excluded points (not selected) excluded | | |
| `.fcsv` | 3D Slicer fiducials, 4.x and 5.x | yes | LPS or RAS |
| `.tps` | specimens of `LM3=` landmarks; `SCALE` multiplies, points of curves follow; one is written | no | - |
| `.pts` | `x y z` or `name x y z` a line, alone or below the header of IDAV Landmark or ibug (`version: 1`) | yes | - |
| `.pp` | points picked in MeshLab | yes | - |
| `.vts` | a vertex a line, from 1 as its publishers count | no | - |
| `.xyz`, `.txt`, `.particles` | `x y z` a line, perhaps with a name, or a table; read | yes | - |
| `.nts`, `.dta` | a matrix of NTSYS, `DIM=3`; read | yes | - |
| `.landmarkAscii` | a landmark set of Avizo or Amira; read | no | - |

A landmark without a place keeps its row: `NA` in .csv, .tps, .pts and .vts, undefined or missing in .mrk.json, not
active in .pp. Decimal commas are read where nothing else can be meant. Of a file with several specimens one is named.

Frames: LPS has x to the left and y to the back of a patient, RAS the opposite of both, and z up in both, so one
becomes the other when x and y change sign. Only a file of 3D Slicer, or a .csv with the header l,p,s or r,a,s, says
which it uses; meshes do not. `space` is the frame of the mesh: LPS unless said otherwise, as 3D Slicer has written
meshes since 4.11. Points of the other frame are turned into it; a file that does not say is taken as it is.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from gmds.landmarks.files.avizo import parse_avizo
from gmds.landmarks.files.named_points import SPACES, BadLandmarkFile, Landmarks, Space
from gmds.landmarks.files.named_points import Specimens as Specimens
from gmds.landmarks.files.nts import parse_nts
from gmds.landmarks.files.pairing import paired
from gmds.landmarks.files.picked import parse_pp, pp_text
from gmds.landmarks.files.plain import parse_points, parse_pts, parse_vts, pts_text, vts_text
from gmds.landmarks.files.reading import landmark_text
from gmds.landmarks.files.slicer import fcsv_text, mrk_text, parse_fcsv, parse_mrk
from gmds.landmarks.files.specimens import only
from gmds.landmarks.files.table import csv_text, parse_csv
from gmds.landmarks.files.tps import parse_tps, tps_text

__all__ = [
    "ENDINGS",
    "READ",
    "SPACES",
    "BadLandmarkFile",
    "Landmarks",
    "ending",
    "paired",
    "read_landmarks",
    "read_specimens",
    "write_landmarks",
]

Parser = Callable[[Path, str, Space], Landmarks | Specimens]
Writer = Callable[[Landmarks, Space, Mapping[str, Sequence[object]]], str]

_FORMATS: dict[str, tuple[Parser, Writer]] = {
    ".csv": (parse_csv, csv_text),
    ".mrk.json": (parse_mrk, mrk_text),
    ".json": (parse_mrk, mrk_text),
    ".fcsv": (parse_fcsv, fcsv_text),
    ".tps": (parse_tps, tps_text),
    ".pts": (parse_pts, pts_text),
    ".pp": (parse_pp, pp_text),
    ".vts": (parse_vts, vts_text),
}
_READ_ONLY: dict[str, Parser] = {
    ".xyz": parse_points,
    ".txt": parse_points,
    ".particles": parse_points,
    ".nts": parse_nts,
    ".dta": parse_nts,
    ".landmarkAscii": parse_avizo,
}
ENDINGS = tuple(_FORMATS)
READ = (*ENDINGS, *_READ_ONLY)


def ending(path: str | os.PathLike[str], among: Sequence[str] = ENDINGS) -> str:
    """The ending of a landmark file, one of those given. Raises `BadLandmarkFile` for any other."""
    name = Path(path).name.lower()
    for known in among:
        if name.endswith(known.lower()):
            return known
    if among is not READ and name.endswith(tuple(map(str.lower, READ))):
        raise BadLandmarkFile(f"{path}: this format is only read; landmarks are written to {', '.join(among)}")
    raise BadLandmarkFile(f"{path}: landmarks are kept in files that end in {', '.join(among)}")


def read_specimens(path: str | os.PathLike[str], space: Space = "LPS") -> Specimens:
    """All landmarks in a file, by the name of their specimen; of a file of one surface alone that name is empty.

    Parameters
    ----------
    path : path
        As `read_landmarks` takes it.
    space : {"LPS", "RAS"}
        The frame of the meshes.

    Returns
    -------
    dict of str to Landmarks
        In the order of the file.

    Raises
    ------
    BadLandmarkFile
        Naming the line or the control point (E306).
    OSError
        When it cannot be opened.

    See Also
    --------
    read_landmarks : Those of one surface.
    """
    kind = ending(path, READ)
    parse = _FORMATS[kind][0] if kind in _FORMATS else _READ_ONLY[kind]
    found = parse(Path(path), landmark_text(Path(path)), space)
    return {"": found} if isinstance(found, Landmarks) else found


def read_landmarks(path: str | os.PathLike[str], space: Space = "LPS", specimen: str | None = None) -> Landmarks:
    """The landmarks in a file; the ending says which format it is.

    Parameters
    ----------
    path : path
        Ends in .csv, .mrk.json, .json, .fcsv, .tps, .pts, .pp, .vts, .xyz, .txt, .particles, .nts, .dta or
        .landmarkAscii.
    space : {"LPS", "RAS"}
        The frame of the mesh, in which positions are given back.
    specimen : str, optional
        Whose landmarks, of a file that holds those of several.

    Returns
    -------
    Landmarks
        Named where the format has names.

    Raises
    ------
    BadLandmarkFile
        Naming the line or the control point, or the specimens when the file holds several (E306).
    OSError
        When it cannot be opened.

    See Also
    --------
    write_landmarks : The opposite.
    read_specimens : All of a file.
    paired : Which of two surfaces belong together.
    """
    return only(read_specimens(path, space), path, specimen)


def write_landmarks(
    path: str | os.PathLike[str],
    landmarks: Landmarks,
    space: Space = "LPS",
    columns: Mapping[str, Sequence[object]] | None = None,
) -> None:
    """Write landmarks, atomically, in the format the ending says.

    Parameters
    ----------
    path : path
        Ends in .csv, .mrk.json, .json, .fcsv, .tps, .pts, .pp or .vts.
    landmarks : Landmarks
        k of them.
    space : {"LPS", "RAS"}
        The frame they are in.
    columns : mapping of str to sequences, optional
        Further values, k each: columns of a .csv, the description in files of 3D Slicer, dropped elsewhere.

    Raises
    ------
    BadLandmarkFile
        When the format takes positions and there are vertices, or the reverse (E306).
    OSError
        When it cannot be written.

    See Also
    --------
    read_landmarks : The opposite.
    """
    from geodesics.io import atomic_write

    _, text = _FORMATS[ending(path)]
    content = text(landmarks, space, columns or {})
    with atomic_write(path) as stream:
        stream.write(content.encode("utf-8"))

"""Landmarks of one surface in files: named points, in the formats in which people keep them.

| ending | what it holds | names | frame |
|---|---|---|---|
| `.csv` | `name,x,y,z`, `x,y,z`, `name,vertex` or `vertex` (from 0) a line; a header may order them | yes | by header |
| | or, below this header, `name,face,w0,w1,w2`: a face (from 0) and barycentric weights | | |
| `.mrk.json` | 3D Slicer markups, schema 1.x: the control points of every list | yes | LPS or RAS |
| `.fcsv` | 3D Slicer fiducials, 4.x | yes | LPS or RAS |
| `.tps` | one specimen of `LM3=` landmarks, and no scale | no | - |
| `.pts` | `x y z` or `name x y z` a line, alone or below the header of IDAV Landmark or ibug (`version: 1`) | yes | - |
| `.vts` | a vertex a line, from 1 as its publishers count | no | - |

Frames: LPS has x to the left and y to the back of a patient, RAS the opposite of both, and z up in both, so one
becomes the other when x and y change sign. Only a file of 3D Slicer, or a .csv with the header l,p,s or r,a,s, says
which it uses; meshes do not. `space` is the frame of the mesh: LPS unless said otherwise, as 3D Slicer has written
meshes since 4.11. Points of the other frame are turned into it; a file that does not say is taken as it is.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from gmds.landmarks.files.named_points import SPACES, BadLandmarkFile, Landmarks, Space, paired
from gmds.landmarks.files.plain import parse_pts, parse_tps, parse_vts, pts_text, tps_text, vts_text
from gmds.landmarks.files.reading import landmark_text
from gmds.landmarks.files.slicer import fcsv_text, mrk_text, parse_fcsv, parse_mrk
from gmds.landmarks.files.table import csv_text, parse_csv

__all__ = ["ENDINGS", "SPACES", "BadLandmarkFile", "Landmarks", "ending", "paired", "read_landmarks", "write_landmarks"]

Parser = Callable[[Path, str, Space], Landmarks]
Writer = Callable[[Landmarks, Space, Mapping[str, Sequence[object]]], str]

_FORMATS: dict[str, tuple[Parser, Writer]] = {
    ".csv": (parse_csv, csv_text),
    ".mrk.json": (parse_mrk, mrk_text),
    ".fcsv": (parse_fcsv, fcsv_text),
    ".tps": (parse_tps, tps_text),
    ".pts": (parse_pts, pts_text),
    ".vts": (parse_vts, vts_text),
}
ENDINGS = tuple(_FORMATS)


def ending(path: str | os.PathLike[str]) -> str:
    """The ending of a landmark file, one of `ENDINGS`. Raises `BadLandmarkFile` for any other."""
    name = Path(path).name.lower()
    for known in ENDINGS:
        if name.endswith(known):
            return known
    raise BadLandmarkFile(f"{path}: landmarks are kept in files that end in {', '.join(ENDINGS)}")


def read_landmarks(path: str | os.PathLike[str], space: Space = "LPS") -> Landmarks:
    """The landmarks in a file; the ending says which format it is.

    Parameters
    ----------
    path : path
        Ends in .csv, .mrk.json, .fcsv, .tps, .pts or .vts.
    space : {"LPS", "RAS"}
        The frame of the mesh, in which positions are given back.

    Returns
    -------
    Landmarks
        Named where the format has names.

    Raises
    ------
    BadLandmarkFile
        Naming the line or the control point (E306).
    OSError
        When it cannot be opened.

    See Also
    --------
    write_landmarks : The opposite.
    paired : Which of two surfaces belong together.
    """
    parse, _ = _FORMATS[ending(path)]
    return parse(Path(path), landmark_text(Path(path)), space)


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
        Ends in .csv, .mrk.json, .fcsv, .tps, .pts or .vts.
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

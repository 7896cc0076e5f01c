"""Maps as tables for other programs: .csv for people and spreadsheets, .mat for MATLAB."""

from __future__ import annotations

import io
import os
from itertools import chain
from pathlib import Path

import numpy as np

from geodesics.errors import FormatError
from geodesics.io import atomic_write
from gmds.files.table import table_text
from gmds.maps.growth import growth_of
from gmds.maps.point_map import PointMap

ENDINGS = (".csv", ".mat")
COLUMNS = (
    "source_vertex",
    "target_vertex",
    "face",
    "weight_0",
    "weight_1",
    "weight_2",
    "x",
    "y",
    "z",
    "valid",
    "distortion",
    "confidence",
    "growth",
)


class UnknownExport(FormatError):
    """A file ending that maps cannot be exported to."""

    code = "E216"


def check_export(path: str | os.PathLike[str]) -> str:
    """The ending of the file, one of `ENDINGS`.

    Parameters
    ----------
    path : path
        Where a map is to be exported to.

    Returns
    -------
    str
        In small letters.

    Raises
    ------
    UnknownExport
        For any other ending (E216).
    """
    ending = Path(path).suffix.lower()
    if ending not in ENDINGS:
        raise UnknownExport(f"{path}: maps are exported to files that end in {' or '.join(ENDINGS)}")
    return ending


def export_map(answer: PointMap, path: str | os.PathLike[str]) -> None:
    """Write a map for other programs, atomically; the ending of the file says for which.

    .csv: a header and a row for every source vertex, indices from 0: the source vertex, the nearest target vertex, the
    target face and the barycentric weights of the point on it, its position, whether it is valid (1 or 0), the
    distortion, the confidence (nan where nobody rated the map) and the growth (`gmds.maps.growth`; nan where it is not
    known). Numbers are written with all their digits.

    .mat (MATLAB 5, readable by Octave and scipy): `vertex` (n, 1), `face` (n, 1), `barycentric` (n, 3), `position`
    (n, 3), `valid` (n, 1) logical, `distortion` (n, 1), `confidence` (n, 1), `growth` (n, 1), `status`, and the counts
    `n_source`, `n_target`. Indices are doubles from 1, as MATLAB has them: `target_vertices(vertex(i), :)` is where
    source vertex i goes.

    Parameters
    ----------
    answer : Correspondence
        The map, or anything with its attributes.
    path : path
        Ends in .csv or .mat.

    Raises
    ------
    UnknownExport
        For any other ending (E216).
    OSError
        When it cannot be written.

    See Also
    --------
    Correspondence.save : A map.npz, which can be read again.
    """
    ending = check_export(path)
    content = _csv(answer) if ending == ".csv" else _mat(answer)
    with atomic_write(path) as stream:
        stream.write(content)


def _csv(answer: PointMap) -> bytes:
    columns = (
        range(len(answer.points)),
        answer.vertex_map().tolist(),
        answer.points.face.tolist(),
        *answer.points.barycentric.T.tolist(),
        *answer.points.positions.T.tolist(),
        answer.valid.astype(int).tolist(),
        answer.distortion.tolist(),
        answer.confidence.tolist(),
        growth_of(answer).length.tolist(),
    )
    return table_text(chain([COLUMNS], zip(*columns, strict=True))).encode("ascii")


def _mat(answer: PointMap) -> bytes:
    from scipy.io import savemat

    out = io.BytesIO()
    members = {
        "vertex": answer.vertex_map() + 1.0,
        "face": answer.points.face + 1.0,
        "barycentric": answer.points.barycentric,
        "position": answer.points.positions,
        "valid": answer.valid,
        "distortion": answer.distortion,
        "confidence": answer.confidence,
        "growth": growth_of(answer).length,
        "status": answer.status.name,
        "n_source": float(answer.source.n_vertices),
        "n_target": float(answer.target.n_vertices),
    }
    savemat(out, {name: np.asarray(value) for name, value in members.items()}, oned_as="column")
    return out.getvalue()

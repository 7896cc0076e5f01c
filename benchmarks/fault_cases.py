"""The bad inputs of the fault table, generated: arrays, odd surfaces and files, with what each must get.

The same tables that the tests run on (`tests/broken_arrays.py`, `odd_shapes.py`, `file_cases.py`, `broken_files.py`).
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

import broken_arrays
import broken_files
import file_cases
from odd_shapes import BALL, ODD, Odd

# Words of which an error must say at least one (or the place, "line 7") to count as naming the fault.
NAMES_IT = {
    "V01": "nan|finite|inf", "V02": "nan|finite|inf", "V03": "range|finite|large|small|scale|overflow|inf|nan",
    "V04": "empty|no vert|shape|size|zero|vert", "V05": "empty|no face|face|triang|point cloud",
    "V06": "index|indices|range|bound|outside|vertex", "V07": "index|indices|range|bound|negative|outside|vertex",
    "V08": "index|indices|range|bound|overflow|outside|large|int", "V09": "int|whole|dtype|type|float",
    "V10": "type|bool|object|complex|str|real|whole|integer", "V11": "shape|dimension|column|3|three",
    "V12": "shape|triang|quad|corner|3|three", "V13": "shape|triang|corner|dimension|3|three", "V14": "mask",
    "G": "manifold|degenerate|area|duplicate|orient|component|connected|disconnected|boundary|unreferenced|isolated",
    "F01": "empty|no data|no vert|no face|0 bytes|size", "F06": "format|support|unknown|extension|recogni|type",
    "F07": "trunc|end of|header|count|expected|short|incomplete|lines|vert|face|declared",
    "F08": "count|number|header|vert|face|negative|size", "F09": "degree|corner|polygon|triang|face|vert",
    "F10": "nan|inf|finite|number|float|comma|decimal|convert", "F11": "index|indices|range|bound|vert|integer",
    "F13": "count|triang|facet|end|trunc|length|size", "F14": "property|element|format|type|indices|axis|vert",
    "F15": "line|long", "F17": "json|length|accessor|count|mesh|gltf|glb|size|buffer", "S03": "uri|extern|file",
    "S01": "format|support|unknown|extension|recogni|type",
}  # fmt: skip
# Refused by a rule of this project and not because nothing could be read: no case for the others.
OWN_RULES = {"many.glb", "placed_twice.glb", "uri.glb", "line.obj", "four.off", "binary.off", "declared.obj",
             "open.stl", "index_float.ply", "comma.obj"}  # fmt: skip


@dataclass(frozen=True)
class Case:
    """One bad input. `code` is the error it must get, None where it must be answered as `shape` or `V`, `F` say."""

    row: str
    name: str
    code: str | None
    says: str = ""
    make: Callable[[], tuple[Any, Any, int, Odd | None]] | None = None
    content: bytes = b""

    @functools.cached_property
    def arrays(self) -> tuple[Any, Any, int, Odd | None]:
        """Vertices, faces, source, and the reference."""
        assert self.make is not None
        return self.make()

    @property
    def vertices(self) -> Any:
        """As given."""
        return self.arrays[0]

    @property
    def faces(self) -> Any:
        """As given."""
        return self.arrays[1]

    @property
    def source(self) -> int:
        """The vertex from which distances are measured."""
        return self.arrays[2]

    @property
    def shape(self) -> Odd | None:
        """The surface that the arrays mean, if they mean one."""
        return self.arrays[3]

    @property
    def words(self) -> str:
        """What an error must say to name the fault."""
        named = NAMES_IT.get(self.row) or NAMES_IT.get(self.row[0]) or "(?!)"  # (?!): nothing does
        return named + r"|line \d|byte \d"


def _odd(make: Callable[[], Odd]) -> tuple[Any, Any, int, Odd | None]:
    shape = make()
    return shape.vertices, shape.faces, shape.source, shape


def _layouts() -> Iterator[tuple[str, Any, Any]]:
    """V09, V15: the same mesh in forms that change nothing."""
    v, f = BALL().vertices, BALL().faces
    yield "float faces", v, f.astype(float)
    yield "float32 vertices", v.astype(np.float32), f
    yield "int32 faces", v, f.astype(np.int32)
    yield "uint32 faces", v, f.astype(np.uint32)
    yield "Fortran order", np.asfortranarray(v), np.asfortranarray(f)
    yield "not contiguous", np.repeat(v, 2, axis=0)[::2], np.repeat(f, 2, axis=0)[::2]
    yield "big-endian", v.astype(">f8"), f.astype(">i8")
    yield "lists", v.tolist(), f.tolist()
    still = v.copy()
    still.setflags(write=False)
    yield "read-only", still, f


def _arrays() -> Iterator[Case]:
    sound = Odd(file_cases.V, file_cases.F)
    for i, (row, code, v, f, says) in enumerate(broken_arrays.REFUSED):
        meant = None
        if row == "V10" and np.bool_ not in (np.asarray(v).dtype.type, np.asarray(f).dtype.type):
            meant = sound  # numbers in an odd type: converting them is an answer too
        yield Case(row, f"{row} refused {i}", code, says, functools.partial(lambda *given: given, v, f, 0, meant))
    for name, v, f in _layouts():
        meant = Odd(BALL().vertices, BALL().faces)
        yield Case("V15", name, None, make=functools.partial(lambda *given: given, v, f, 0, meant))
    for row, name, make in ODD:
        yield Case(row, f"{row} {name}", None, make=functools.partial(_odd, make))


def _files() -> Iterator[Case]:
    def raw(content: str | bytes) -> bytes:
        return content if isinstance(content, bytes) else content.encode()

    for row, name, content in file_cases.READ:
        yield Case(row, name, None, content=raw(content))
    for row, name, content, code, says in broken_files.REFUSED:
        yield Case(row, name, code, says, content=raw(content))


ARRAYS: Mapping[str, Case] = {case.name: case for case in _arrays()}
FILES: Mapping[str, Case] = {case.name: case for case in _files()}

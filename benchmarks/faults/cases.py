"""The bad inputs of the fault table, generated: arrays, odd surfaces and files, with what each must get.

The same tables that the tests run on (`tests/broken_arrays.py`, `odd_shapes.py`, `file_cases.py`, `broken_files.py`).
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import broken_arrays
import broken_files
import file_cases
import numpy as np
from odd_shapes import BALL, ODD, Odd, bow_tie

from benchmarks.faults.meanings import meanings, touching

# Words of which an error must say at least one (or the place, "line 7") to count as naming the fault; a message that
# quotes what it could not read ("invalid literal for int() with base 10: 'four'") names it too.
NAMES_IT = {
    "V01": "nan|finite|inf", "V02": "nan|finite|inf",
    "V03": "range|finite|large|small|scale|overflow|inf|nan|type",
    "V04": "empty|no vert|shape|size|zero|vert|none",
    "V05": "empty|no face|face|triang|point cloud|zero-size|none|type",
    "V06": "index|indices|range|bound|outside|vertex|numbered",
    "V07": "index|indices|range|bound|negative|outside|vertex|numbered",
    "V08": "index|indices|range|bound|overflow|outside|large|int",
    "V09": "int|whole|dtype|type|float|index|indices|range|bound|numbered",
    "V10": "type|bool|object|complex|str|real|whole|integer|numbered", "V11": "shape|dimension|column|3|three|2d",
    "V12": "shape|triang|quad|corner|3|three", "V13": "shape|triang|corner|dimension|3|three|2d",
    "V14": "mask|numpy array|type", "V15": "type|endian|byte|list|integer|contiguous|writ|read-?only|numpy array",
    "G": "manifold|degenerate|area|duplicate|orient|component|connected|disconnected|boundary|unreferenced|isolated"
         "|numbered",
    "F01": "empty|no data|no vert|no face|0 bytes|size|header|first line|not a|eof|premature",
    "F06": "format|support|unknown|extension|recogni|type|header|not a|valid off|no vert|no face|first line|decode",
    "F07": "trunc|end of|eof|header|count|expected|short|incomplete|lines|vert|face|declared|inhomogeneous|premature",
    "F08": "count|number|header|vert|face|negative|size|literal|digits|values to unpack|lines",
    "F09": "degree|corner|polygon|triang|face|vert|inhomogeneous",
    "F10": "nan|inf|finite|number|float|comma|decimal|convert|literal|unmatched",
    "F11": "index|indices|range|bound|vert|integer|literal",
    "F12": "header|valid off|utf|decode|lines|values to unpack|literal|column|colou?r|comment|texture|normal",
    "F13": "count|triang|facet|end|trunc|length|size|face \\d|premature|eof",
    "F14": "property|element|format|type|indices|axis|vert|quaternion|'x'",
    "F15": "line|long", "F16": "utf|decode|byte",
    "F17": "json|length|accessor|count|mesh|gltf|glb|size|buffer", "S03": "uri|extern|file",
    "S01": "format|support|unknown|extension|recogni|type",
}  # fmt: skip
# Refused by a rule of this project and not because nothing could be read: no case for the others.
OWN_RULES = {"many.glb", "placed_twice.glb", "uri.glb", "line.obj", "four.off", "binary.off", "declared.obj",
             "open.stl", "index_float.ply", "comma.obj"}  # fmt: skip


Given = tuple[Any, Any, int, list[Odd]]  # vertices, faces, the vertex to measure from, and what they may mean


@dataclass(frozen=True)
class Case:
    """One bad input. `code` is the error it must get, None where it must be answered as `shapes` or `V`, `F` say."""

    row: str
    name: str
    code: str | None
    says: str = ""
    make: Callable[[], Given] | None = None
    content: bytes = b""

    @functools.cached_property
    def arrays(self) -> Given:
        """Vertices, faces, source, and what they mean."""
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
    def shapes(self) -> list[Odd]:
        """The surfaces that the arrays may mean."""
        return self.arrays[3]

    @property
    def are_arrays(self) -> bool:
        """False where lists or nothing at all are given for arrays."""
        return self.make is None or all(isinstance(given, np.ndarray) for given in self.arrays[:2])

    @property
    def words(self) -> str:
        """What an error must say to name the fault."""
        named = NAMES_IT.get(self.row) or NAMES_IT.get(self.row[0]) or "(?!)"  # (?!): nothing does
        return named + r"|line \d|byte \d|face \d|vertex \d" + ("" if self.are_arrays else "|array|list|type|sequence")


def _odd(make: Callable[[], Odd]) -> Given:
    shape = make()
    apart = touching(shape) if make is bow_tie else []
    return shape.vertices, shape.faces, shape.source, [shape, *apart]


def _given(v: Any, f: Any, shapes: list[Odd]) -> Given:
    return v, f, 0, shapes


def _array(given: Any) -> Any:
    """A list as an array where it is one, so that nobody fails for the brackets."""
    if isinstance(given, list) and given and len({len(row) for row in given}) == 1:
        array = np.array(given)
        return given if array.dtype == object else array
    return given


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
    for i, (row, code, v, f, says) in enumerate(broken_arrays.REFUSED):
        yield Case(row, f"{row} refused {i}", code, says, functools.partial(_given, _array(v), _array(f), meanings(i)))
    ball = Odd(BALL().vertices, BALL().faces)
    for name, v, f in _layouts():
        yield Case("V15", name, None, make=functools.partial(_given, v, f, [ball]))
    for row, name, make in ODD:
        yield Case(row, f"{row} {name}", None, make=functools.partial(_odd, make))


def _files() -> Iterator[Case]:
    def raw(content: str | bytes) -> bytes:
        return content if isinstance(content, bytes) else content.encode()

    for row, name, content in file_cases.READ:
        yield Case(row, name, None, content=raw(content))
    for row, name, content, _ in broken_files.TOLD:
        yield Case(row, name, None, content=content.encode())
    for row, name, content, code, says in broken_files.REFUSED:
        yield Case(row, name, code, says, content=raw(content))


ARRAYS: Mapping[str, Case] = {case.name: case for case in _arrays()}
FILES: Mapping[str, Case] = {case.name: case for case in _files()}

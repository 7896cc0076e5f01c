"""What arrays and files that this project refuses may be taken to mean.

Refusing them is a choice; whoever answers rightly for any of these meanings has answered rightly. Where nothing is
listed there is nothing to answer: a face that refers to no vertex, a corner number of 1.5, a file that ends too soon.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import file_cases
import numpy as np
from broken_arrays import REFUSED, with_entry
from odd_shapes import BALL, Odd

V, F = file_cases.V, file_cases.F
SOUND = Odd(V, F)
SOURCE = np.arange(len(V)) == 0
FOLDED = ([[0, 1, 2], [0, 2, 3]], [[0, 1, 3], [1, 2, 3]])  # a quad along either diagonal


Arrays = tuple[np.ndarray, np.ndarray]
SPELLED = {"token0.off": np.nan, "token1.off": np.inf, "token2.off": -np.inf, "token4.off": 16.0, "token5.off": 1000.0,
           "token9.off": 1.0, "huge.off": np.inf}  # fmt: skip
NOTHING = (np.zeros((0, 3)), np.zeros((0, 3), dtype=int))


def readings(name: str) -> list[Arrays]:
    """Vertices and faces that a file may be read as: those it had before it was broken, and what it says to the letter.

    NaN where NaN is written, hexadecimal numbers, nothing where there is nothing, and no triangles for faces of fewer
    than three corners.
    """
    found = [(V, F)]
    if name in SPELLED:
        found.append((with_entry(V, (1, 1), SPELLED[name]), F))
    elif name == "nan.ply":
        found.append((with_entry(V, (1, 0), np.nan), F))
    elif name == "nan_binary.ply":
        found.append((np.where(V == -1, np.nan, V), F))
    elif name in ("degree0.off", "degree1.off", "degree2.off", "degree2.ply", "degree.obj"):
        found.append((V, F[:3]))
    elif name.startswith("empty.") or name in ("blank.off", "backtracking.obj", "nothing.glb"):
        found.append(NOTHING)
    elif name == "indices.ply":
        found.append((V, F[:0]))
    return found


def meanings(case: int) -> list[Odd]:
    """Surfaces that case number `case` of `REFUSED` may stand for, each with its distances from vertex 0."""
    row, _, v, f, _ = REFUSED[case]
    reader = {"V03": _scaled, "V05": _no_faces, "V10": _other_types, "V11": _flat, "G22": _no_area}.get(row)
    if reader is not None:
        return list(reader(v, f))
    if row == "V12":  # or a tetrahedron, as four corners are for libigl
        return [*(Odd(V, np.array(faces)) for faces in FOLDED), SOUND]
    if row == "V14" or (row == "V13" and isinstance(f, np.ndarray) and f.size == F.size):
        return [SOUND]  # what lies under the mask; twelve numbers in another shape
    if row == "V13" and isinstance(f, np.ndarray):
        return [Odd(V, NOTHING[1], known=SOUND.distances)]  # edges
    if row == "V04" and v is not None and len(f) == 0:
        return [Odd(np.zeros((0, 3)), np.zeros((0, 3), int), known=np.zeros(0))]
    return []


def touching(bow_tie: Odd) -> list[Odd]:
    """Two surfaces that share a vertex, if that does not connect them."""
    first = np.arange(len(bow_tie.vertices)) < BALL().n_vertices
    return [Odd(bow_tie.vertices, bow_tie.faces, known=np.where(first, bow_tie.distances, np.inf))]


def _scaled(v: Any, f: Any) -> Iterator[Odd]:
    """Huge and tiny, but finite: distances are as long as they are."""
    if v.dtype != np.float64:
        return  # beyond float64
    far = np.abs(v).max(axis=1) > 1e3 * np.abs(v).min()
    if far.any() and not far.all():  # one vertex far away, and no shorter way through it
        yield Odd(v, f, known=np.where(far, np.abs(v).max(), SOUND.distances))
    else:
        yield Odd(v, f, known=np.abs(v).max() * SOUND.distances)


def _no_faces(_v: Any, _f: Any) -> Iterator[Odd]:
    yield Odd(V, np.zeros((0, 3), dtype=int), known=np.where(SOURCE, 0.0, np.inf))


def _other_types(v: Any, f: Any) -> Iterator[Odd]:
    """Numbers in an odd type are those numbers; truth values are 0 and 1."""
    if np.asarray(v).dtype == bool:
        yield Odd(np.asarray(v, dtype=float), F, known=np.zeros(len(V)))
    elif np.asarray(f).dtype == bool:
        yield from _named_twice(np.asarray(f, dtype=int), {1: 0})
    else:
        yield SOUND


def _flat(v: Any, f: Any) -> Iterator[Odd]:
    if isinstance(v, np.ndarray) and v.shape == (len(V), 2):
        yield Odd(np.column_stack([v, np.zeros(len(V))]), f)
    elif isinstance(v, np.ndarray) and v.size == V.size:
        yield SOUND


def _no_area(v: Any, f: Any) -> Iterator[Odd]:
    """All points in one place or on one line, or faces that name a vertex twice."""
    if np.array_equal(f, F):
        yield Odd(v, F, known=np.linalg.norm(v - v[0], axis=1))
    else:
        yield from _named_twice(np.asarray(f), {1: 0, 2: 1})


def _named_twice(faces: Any, before: dict[int, int]) -> Iterator[Odd]:
    """Faces without area: they connect nothing, or are the edges that they have, each vertex after that in `before`."""
    yield Odd(V, faces, known=np.where(SOURCE, 0.0, np.inf))
    known = np.where(SOURCE, 0.0, np.inf)
    for vertex, last in before.items():
        known[vertex] = known[last] + np.linalg.norm(V[vertex] - V[last])
    yield Odd(V, faces, known=known)

"""What counts as what in the fault table.

| class | means |
|---|---|
| right | an answer, and the right one (below) |
| clear error | an exception whose message names the fault (a word of `NAMES_IT` in `cases.py`) or the line |
| unclear error | any other exception, or a wrong answer with an explanation printed beside it |
| not finite, silently | any other answer with NaN or infinity in it |
| wrong, silently | any other answer: foreign memory, 0 where unreachable, a part of the faces |
| crash | the process ends: signal, abort, exit; also when the case is run again in a fresh process |
| hang | more than 10 s of processor time, or 180 s in all, for meshes of at most 1,000 vertices |

Right distances: within 5 % of the reference in the mean (50 % on less than ten vertices); what cannot be reached is
+inf, NaN, negative, or beyond any distance. A right Laplacian: finite, symmetric, constants in its kernel, coordinates
with an energy of up to twice the area, leaving out vertices on no face. A right file: its own arrays in its own order,
up to the rounding of float32; STL by the corners of faces. Nobody has to refuse what this project refuses: an input
that can be taken to mean something (`meanings.py`: what lies under a mask, a quad along either diagonal, huge
coordinates, NaN in a file) is answered rightly when the answer is right for it, and a broken file also when it is read
as what it was before. `None` with an explanation printed beside it is an error with that message. What goes wrong
silently is run again in a fresh process and another order, and the kinder class counts.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import scipy.sparse as sp
from odd_shapes import Odd

from benchmarks.faults.cases import Case
from benchmarks.faults.meanings import readings

CLASSES = ("right", "clear error", "unclear error", "not finite, silently", "wrong, silently", "crash", "hang")
MEAN_ERROR = 0.05  # of distances, relative, that counts as right: a convention
FLAT = 1e-12  # of the square of the extent: no area, and no energy to compare
FAR_OFF = 1e6  # times the longest distance: no distance, but a mark
OF_FEW_VERTICES = 0.5  # below ten: the heat method can do no better


def judge(case: Case, result: dict[str, Any]) -> str:
    """The class of what came of a case."""
    for ended in ("crash", "hang"):
        if ended in result:
            return ended
    if "error" in result or "nothing" in result:
        said = result.get("message", result.get("printed", ""))
        named = re.search(case.words, said.replace(case.name, ""), re.IGNORECASE)
        return "clear error" if named else "unclear error"
    if is_right(case, result):
        return "right"
    if result.get("printed", "").strip():
        return "unclear error"
    return "wrong, silently" if _is_finite(result) else "not finite, silently"


def _is_finite(result: dict[str, Any]) -> bool:
    found = result["matrix"][2] if "matrix" in result else result.get("values", result.get("vertices"))
    return bool(np.isfinite(np.array(found, dtype=float)).all())


def passes(case: Case, result: dict[str, Any]) -> bool:
    """Whether this project keeps what it promises: the very code and culprit, or the right answer and not a word."""
    if case.code is not None:
        return result.get("code") == case.code and case.says in result["message"]
    return judge(case, result) == "right" and not result.get("printed", "").strip()


def is_right(case: Case, result: dict[str, Any]) -> bool:
    """Whether an answer is the right one, for any of the things that may be meant."""
    if "vertices" in result:
        v, f = np.array(result["vertices"], dtype=float), np.array(result["faces"])
        return any(_same_mesh(case, v, f, *wanted) for wanted in readings(case.name))
    if "matrix" in result:
        row, column, data = result["matrix"]
        matrix = sp.coo_matrix((np.array(data, dtype=float), (row, column)), shape=result["shape"]).tocsr()
        return any(_is_laplacian(matrix, shape) for shape in case.shapes)
    found = np.array(result["values"], dtype=float)
    return any(_same_distances(found, shape.distances) for shape in case.shapes)


def _same_mesh(case: Case, v: Any, f: Any, wanted: Any, faces: Any) -> bool:
    if not len(faces):
        same = v.size == wanted.size and f.size == 0
        return bool(same and np.allclose(v.reshape(wanted.shape), wanted, atol=1e-6))
    if f.shape != faces.shape or v.ndim != 2 or v.shape[1:] != (3,) or f.min() < 0 or f.max() >= len(v):
        return False
    same = np.allclose(v[f.astype(int)], wanted[faces], atol=1e-6, equal_nan=True)
    by_corners = case.row == "F13" or case.name.endswith(".stl") or b"facet" in case.content[:200]
    return bool(same and (by_corners or (len(v) == len(wanted) and np.array_equal(f, faces))))


def _same_distances(found: Any, reference: Any) -> bool:
    if found.shape != reference.shape:
        return False
    if not len(reference):
        return True
    reached = np.isfinite(reference)
    longest = reference[reached].max()
    apart = ~np.isfinite(found) | (found < 0) | (found > FAR_OFF * max(longest, np.finfo(float).tiny))
    if not np.array_equal(apart, ~reached):
        return False
    allowed = MEAN_ERROR if len(reference) >= 10 else OF_FEW_VERTICES
    return bool(np.abs(found[reached] - reference[reached]).mean() <= allowed * longest)


def _is_laplacian(matrix: sp.csr_matrix, shape: Odd) -> bool:
    n, faces = len(shape.vertices), np.asarray(shape.faces, dtype=int)
    if matrix.shape != (n, n) or not np.isfinite(matrix.data).all():
        return False
    used = np.unique(faces)
    matrix = matrix[used][:, used]  # some libraries put ones in the rows of vertices on no face
    size = max(np.abs(matrix.data).max(initial=0), 1e-300)
    if len(used) == 0:
        return True
    if abs(matrix - matrix.T).max() > 1e-9 * size or np.abs(matrix @ np.ones(len(used))).max() > 1e-6 * size:
        return False
    x = shape.vertices - shape.vertices[used[0]]
    x = x / (np.abs(x[used]).max() or 1.0)
    a, b, c = x[faces.T]
    area = float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)  # a face that is given twice counts twice
    return area < FLAT or 0.25 < float((x[used] * (matrix @ x[used])).sum()) / (2 * area) < 1.001

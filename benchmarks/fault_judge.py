"""What counts as what in the fault table.

| class | means |
|---|---|
| right | an answer, and the right one (below) |
| clear error | an exception whose message names the fault (a word of `NAMES_IT` in `fault_cases.py`) or the line |
| unclear error | any other exception, or a wrong answer with an explanation printed beside it |
| wrong, silently | any other answer: NaN, foreign memory, 0 where unreachable, a part of the faces |
| crash | the process ends: signal, abort, exit; also when the case is run again in a fresh process |
| hang | more than 10 s of processor time, or 180 s in all, for meshes of at most 1,000 vertices |

Right distances: within 5 % of the reference in the mean (50 % on less than ten vertices), +inf where unreachable. A
right Laplacian: finite, symmetric, constants in its kernel, coordinates with an energy up to twice the area. A right
file: its own arrays in its own order, up to the rounding of float32; STL by the corners of faces. For a broken file
that is the mesh before it was broken.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import scipy.sparse as sp
from fault_cases import Case
from file_cases import F, V
from odd_shapes import Odd

CLASSES = ("right", "clear error", "unclear error", "wrong, silently", "crash", "hang")
MEAN_ERROR = 0.05
OF_FEW_VERTICES = 0.5  # below ten: the heat method can do no better


def judge(case: Case, result: dict[str, Any]) -> str:
    """The class of what came of a case."""
    for ended in ("crash", "hang"):
        if ended in result:
            return ended
    if "error" in result:
        named = re.search(case.words, result["message"].replace(case.name, ""), re.IGNORECASE)
        return "clear error" if named else "unclear error"
    if is_right(case, result):
        return "right"
    return "unclear error" if result.get("printed", "").strip() else "wrong, silently"


def passes(case: Case, result: dict[str, Any]) -> bool:
    """Whether this project keeps what it promises: the very code and culprit, or the right answer and not a word."""
    if case.code is not None:
        return result.get("code") == case.code and case.says in result["message"]
    return judge(case, result) == "right" and not result.get("printed", "").strip()


def is_right(case: Case, result: dict[str, Any]) -> bool:
    """Whether an answer is the right one."""
    if "vertices" in result:
        return _same_mesh(case, np.array(result["vertices"], dtype=float), np.array(result["faces"]))
    shape = case.shape
    if shape is None:
        return False
    if "matrix" in result:
        row, column, data = result["matrix"]
        n = len(shape.vertices)
        matrix = sp.coo_matrix((np.array(data, dtype=float), (row, column)), shape=result["shape"]).tocsr()
        return matrix.shape == (n, n) and _is_laplacian(matrix, shape)
    return _same_distances(np.array(result["values"], dtype=float), shape.distances)


def _same_mesh(case: Case, v: Any, f: Any) -> bool:
    if f.shape != F.shape or v.ndim != 2 or v.shape[1:] != (3,) or not len(f) or f.min() < 0 or f.max() >= len(v):
        return False
    same = np.allclose(v[f.astype(int)], V[F], atol=1e-6)
    by_corners = case.row == "F13" or case.name.endswith(".stl") or b"facet" in case.content[:200]
    return bool(same and (by_corners or (len(v) == len(V) and np.array_equal(f, F))))


def _same_distances(found: Any, reference: Any) -> bool:
    if found.shape != reference.shape or np.isnan(found).any():
        return False
    reached = np.isfinite(reference)
    if not np.array_equal(np.isfinite(found), reached):
        return False
    allowed = MEAN_ERROR if len(reference) >= 10 else OF_FEW_VERTICES
    return bool(np.abs(found[reached] - reference[reached]).mean() <= allowed * reference[reached].max())


def _is_laplacian(matrix: sp.csr_matrix, shape: Odd) -> bool:
    if not np.isfinite(matrix.data).all():
        return False
    x = shape.vertices - shape.vertices[shape.faces[0, 0]]
    size = max(np.abs(matrix.data).max(initial=0), 1e-300)
    if abs(matrix - matrix.T).max() > 1e-9 * size or np.abs(matrix @ np.ones(len(x))).max() > 1e-6 * size:
        return False
    energy = float((x * (matrix @ x)).sum()) / (2 * shape.area)
    return 0.25 < energy < 1.001

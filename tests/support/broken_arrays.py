"""Arrays that are no mesh, by row of the reliability table: row, code they must get, arrays, what the error says."""

from __future__ import annotations

from typing import Any

import numpy as np
from generated_shapes import tetrahedron

V = tetrahedron().vertices
F = tetrahedron().faces


def with_entry(array: np.ndarray, index: Any, value: Any) -> np.ndarray:
    changed = array.copy()
    changed[index] = value
    return changed


REFUSED = [
    ("V01", "E101", with_entry(V, (2, 1), np.nan), F, "first [2]"),
    ("V02", "E101", with_entry(V, (3, 0), np.inf), F, "first [3]"),
    ("V02", "E101", with_entry(V, slice(1, 3), -np.inf), F, "2 vertices"),
    ("V03", "E102", V * 1e300, F, "rescale"),
    ("V03", "E102", with_entry(V, (1, 1), 1e300), F, "vertex 1"),
    ("V03", "E102", V * 1e-200, F, "rescale"),
    ("V03", "E101", (V * np.longdouble("1e4000")), F, "first"),
    ("V04", "E103", np.zeros((0, 3)), F, "no vertices"),
    ("V04", "E103", None, F, "no vertices"),
    ("V04", "E103", [], [], "no vertices"),
    ("V05", "E104", V, np.zeros((0, 3), dtype=int), "no faces"),
    ("V05", "E104", V, None, "no faces"),
    ("V06", "E105", V, with_entry(F, (2, 1), 4), "face 2 = [0 4 1]"),
    ("V07", "E105", V, with_entry(F, (3, 0), -1), "face 3 = [-1"),
    ("V08", "E105", V, with_entry(F, (1, 2), 2**32 + 1), "face 1"),
    ("V08", "E105", V, with_entry(F.astype(np.uint64), (1, 2), 2**63 + 1), "face 1"),
    ("V08", "E105", V, [[0, 1, 2], [0, 1, 2**70]], "face 1"),
    ("V08", "E105", V, with_entry(F.astype(float), (1, 2), 1e300), "face 1"),
    ("V09", "E106", V, with_entry(F.astype(float), (1, 2), 1.5), "face 1"),
    ("V09", "E106", V, with_entry(F.astype(float), (1, 2), np.nan), "face 1"),
    ("V09", "E106", V, with_entry(F.astype(float), (1, 2), np.inf), "face 1"),
    *[("V10", "E107", V.astype(kind), F, "vertices") for kind in (bool, object, complex, str, "S8")],
    *[("V10", "E107", V, F.astype(kind), "face") for kind in (bool, object, complex, str, "S8")],
    ("V10", "E107", V.astype(int).astype("datetime64[s]"), F, "vertices"),
    ("V11", "E108", V[:, :2], F, "column of zeros"),
    ("V11", "E108", V.ravel(), F, "(n, 3)"),
    ("V11", "E108", [[0, 0, 0], [1, 0]], F, "rectangular"),
    ("V12", "E109", V, [[0, 1, 2, 3]], "triangulate("),
    ("V13", "E108", V, F[:, :2], "(m, 3)"),
    ("V13", "E108", V, F.ravel(), "(m, 3)"),
    ("V13", "E108", V, F[None], "(m, 3)"),
    ("V13", "E108", V, [[0, 1, 2], [0, 1]], "rectangular"),
    ("V14", "E107", np.ma.masked_greater(V, 0.5), F, "masked"),
    ("V14", "E107", V, np.ma.masked_equal(F, 3), "masked"),
    ("G22", "E114", V * 0 + 3, F, "zero area"),
    ("G22", "E114", np.outer([1, 2, 3, 5], [0.1, 0.2, 0.3]), F, "zero area"),
    ("G22", "E114", V, [[0, 0, 1], [2, 1, 2]], "zero area"),
]

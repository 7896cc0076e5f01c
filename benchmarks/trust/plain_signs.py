"""The signs of maps of plain generalised multidimensional scaling, kept while `benchmarks.accuracy.plain` makes them."""

from __future__ import annotations

import contextlib
import hashlib
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

import geodesics
from gmds.matching import rating
from gmds.matching.candidates import MapCandidate
from gmds.matching.result import _badly_kept as badly_kept
from gmds.matching.result import original_points
from gmds.matching.signs import Signs, signs_of

SIGNS = "GMDS_PLAIN_SIGNS"  # of the environment: the folder of `--signs`
JUDGED = 400  # vertices of a map, about, whose signs are kept


@contextlib.contextmanager
def noted(name: str, source: geodesics.Mesh, target: geodesics.Mesh) -> Iterator[None]:
    """The signs of the map of a cell, of some vertices, in a file of the folder of `SIGNS` if there is one."""
    folder = os.environ.get(SIGNS)
    seen: list[Any] = []

    def observed(candidate: MapCandidate, margin: float) -> Signs:
        seen[:] = [(candidate, margin, signs_of(candidate, margin))]
        return dict(seen[0][2])

    with mock.patch.object(rating, "signs_of", observed):
        yield
    if folder is None or not seen:
        return
    candidate, margin, signs = seen[0]
    rows = np.arange(0, source.n_vertices, max(1, source.n_vertices // JUDGED))
    points = original_points(candidate)[rows]
    found = {"rows": rows, "face": points.face, "barycentric": points.barycentric, "margin": margin, "cell": name}
    values = np.stack([signs[one][rows] for one in signs], axis=1)
    np.savez_compressed(
        Path(folder) / f"{key_of(source, target)}_{name.replace(' ', '_')}.npz",
        **found,
        names=list(signs),
        signs=values,
        stress=candidate.evidence.stress,
        badly_kept=badly_kept(candidate),
    )


def key_of(source: geodesics.Mesh, target: geodesics.Mesh) -> str:
    """What tells a pair of meshes from others, however they are turned."""
    return hashlib.sha256(source.faces.tobytes() + target.faces.tobytes()).hexdigest()[:12]

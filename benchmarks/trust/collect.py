"""Maps of all kinds, with the signs that confidence is made of and the true errors.

    GMDS_DATA=... python -m benchmarks.trust.collect FOLDER [--only TEXT]

Every mesh turned and resized at random. Writes FOLDER/<pair>.npz for `benchmarks.trust.fit`; what is there is not done
again. Takes an hour of one core.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
from scipy.spatial import cKDTree

from benchmarks.accuracy.runs import ONE_THREAD
from benchmarks.trust.cases import Case, Known, cases
from geodesics import Mesh
from geodesics.arrays import Floats, Integers
from gmds import match
from gmds.benchmarking.run import turned
from gmds.correspondence import Correspondence
from gmds.evaluation import geodesic_error, protocol_subset
from gmds.matching import pipeline, rating
from gmds.matching.candidates import MapCandidate
from gmds.matching.other_images import with_candidate
from gmds.matching.rivals import Rivals
from gmds.matching.signs import Signs, signs_of
from gmds.shapes import quadruped
from gmds.surface.measured import measure

POINTS = 400  # of a map that are judged, at the most: neighbouring vertices say the same


def main() -> None:
    """Collect what is not there yet."""
    parser = argparse.ArgumentParser(description="Maps with their signs and errors, for benchmarks.trust.fit.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", default="", help="pairs with this in their name")
    asked = parser.parse_args()
    os.environ.update(ONE_THREAD)
    asked.folder.mkdir(parents=True, exist_ok=True)
    match(quadruped(n_vertices=600), quadruped(n_vertices=600))  # compiles
    for case in cases():
        file = asked.folder / f"{case.name.replace(' ', '_').replace(':', '_')}.npz"
        if asked.only not in case.name or file.exists():
            continue
        row = collected(case)
        part = file.with_suffix(".part.npz")
        np.savez_compressed(part, **row)
        os.replace(part, file)
        print(f"{case.kind:16} {case.name:50} {100 * row['error'].mean():6.2f} {row['status']}", file=sys.stderr)


def collected(case: Case) -> dict[str, Any]:
    """The signs (p, k) of judged vertices, their true errors (p,), whether they are `valid`, and what is told.

    What rivals, and an image of the target that fits far better, leave of confidence is `undisputed` (p,).
    """
    known, rng = case.load(), np.random.default_rng([0, *case.name.encode()])
    source, target = turned(known.source, rng), turned(known.target, rng)
    known = Known(source, target, known.vertices, type(known.truth)(target, known.truth.face, known.truth.barycentric))
    seen: list[tuple[MapCandidate, Rivals, Signs]] = []

    def observed(candidate: MapCandidate, rivals: Rivals) -> Signs:
        seen.append((candidate, rivals, signs_of(candidate, rivals)))
        return seen[-1][-1]

    believed = 1.0

    def beside(answer: Correspondence, *others: Any, **how: bool) -> Correspondence:
        nonlocal believed
        signs = seen[-1]
        lowered = with_candidate(answer, *others, **how)
        believed = float(lowered.confidence.max() / answer.confidence.max())
        seen.append(signs)  # of the answer again, as the last are those of the other image
        return lowered

    started = time.process_time()
    with mock.patch.object(rating, "signs_of", observed), mock.patch.object(pipeline, "with_candidate", beside):
        answer = match(source, target, **case.options)
    seconds = time.process_time() - started
    chosen = (
        protocol_subset(len(known.vertices), POINTS) if len(known.vertices) > POINTS else np.arange(len(known.vertices))
    )
    vertices = known.vertices[chosen]
    candidate, rivals, signs = seen[-1]
    rows = _rows(answer, candidate, vertices)
    return {
        "kind": case.kind,
        "half": case.half,
        "status": answer.status.name,
        "names": list(signs),
        "undisputed": rivals.undisputed[rows] * believed,
        "signs": np.stack([values[rows] for values in signs.values()], axis=1),
        "error": geodesic_error(answer, known.truth[chosen], vertices),
        "valid": answer.valid[vertices],
        "positions": source.vertices[vertices],
        "margin": answer.meta["evidence"]["margin"],
        "stress": answer.meta["evidence"]["stress"],
        "seconds": seconds,
    }


def _rows(answer: Correspondence, candidate: MapCandidate, vertices: Integers) -> Integers:
    """The vertices of the source of the candidate (a part, or a copy) that stand for `vertices`."""
    given, positions = answer.source, answer.source.vertices[vertices]
    if answer.meta.get("part") == "target":
        given, positions = answer.target, answer.points.positions[vertices]
    solved = candidate.pair.source.original
    used = np.unique(solved.faces)
    return used[cKDTree(solved.vertices[used]).query(_in_frame(given, solved, positions))[1]]


def _in_frame(given: Mesh, solved: Mesh, positions: Floats) -> Floats:
    """Positions on a mesh as positions on its copy: simplified copies are centred and of unit area."""
    original = measure(given)
    if solved.n_vertices == original.original.n_vertices and np.allclose(solved.vertices, original.original.vertices):
        return positions
    before, after = original.original.vertices, original.mesh.vertices
    scale = np.linalg.norm(np.ptp(after, axis=0)) / np.linalg.norm(np.ptp(before, axis=0))
    return positions * scale + (after[0] - scale * before[0])


if __name__ == "__main__":
    main()

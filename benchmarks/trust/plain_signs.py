"""The signs of maps of plain multidimensional scaling, kept while `benchmarks.accuracy.plain` makes them.

    python -m benchmarks.trust.plain_signs FOLDER

keeps those of built-in shapes as well: of two in other poses, and of persons taken for animals, where all is wrong.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from unittest import mock

import numpy as np

import geodesics
import gmds
from gmds.matching import rating
from gmds.matching.candidates import MapCandidate
from gmds.matching.result import original_points
from gmds.matching.rivals import Rivals
from gmds.matching.signs import Signs, signs_of
from gmds.shapes import humanoid, quadruped, truth
from gmds.surface.measured import SMOOTHING

SIGNS = "GMDS_PLAIN_SIGNS"  # of the environment: the folder of `--signs`
JUDGED = 400  # vertices of a map, about, by which it is judged


@contextlib.contextmanager
def observed() -> Iterator[list[tuple[MapCandidate, float, Signs]]]:
    """The candidate that was rated last, its margin and its signs, as the one entry of a list."""
    seen: list[tuple[MapCandidate, float, Signs]] = []

    def looked_at(candidate: MapCandidate, rivals: Rivals) -> Signs:
        seen[:] = [(candidate, rivals.margin, signs_of(candidate, rivals))]
        return dict(seen[0][2])

    with mock.patch.object(rating, "signs_of", looked_at):
        yield seen


@contextlib.contextmanager
def noted(name: str, source: geodesics.Mesh, target: geodesics.Mesh) -> Iterator[None]:
    """The signs of the map of a cell in a file of the folder of `SIGNS` if there is one."""
    folder = os.environ.get(SIGNS)
    with observed() as seen:
        yield
    if folder is None or not seen:
        return
    candidate, margin, signs = seen[0]
    rows, points = np.arange(source.n_vertices), original_points(candidate)
    found = {"rows": rows, "face": points.face, "barycentric": points.barycentric, "margin": margin, "cell": name}
    values = np.stack([signs[one] for one in signs], axis=1).astype(np.float32)
    np.savez_compressed(
        Path(folder) / f"{key_of(source, target)}_{name.replace(' ', '_')}.npz",
        **found,
        names=list(signs),
        signs=values,
        stress=candidate.evidence.stress,
    )


def key_of(source: geodesics.Mesh, target: geodesics.Mesh) -> str:
    """What tells a pair of meshes from others, however they are turned."""
    return hashlib.sha256(source.faces.tobytes() + target.faces.tobytes()).hexdigest()[:12]


def built_in() -> Iterator[tuple[str, geodesics.Mesh, geodesics.Mesh, bool]]:
    """Shapes with 1,200 vertices, in pairs, and whether both are of one kind."""
    animals = [quadruped(pose, n_vertices=1200, seed=seed) for seed, pose in enumerate(("stand", "graze"), start=5)]
    persons = [humanoid(pose, n_vertices=1200, seed=seed) for seed, pose in enumerate(("stand", "kick"), start=5)]
    yield "animals", *animals, True
    yield "persons", *persons, True
    yield "animal-person", animals[1], persons[1], False
    yield "person-animal", persons[0], animals[1], False


def marched(mesh: geodesics.Mesh) -> geodesics.Distance:
    """Geodesics in the metric |K| g."""
    return geodesics.GeodesicDistance(geodesics.scale_invariant(mesh, smoothing=SMOOTHING))


def main() -> None:
    """Those of built-in shapes."""
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, source, target, same in built_in():
        for distance in (geodesics.CommuteTimeDistance, marched):
            with observed() as seen:
                answer = gmds.match(source, target, distance=distance)
            error = gmds.geodesic_error(answer, truth(source, target)) if same else np.ones(source.n_vertices)
            _, margin, signs = seen[0]
            rows = slice(None, None, source.n_vertices // JUDGED)
            values = np.stack([signs[one][rows] for one in signs], axis=1)
            file = folder / f"built-in_{name}_{distance.__name__}.npz"
            np.savez_compressed(file, names=list(signs), signs=values, error=error[rows], margin=margin)
            print(file.stem, round(100 * float(error.mean()), 2), answer.status.name)


if __name__ == "__main__":
    main()

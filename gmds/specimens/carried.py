"""The landmarks of a template on every specimen of a folder, along maps that a batch makes and keeps."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from geodesics import Mesh, read_mesh
from geodesics.arrays import Bools, Floats
from geodesics.errors import BadArgument
from gmds.batch.collection import names
from gmds.batch.pair_choice import with_template
from gmds.batch.records import WITHOUT_MAP, Batch
from gmds.batch.run import match_collection
from gmds.correspondence import Correspondence
from gmds.files.folders import mesh_files, plain_name
from gmds.landmarks.checking import place_on
from gmds.landmarks.files import Landmarks
from gmds.landmarks.transfer import carry_landmarks
from gmds.maps.point_map import MatchStatus

DOUBTFUL = 0.5  # confidence of a landmark below which it is more likely wrong than right


@dataclass(frozen=True, eq=False)
class Specimen:
    """A specimen with the landmarks of the template on it: `positions` (k, 3), `confidence` and `valid` (k,)."""

    name: str
    mesh: Mesh
    status: MatchStatus
    positions: Floats
    confidence: Floats
    valid: Bools

    @property
    def doubtful(self) -> Bools:
        """Which landmarks (k,) need a look."""
        return np.asarray(~self.valid | (self.confidence < DOUBTFUL), dtype=np.bool_)

    @property
    def configuration(self) -> Floats:
        """Positions (k, 3), NaN where the specimen has no such place."""
        return np.where(self.valid[:, None], self.positions, np.nan)


@dataclass(frozen=True, eq=False)
class Landmarked:
    """A collection with landmarks: the template first, then the specimens; why others are left out, by their names."""

    marks: Landmarks
    specimens: tuple[Specimen, ...]
    failures: Mapping[str, str]

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the landmarks (k,), all different."""
        return self.marks.distinct_names


def landmark_folder(
    folder: Path,
    template: Path,
    marks: Landmarks,
    output: Path,
    *,
    client: Any = None,
    progress: Callable[[str, float], None] | None = None,
    **options: Any,
) -> Landmarked:
    """Carry the landmarks of a template to every mesh of a folder; maps that are in `output` already are kept.

    Parameters
    ----------
    folder : path
        The specimens; the template may lie among them.
    template : path
        The mesh that has the landmarks.
    marks : Landmarks
        k of them.
    output : path
        Gets the maps, as `match_collection` writes them.
    client, progress, **options
        As for `match_collection`.

    Returns
    -------
    Landmarked
        The template and all specimens that could be matched.

    Raises
    ------
    LandmarkError
        When a landmark is not on the template (E301 to E305).
    BadArgument
        E604 when the folder holds no specimen beside the template.
    FormatError, MeshError, OSError
        When the template cannot be read.
    """
    mesh = read_mesh(template)
    own = _of_template(template, mesh, marks)
    paths = mesh_files(folder)
    known = dict(zip(names(paths), paths, strict=True))
    others = {name: path for name, path in known.items() if path.resolve() != template.resolve()}
    if not others:
        raise BadArgument(f"{folder} holds no mesh beside the template")
    name = next((name for name, path in known.items() if path.resolve() == template.resolve()), "")
    name = name or plain_name(template.stem)
    while name in others:  # a template of another folder, called as a specimen is
        name = f"template_{name}"
    shapes = {name: template, **others}
    made = match_collection(shapes, output, pairs=with_template(name), client=client, progress=progress, **options)
    failures, specimens = dict(_failures(made, name)), [Specimen(name, mesh, *own)]
    for pair in made.pairs:
        if pair.status in WITHOUT_MAP:
            continue
        target = read_mesh(others[pair.target])
        answer = Correspondence.load(output / "pairs" / f"{name}__{pair.target}.npz", mesh, target)
        carried = carry_landmarks(answer, marks)
        row = carried.on_target.positions, carried.confidence, carried.valid
        specimens.append(Specimen(pair.target, target, answer.status, *row))
    return Landmarked(marks, tuple(specimens), failures)


def _of_template(template: Path, mesh: Mesh, marks: Landmarks) -> tuple[MatchStatus, Floats, Floats, Bools]:
    """The template's own landmarks, as they were given: status, positions, confidence, valid."""
    there = marks.defined
    names = [name for name, one in zip(marks.distinct_names, there, strict=True) if one]
    if not names:
        raise BadArgument(f"none of the landmarks of {template} has a place")
    positions = np.full((len(marks), 3), np.nan)
    positions[there] = place_on(marks.at[there], mesh, "template", names).positions
    if marks.at.shape[1:] == (3,):
        positions[there] = marks.at[there]
    return MatchStatus.GOOD, positions, there.astype(np.float64), there


def _failures(made: Batch, template: str) -> dict[str, str]:
    """Why a specimen has no landmarks."""
    found = {}
    for pair in made.pairs:
        if pair.failure is not None:
            found[pair.target] = f"{pair.failure.code}: {pair.failure.reason}"
        elif pair.status in WITHOUT_MAP:
            found[pair.target] = f"not matched with {template} yet"
    return found

"""A folder of specimens and one landmarked template: a landmark table, its shapes, pictures, and what needs a look.

python landmark_specimens.py                                              five built-in animals, one of them cut in half
python landmark_specimens.py FOLDER --template T.ply --landmarks T.mrk.json [-o OUT]
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import drawing
import numpy as np
import procrustes
from numpy.typing import NDArray

import gmds
from geodesics import Mesh, MeshError, read_mesh
from geodesics.errors import FormatError
from gmds.files.folders import mesh_files, shape_names
from gmds.files.table import write_table
from gmds.landmarks.checking import place_on
from gmds.landmarks.files import Landmarks, read_landmarks
from gmds.landmarks.transfer import carry_landmarks
from gmds.pictures.camera import Direction
from gmds.shapes import quadruped
from gmds.surface.measured import Surface, measure

Array = NDArray[np.float64]

UP: dict[str, Direction] = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}
# both set by hand: who looks at more is on the safe side
DOUBTFUL = 0.5  # confidence of a landmark below which it is more likely wrong than right
MISSING = ("NA", "NA", "NA")  # a place, as R reads it
FAR = 3.0  # times the median distance from the mean shape beyond which a specimen does


@dataclass(frozen=True)
class Specimen:
    """A specimen with the landmarks of the template on it, k each; `doubtful` (k,) are those that need a look."""

    name: str
    mesh: Mesh
    status: gmds.MatchStatus
    positions: Array
    confidence: Array
    valid: NDArray[np.bool_]

    @property
    def doubtful(self) -> NDArray[np.bool_]:
        return ~self.valid | (self.confidence < DOUBTFUL)

    @classmethod
    def of_template(cls, name: str, mesh: Mesh, marks: Landmarks) -> Specimen:
        """The template itself, with its landmarks as they were given."""
        there = marks.defined
        on_mesh = place_on(marks.at[there], mesh, "template").positions
        positions = np.full((len(marks), 3), np.nan)
        positions[there] = marks.at[there] if marks.at.shape[1:] == (3,) else on_mesh
        return cls(name, mesh, gmds.MatchStatus.GOOD, positions, there.astype(np.float64), there)

    @property
    def configuration(self) -> Array:
        """Positions (k, 3), NaN where the specimen has no such place."""
        return np.where(self.valid[:, None], self.positions, np.nan)


def landmarked(name: str, mesh: Mesh, template: Surface, marks: Landmarks) -> Specimen:
    """The specimen, matched with the template."""
    answer = gmds.match(template, mesh)
    carried = carry_landmarks(answer, marks)
    return Specimen(name, mesh, answer.status, carried.on_target.positions, carried.confidence, carried.valid)


def reasons(specimens: list[Specimen], marks: Landmarks, distance: Array) -> Iterator[tuple[str, str]]:
    """Who needs a look, and why."""
    for specimen, far in zip(specimens, distance, strict=True):
        if specimen.status is not gmds.MatchStatus.GOOD:
            yield specimen.name, f"{specimen.status.name}: {specimen.status.value}"
        for text, rows in (
            ("no counterpart on the specimen", marks.defined & ~specimen.valid),
            (f"confidence below {DOUBTFUL}", specimen.valid & (specimen.confidence < DOUBTFUL)),
        ):
            if rows.any():
                yield specimen.name, f"{text}: {', '.join(marks.distinct_names[i] for i in np.flatnonzero(rows))}"
        if far > FAR * np.nanmedian(distance):
            yield specimen.name, f"{far / np.nanmedian(distance):.1f} times the median distance from the mean shape"


def write_tables(out: Path, specimens: list[Specimen], marks: Landmarks) -> Array:
    """landmarks.csv (a row a landmark), landmarks.tps, shapes.csv (a row a specimen); distances from the mean shape."""
    table = [
        (one.name, name, *(at if valid else MISSING), f"{trust:.4f}", int(valid))
        for one in specimens
        for name, trust, (at, valid) in zip(marks.names, one.confidence, _placed(one), strict=True)
    ]
    write_table(out / "landmarks.csv", ["specimen", "landmark", "x", "y", "z", "confidence", "valid"], table)
    blocks = []
    for one in specimens:
        rows = "\n".join(" ".join(map(repr, at) if valid else MISSING) for at, valid in _placed(one))
        blocks.append(f"LM3={len(marks)}\n{rows}\nID={one.name}\n")
    (out / "landmarks.tps").write_text("\n".join(blocks))
    try:
        aligned, mean = procrustes.superimposed(np.stack([one.configuration for one in specimens]))
    except ValueError as error:
        print(f"no shapes.csv: {error}")
        return np.full(len(specimens), np.nan)
    distance = procrustes.distances(aligned, mean)
    axes = [f"{name}.{axis}" for name in marks.distinct_names for axis in "xyz"]
    rows = (_row(*known) for known in zip(specimens, aligned, distance.tolist(), strict=True))
    write_table(out / "shapes.csv", ["specimen", "centroid_size", "distance_to_mean", *axes], rows)
    return distance


def _row(one: Specimen, shape: Array, far: float) -> list[object]:
    """A row of shapes.csv; R and others read NA as a value that is missing."""
    size = procrustes.centroid_size(one.positions) if one.valid.all() else "NA"
    return [one.name, size, far, *("NA" if np.isnan(x) else x for x in shape.ravel().tolist())]


def _placed(one: Specimen) -> Iterator[tuple[list[float], bool]]:
    return zip(one.positions.tolist(), one.valid.tolist(), strict=True)


def run(
    specimens: Iterator[tuple[str, Mesh]],
    template: tuple[str, Mesh],
    marks: Landmarks,
    out: Path,
    up: Direction = UP["z"],
) -> list[Specimen]:
    """Everything of a collection, into a folder, the template first; `up` is up in the pictures."""
    (out / "pictures").mkdir(parents=True, exist_ok=True)
    surface, to_look_at = measure(template[1]), []
    done = [Specimen.of_template(*template, marks)]
    _draw(out, done[0], marks, up)
    for name, mesh in specimens:
        try:
            done.append(landmarked(name, mesh, surface, marks))
        except (MeshError, ArithmeticError) as error:
            to_look_at.append((name, str(error)))
            continue
        _draw(out, done[-1], marks, up)
        print(f"{name}: {done[-1].status.name}, {int(done[-1].doubtful.sum())} of {len(marks)} landmarks doubtful")
    to_look_at += reasons(done[1:], marks, write_tables(out, done, marks)[1:])
    write_table(out / "to_look_at.csv", ["specimen", "why"], to_look_at)
    for name, why in to_look_at:
        print(f"needs a look: {name}: {why}")
    return done


def _draw(out: Path, one: Specimen, marks: Landmarks, up: Direction) -> None:
    path = out / "pictures" / f"{one.name}.png"
    drawing.draw(path, one.mesh, marks.distinct_names, one.configuration, one.doubtful, up)


def in_folder(folder: Path, template: Path) -> Iterator[tuple[str, Mesh]]:
    """The meshes of a folder but for the template; those that cannot be read are told and left out."""
    paths = mesh_files(folder)
    for name, path in zip(shape_names(paths), paths, strict=True):
        if path.resolve() != template.resolve():
            try:
                yield name, read_mesh(path)
            except (FormatError, MeshError) as error:
                print(f"left out: {error}")


def built_in(n_vertices: int = 1500) -> tuple[Mesh, Landmarks, dict[str, Mesh]]:
    """An animal with landmarks, and others in other poses with parts of other sizes; the last lacks its hind half."""
    template = quadruped(n_vertices=n_vertices)
    x, y, z = template.rest.T
    places = {
        "nose": x.argmax(),
        "left ear": (y + 4 * z).argmax(),
        "right ear": (4 * z - y).argmax(),
        "left fore foot": (x + y - 4 * z).argmax(),
        "right fore foot": (x - y - 4 * z).argmax(),
        "left hind foot": (y - x - 4 * z).argmax(),
        "right hind foot": (-y - x - 4 * z).argmax(),
        "tail": x.argmin(),
        "withers": np.linalg.norm(template.rest - [0.35, 0, 1.2], axis=1).argmin(),
    }
    marks = Landmarks(tuple(places), np.array(list(places.values())))
    large_head = quadruped("walk", head_scale=1.6, n_vertices=n_vertices, seed=1)
    others = {
        "large_head": large_head,
        "long_legs": quadruped("graze", leg_scale=1.3, n_vertices=n_vertices, seed=2),
        "small_ears": quadruped("turn", ear_scale=0.6, n_vertices=n_vertices, seed=3),
        "long_tail": quadruped("walk", tail_scale=1.5, n_vertices=n_vertices, seed=4),
    }
    front = large_head.rest[large_head.faces][..., 0].mean(axis=1) > np.median(large_head.rest[:, 0])
    others["front_half"] = Mesh(large_head.vertices, large_head.faces[front])
    return template, marks, others


def main(arguments: list[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, help="meshes of the specimens")
    parser.add_argument("--template", type=Path, help="the mesh that has landmarks")
    parser.add_argument("--landmarks", type=Path, help="its landmarks: .csv, .mrk.json, .fcsv, .tps, .pts, .pp, ...")
    parser.add_argument("-o", "--output", type=Path, default=Path("morphometrics"), help="folder for the results")
    parser.add_argument("--up", choices=UP, default="z", help="the axis of the meshes that points up in the pictures")
    given = parser.parse_args(arguments)
    if given.folder is None:
        template, marks, others = built_in()
        run(iter(others.items()), ("template", template), marks, given.output)
        return
    if given.template is None or given.landmarks is None:
        parser.error("a folder needs --template and --landmarks")
    specimens = in_folder(given.folder, given.template)
    template = given.template.stem, read_mesh(given.template)
    run(specimens, template, read_landmarks(given.landmarks), given.output, UP[given.up])


if __name__ == "__main__":
    main()

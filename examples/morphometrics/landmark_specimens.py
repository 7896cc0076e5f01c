"""A folder of specimens and one landmarked template: tables of landmarks and shapes, pictures, what needs a look.

python landmark_specimens.py [OUT]      five built-in animals, one of them cut in half

For a folder of your own: gmds landmarks FOLDER --template T.ply --landmarks T.mrk.json -o OUT
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from geodesics import Mesh, write_mesh
from gmds.batch import local_client
from gmds.landmarks.files import Landmarks, read_landmarks, write_landmarks
from gmds.shapes import quadruped
from gmds.specimens.carried import Landmarked, landmark_folder
from gmds.specimens.drawing import write_pictures
from gmds.specimens.tables import write_tables

UP = (0, 0, 1)  # in the pictures


def write_animals(folder: Path, n_vertices: int = 1500) -> None:
    """A template with landmarks, and others in other poses with parts of other sizes; the last lacks its hind half."""
    folder.mkdir(parents=True, exist_ok=True)
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
    write_landmarks(folder / "template.csv", Landmarks(tuple(places), np.array(list(places.values()))))
    large_head = quadruped("walk", head_scale=1.6, n_vertices=n_vertices, seed=1)
    front = large_head.rest[large_head.faces][..., 0].mean(axis=1) > np.median(large_head.rest[:, 0])
    animals = {
        "template": template,
        "large_head": large_head,
        "long_legs": quadruped("graze", leg_scale=1.3, n_vertices=n_vertices, seed=2),
        "small_ears": quadruped("turn", ear_scale=0.6, n_vertices=n_vertices, seed=3),
        "long_tail": quadruped("walk", tail_scale=1.5, n_vertices=n_vertices, seed=4),
        "front_half": Mesh(large_head.vertices, large_head.faces[front]),
    }
    for name, mesh in animals.items():
        write_mesh(mesh, folder / f"{name}.ply")


def run(out: Path, n_vertices: int = 1500) -> Landmarked:
    """All of it, into a folder."""
    write_animals(out / "animals", n_vertices)
    template, marks = out / "animals" / "template.ply", read_landmarks(out / "animals" / "template.csv")
    found = landmark_folder(out / "animals", template, marks, out / "maps", client=local_client(1), progress=tell)
    for name, why in write_tables(out, found):
        print(f"needs a look: {name}: {why}")
    write_pictures(out, found, UP)
    return found


def tell(stage: str, fraction: float) -> None:
    print(f"{stage} ({100 * fraction:.0f} %)")


if __name__ == "__main__":
    run(Path(sys.argv[1] if len(sys.argv) > 1 else "morphometrics"))

"""dog.ply, wolf.off and all other files of the documentation: two built-in animals, and what belongs to them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from geodesics import Mesh, SurfacePoints, read_mesh, write_mesh
from geodesics.arrays import Floats, Integers
from gmds.correspondence import Correspondence
from gmds.demo.character import write_character
from gmds.shapes import quadruped, truth

VERTICES = 5000  # of dog.ply and wolf.off, as in the pages
HEAD = 2.0  # size of the wolf's head by the dog's, as in `gmds.shapes.demo_pair`
BONES = 4  # of bones.npy; set by hand
BLEND = 0.6  # of the way from bone to bone, over which one hands over to the next; set by hand
GRADES = 256  # of the weights of a bone: their sums are 1 exactly, in files of single precision as well


@dataclass(frozen=True)
class Pair:
    """Dog and wolf as they are read, and for every vertex of the dog the nearest one of the wolf."""

    dog: Mesh
    wolf: Mesh
    vertices: Integers


def write_files(folder: Path, n_vertices: int = VERTICES) -> list[str]:
    """Write them all, with so many vertices; their names."""
    folder.mkdir(parents=True, exist_ok=True)
    before = {path for path in folder.rglob("*") if path.is_file()}
    pair = _write_pair(folder, n_vertices)
    _write_landmarks(folder, pair)
    weights = _write_values(folder, pair.wolf)
    _write_looks(folder, pair.wolf, weights)
    _write_collections(folder, max(n_vertices // 5, 60))
    made = {path for path in folder.rglob("*") if path.is_file()} - before
    return sorted(path.relative_to(folder).as_posix() for path in made)


def _write_pair(folder: Path, n: int) -> Pair:
    """dog.ply, wolf.off, half-dog.ply, scan.ply, both in the frame RAS, the true map, and the truth for a benchmark."""
    figures = quadruped(n_vertices=n), quadruped("walk", head_scale=HEAD, n_vertices=n + 10, seed=1)
    true = truth(*figures)
    for figure, name in zip(figures, ("dog.ply", "wolf.off"), strict=True):
        exact = Mesh(figure.vertices.astype(np.float32), figure.faces)  # the same in all formats
        write_mesh(exact, folder / name)
    source, target = read_mesh(folder / "dog.ply"), read_mesh(folder / "wolf.off")
    Correspondence.from_points(source, SurfacePoints(target, true.face, true.barycentric)).save(folder / "map.npz")
    vertices = true.nearest_vertices()
    np.savez(folder / "truth.npz", src=np.arange(n), gt=vertices)
    front = (source.vertices[source.faces][:, :, 0] > -0.1).all(axis=1)
    kept, rows = np.unique(source.faces[front], return_inverse=True)
    write_mesh(Mesh(source.vertices[kept], rows.reshape(-1, 3)), folder / "half-dog.ply")
    for name, mesh in (("ras-dog.ply", source), ("ras-wolf.off", target)):
        write_mesh(Mesh(mesh.vertices * [-1, -1, 1], mesh.faces), folder / name)
    write_mesh(quadruped(n_vertices=max(n, 3000)), folder / "scan.ply")
    return Pair(source, target, vertices)


def _write_landmarks(folder: Path, pair: Pair) -> None:
    from gmds.landmarks.files import Landmarks, write_landmarks

    x, y, z = pair.dog.vertices.T
    names, at = ("nose", "tail", "paw"), [int(row) for row in (x.argmax(), x.argmin(), (x + y - 4 * z).argmax())]
    for name in ("dog.csv", "dog.mrk.json"):
        write_landmarks(folder / name, Landmarks(names, pair.dog.vertices[at]))
    for name in ("wolf.csv", "known-wolf.csv", "wolf.fcsv"):
        write_landmarks(folder / name, Landmarks(names, pair.wolf.vertices[pair.vertices[at]]))


def _write_values(folder: Path, wolf: Mesh) -> Floats:
    """Heights, parts and weights of bones, which are returned: a row for every vertex of the wolf."""
    np.savetxt(folder / "heights.csv", wolf.vertices[:, 2])
    (folder / "parts.txt").write_text("\n".join(np.where(wolf.vertices[:, 2] > 1, "1", "2")))
    along = np.linspace(wolf.vertices[:, 0].min(), wolf.vertices[:, 0].max(), BONES)
    weights = np.exp(-(((wolf.vertices[:, :1] - along) / (BLEND * (along[1] - along[0]))) ** 2))
    weights = np.rint(GRADES * weights / weights.sum(axis=1, keepdims=True)) / GRADES
    weights[np.arange(len(weights)), weights.argmax(axis=1)] += 1 - weights.sum(axis=1)
    np.save(folder / "bones.npy", weights)
    return np.asarray(weights)


def _write_looks(folder: Path, wolf: Mesh, weights: Floats) -> None:
    """The wolf with colours, with a texture of two charts, and as a rigged character; all but the first need Pillow."""
    from gmds.appearance import Look, write_look

    try:
        from PIL import Image
    except ImportError:
        return
    colours = np.full((wolf.n_vertices, 3), 120, dtype=np.uint8)
    colours[wolf.vertices[:, 2] > 1] = 200, 150, 90
    write_look(folder / "wolf.ply", wolf, Look(colours))
    corners = wolf.vertices[wolf.faces]
    uv = 0.1 * corners[..., [0, 2]] + np.where(corners[..., 1].mean(axis=1) < 0, 0.5, 0.0)[:, None, None]
    squares = np.add.outer(np.arange(64) // 4, np.arange(64) // 4) % 2
    image = Image.fromarray(np.array([(200, 150, 90), (90, 110, 150)], dtype=np.uint8)[squares])
    for name in ("wolf.obj", "wolf.glb"):
        write_look(folder / name, wolf, Look(uv=uv, image=image))
    write_character(folder / "character.glb", wolf, weights, image)


def _write_collections(folder: Path, n: int) -> None:
    """meshes/, pairs.txt, and dataset/ as a published benchmark has it."""
    few = {"dog": quadruped(n_vertices=n), "cat": quadruped("walk", n_vertices=n), "wolf": quadruped(n_vertices=n + 10)}
    (folder / "meshes").mkdir(exist_ok=True)
    (folder / "dataset" / "corres").mkdir(parents=True, exist_ok=True)
    for name, mesh in few.items():
        write_mesh(mesh, folder / "meshes" / f"{name}.ply")
        write_mesh(mesh, folder / "dataset" / f"{name}.off")
        places = truth(few["dog"], mesh).nearest_vertices()
        (folder / "dataset" / "corres" / f"{name}.vts").write_text("\n".join(str(i + 1) for i in places))
    (folder / "dataset" / "test_pairs.txt").write_text("dog cat\ndog wolf\n")
    (folder / "pairs.txt").write_text("meshes/dog.ply,meshes/cat.ply\n")

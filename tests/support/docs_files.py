"""The files that README, docs and the help of commands speak of, as small built-in shapes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import gmds
from geodesics import Mesh, SurfacePoints, read_mesh, write_mesh
from gmds import Correspondence
from gmds.appearance import Look, write_look
from gmds.landmarks.files import Landmarks, write_landmarks
from gmds.matching.pipeline import SAMPLES
from gmds.shapes import Figure, quadruped, truth

N = 300  # vertices; fewer are matched badly
DEFAULTS = ("None", "0", "'preserve'", "'auto'", repr(gmds.LeastSquares()), str(SAMPLES))  # of the options of `match`


def small_pair() -> tuple[Figure, Figure, SurfacePoints]:
    """As `gmds.shapes.demo_pair`, with fewer vertices."""
    source, target = quadruped(n_vertices=N), quadruped("walk", head_scale=2.0, n_vertices=N + 10, seed=1)
    return source, target, truth(source, target)


def write_files(folder: Path) -> None:
    """dog.ply, half-dog.ply, wolf.off, the true map between them, landmarks, values, looks, folders."""
    dog, wolf, true = small_pair()
    exact = [Mesh(mesh.vertices.astype(np.float32), mesh.faces) for mesh in (dog, wolf)]  # the same in all formats
    write_mesh(exact[0], folder / "dog.ply")
    write_mesh(exact[1], folder / "wolf.off")
    source, target = read_mesh(folder / "dog.ply"), read_mesh(folder / "wolf.off")
    points = SurfacePoints(target, true.face, true.barycentric)
    Correspondence.from_points(source, points).save(folder / "map.npz")
    vertices = true.nearest_vertices()
    np.savez(folder / "truth.npz", src=np.arange(N), gt=vertices)
    front = (source.vertices[source.faces][:, :, 0] > -0.1).all(axis=1)
    kept, rows = np.unique(source.faces[front], return_inverse=True)
    write_mesh(Mesh(source.vertices[kept], rows.reshape(-1, 3)), folder / "half-dog.ply")
    _write_landmarks(folder, source, target, vertices)
    for name, mesh in (("ras-dog.ply", source), ("ras-wolf.off", target)):
        write_mesh(Mesh(mesh.vertices * [-1, -1, 1], mesh.faces), folder / name)
    write_mesh(quadruped(n_vertices=3000), folder / "scan.ply")
    np.savetxt(folder / "heights.csv", target.vertices[:, 2])
    (folder / "parts.txt").write_text("\n".join(np.where(target.vertices[:, 2] > 1, "1", "2")))
    np.save(folder / "bones.npy", np.random.default_rng(0).dirichlet(np.ones(4), target.n_vertices))
    _write_looks(folder, target)
    _write_collections(folder)


def _write_looks(folder: Path, wolf: Mesh) -> None:
    """The wolf with colours, and with a texture of two charts."""
    from PIL import Image

    colours = np.full((wolf.n_vertices, 3), 120, dtype=np.uint8)
    write_look(folder / "wolf.ply", wolf, Look(colours))
    corners = wolf.vertices[wolf.faces]
    uv = 0.1 * corners[..., [0, 2]] + np.where(corners[..., 1].mean(axis=1) < 0, 0.5, 0.0)[:, None, None]
    for name in ("wolf.obj", "wolf.glb"):
        write_look(folder / name, wolf, Look(uv=uv, image=Image.new("RGB", (8, 8), (200, 150, 90))))


def _write_landmarks(folder: Path, source: Mesh, target: Mesh, vertices: Any) -> None:
    names, at = ("nose", "tail", "paw"), [int(source.vertices[:, i].argmax()) for i in (0, 1, 2)]
    for name in ("dog.csv", "dog.mrk.json"):
        write_landmarks(folder / name, Landmarks(names, source.vertices[at]))
    for name in ("wolf.csv", "known-wolf.csv", "wolf.fcsv"):
        write_landmarks(folder / name, Landmarks(names, target.vertices[vertices[at]]))


def _write_collections(folder: Path) -> None:
    few = {"dog": quadruped(n_vertices=60), "cat": quadruped("walk", n_vertices=60), "wolf": quadruped(n_vertices=70)}
    (folder / "meshes").mkdir()
    (folder / "dataset" / "corres").mkdir(parents=True)
    for name, mesh in few.items():
        write_mesh(mesh, folder / "meshes" / f"{name}.ply")
        write_mesh(mesh, folder / "dataset" / f"{name}.off")
        places = truth(few["dog"], mesh).nearest_vertices()
        (folder / "dataset" / "corres" / f"{name}.vts").write_text("\n".join(str(i + 1) for i in places))
    (folder / "dataset" / "test_pairs.txt").write_text("dog cat\ndog wolf\n")
    (folder / "pairs.txt").write_text("meshes/dog.ply,meshes/cat.ply\n")


def remembering(match: Callable[..., Correspondence]) -> Callable[..., Correspondence]:
    """`match` that does the same work once: for equal meshes and options it gives the answer it gave before."""
    known: dict[Any, Correspondence] = {}

    def remembered(source: Mesh, target: Mesh, *, progress: Any = None, **options: Any) -> Correspondence:
        given = tuple(a.tobytes() for mesh in (source, target) for a in (mesh.vertices, mesh.faces))
        chosen = [(name, repr(value)) for name, value in sorted(options.items()) if repr(value) not in DEFAULTS]
        key = (given, tuple(chosen))
        if key not in known:
            known[key] = match(source, target, progress=progress, **options)
        answer = known[key]

        def here(points: SurfacePoints) -> SurfacePoints:
            return SurfacePoints(target, points.face, points.barycentric)

        others = tuple(replace(other, points=here(other.points)) for other in answer.candidates)
        return replace(answer, source=source, target=target, points=here(answer.points), candidates=others)

    return remembered


match = remembering(gmds.match)

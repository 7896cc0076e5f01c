"""Readers of this project and sound files for each, as the fuzzer damages them."""

from __future__ import annotations

import functools
import sys
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

from file_cases import F_TEXT, OBJ, OFF, PLY, READ, STL, STL_BINARY, V_TEXT, binary_ply, glb
from shapes import bumpy_sphere, icosphere

from geodesics import SurfacePoints, read_mesh
from gmds.batch.pair_list import read_list
from gmds.cli.landmark_file import read_landmarks as read_marks
from gmds.cli.values_file import read_values
from gmds.correspondence import Correspondence
from gmds.landmark_files import Landmarks, read_landmarks, write_landmarks
from gmds.surface import measure
from gmds.surface_file import read_surface, write_surface
from gmds.truth_files import read_landmarks_mat, read_truth_npz, read_vts

SOURCE, TARGET = icosphere(0), icosphere(1)


@dataclass(frozen=True)
class Target:
    """A reader, the name its files have, sound contents, and what must hold of an answer."""

    read: Callable[[Path], Any]
    name: str
    sound: Callable[[], list[bytes]]
    holds: Callable[[Any], bool] = lambda answer: True


def _mesh_holds(mesh: Any) -> bool:
    inside = mesh.faces.min() >= 0 and mesh.faces.max() < mesh.n_vertices
    return bool(np.isfinite(mesh.vertices).all() and inside and mesh.area > 0)


def _map_holds(answer: Correspondence) -> bool:
    rows = len(answer.points) == len(answer.valid) == len(answer.distortion) == SOURCE.n_vertices
    return bool(rows and np.isfinite(answer.points.positions).all() and np.isfinite(answer.distortion).all())


def _marks_hold(found: Landmarks) -> bool:
    return len(found.names) == len(found.at) > 0 and bool(np.isfinite(found.at).all())


def _cases(*names: str) -> Callable[[], list[bytes]]:
    def sound() -> list[bytes]:
        by_name = {name: content for _, name, content in READ}
        return [content if isinstance(content, bytes) else content.encode() for content in map(by_name.get, names)]  # type: ignore[union-attr]

    return sound


def _written(name: str, write: Callable[[Path], object]) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        write(Path(folder) / name)
        return (Path(folder) / name).read_bytes()


def _maps() -> list[bytes]:
    points = SurfacePoints.at_vertices(TARGET, np.arange(SOURCE.n_vertices))
    answer = Correspondence.from_points(SOURCE, points, meta={"seed": 1, "parameters": {"a": [1.5, "b"]}})
    stored = {"face": points.face, "barycentric": points.barycentric, "vertex": answer.vertex_map()}
    return [_written("m.npz", answer.save), _written("m.npz", lambda path: np.savez(path, **stored))]


def _marks(ending: str) -> list[bytes]:
    space = Landmarks(("nose", "left ear", "=tail"), np.array([[0.1, 2, 3e-5], [-1, 0, 0], [7, 8, 9.25]]))
    at = Landmarks(("1", "2", "3"), np.array([5, 0, 11]))
    kinds = [at] if ending == ".vts" else [space, at] if ending == ".csv" else [space]
    return [_written(f"a{ending}", functools.partial(write_landmarks, landmarks=marks)) for marks in kinds]


TARGETS: Mapping[str, Target] = {
    "OFF": Target(read_mesh, "a.off", lambda: [OFF.encode(), *_cases("colours.off", "comments.off")()], _mesh_holds),
    "OBJ": Target(read_mesh, "a.obj", lambda: [OBJ.encode(), *_cases("seam.obj", "more.obj")()], _mesh_holds),
    "PLY, text": Target(read_mesh, "a.ply", lambda: [PLY.encode(), *_cases("elements.ply")()], _mesh_holds),
    "PLY, binary": Target(read_mesh, "b.ply", lambda: [binary_ply(extra=True), binary_ply(">")], _mesh_holds),
    "STL, text": Target(read_mesh, "a.stl", lambda: [STL.encode(), *_cases("two.stl")()], _mesh_holds),
    "STL, binary": Target(read_mesh, "b.stl", lambda: [STL_BINARY], _mesh_holds),
    "GLB": Target(read_mesh, "a.glb", lambda: [glb(), *_cases("loop.glb")()], _mesh_holds),
    "TOSCA": Target(read_mesh, "a.tri", lambda: [F_TEXT.replace("3 ", "", 1).encode(), b"1 2 3\n1 3 4\n"], _mesh_holds),
    "map": Target(lambda path: Correspondence.load(path, SOURCE, TARGET), "m.npz", _maps, _map_holds),
    "measured surface": Target(
        read_surface, "s.npz", lambda: [_written("s.npz", lambda p: write_surface(p, measure(bumpy_sphere(1))))]
    ),
    **{
        f"landmarks, {ending}": Target(read_landmarks, f"a{ending}", functools.partial(_marks, ending), _marks_hold)
        for ending in (".csv", ".mrk.json", ".fcsv", ".tps", ".pts", ".vts")
    },
    "landmark pairs": Target(read_marks, "a.txt", lambda: [b"0 0\n5, 5  # nose\n", b"0 0 1; 2.5 1e-3 -7\n"]),
    "pair list": Target(read_list, "a.txt", lambda: [b"a.off,b.off\nb.off, c.off\n", b"# all\na.off\nb.off\n"]),
    "values": Target(
        lambda path: read_values(path, 4), "a.csv", lambda: [b"value\n1\n2.5\n-3\n4e5\n", b"0\n1\n2\n3\n"]
    ),
    "truth, .vts": Target(read_vts, "t.vts", lambda: [b"1\n2\n30\n", b"7\n"]),
    "truth, .npz": Target(
        read_truth_npz, "t.npz", lambda: [_written("t.npz", lambda p: np.savez(p, src=np.arange(4), gt=np.arange(4)))]
    ),
    "truth, .mat": Target(read_landmarks_mat, "t.mat", lambda: [_written("t.mat", _write_mat)]),
}


def _write_mat(path: Path) -> None:
    from scipy.io import savemat

    table = {"points": np.array([[1], [2]]), "baryc": np.array([[3, 0.2, 0.3, 0.5], [1, 1, 0, 0]]), "verts": [[1], [5]]}
    savemat(path, table)


def beside(target: Target, folder: Path) -> None:
    """The sound file that must lie beside the damaged one."""
    if target.name == "a.tri":
        (folder / "a.vert").write_text(V_TEXT)

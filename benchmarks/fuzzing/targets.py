"""Readers of this project and sound files for each, as the fuzzer damages them.

MATLAB files are not among them: damaged ones end the process that reads them, which is why that is another one.
"""

from __future__ import annotations

import functools
import gzip
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from file_cases import F_TEXT, OBJ, OFF, PLY, STL, STL_BINARY, V_TEXT, binary_ply, glb

from benchmarks.fuzzing.contents import (
    LISTED,
    POLYGONS,
    SETTINGS,
    SOURCE,
    SPECIMENS,
    TARGET,
    UV,
    Contents,
    arrays,
    habits,
    maps,
    marks,
    member,
    of_cases,
    of_text,
    pictures,
    surfaces,
    with_member,
)
from geodesics import read_mesh
from gmds.appearance.reading import read_look
from gmds.batch.existing_maps import Expected, pair_record
from gmds.batch.pair_list import read_list
from gmds.batch.surface_file import read_surface
from gmds.benchmarking.datasets import dataset_pairs
from gmds.benchmarking.truth_files import read_truth_npz, read_vts
from gmds.characters.scene import read_scene
from gmds.cli.settings import TABLES, read_settings
from gmds.correspondence import Correspondence
from gmds.files.values import read_values
from gmds.landmarks.files import Landmarks, read_landmarks, read_specimens
from gmds.landmarks.pair_files import read_landmarks as read_marks


@dataclass(frozen=True)
class Target:
    """A reader, the name its files have, sound contents, and what must hold of an answer.

    `packed` makes the file of a content that was damaged: what is inside an archive is damaged before it is packed, as
    nothing else would get past the sums of the archive. `beside`: sound files that must lie in the same folder.
    """

    read: Callable[[Path], Any]
    name: str
    sound: Callable[[], Contents]
    holds: Callable[[Any], bool] = lambda answer: True
    packed: Callable[[bytes], bytes] = bytes
    beside: Mapping[str, str] = field(default_factory=dict)


def _mesh_holds(mesh: Any) -> bool:
    inside = mesh.faces.min() >= 0 and mesh.faces.max() < mesh.n_vertices
    return bool(np.isfinite(mesh.vertices).all() and inside and mesh.area > 0)


def _map_holds(answer: Correspondence) -> bool:
    rows = len(answer.points) == len(answer.valid) == len(answer.distortion) == SOURCE.n_vertices
    return bool(rows and np.isfinite(answer.points.positions).all() and np.isfinite(answer.distortion).all())


def _marks_hold(found: Landmarks) -> bool:
    placed = found.at[found.defined]
    return len(found.names) == len(found.at) > 0 and bool(np.isfinite(placed).all()) and bool(found.defined.any())


def _specimens_hold(found: Mapping[str, Landmarks]) -> bool:
    return len(found) > 0 and all(map(_marks_hold, found.values()))


def _settings_hold(found: Mapping[str, Any]) -> bool:
    return set(found) <= set(TABLES) and all(isinstance(table, Mapping) for table in found.values())


def _load(path: Path) -> Correspondence:
    return Correspondence.load(path, SOURCE, TARGET)


def _kept(path: Path) -> Any:
    return pair_record(path, "a", "b", Expected({"format": "gmds-map"}))


def _values(path: Path) -> Any:
    return read_values(path, 4)


def _labels(path: Path) -> Any:
    return read_values(path, 4, labels=True)


def _look(path: Path) -> Any:
    return read_look(path, read_mesh(path))


def _scene(path: Path) -> Any:
    return read_scene(path, read_mesh(path), rig=True)


def _texture(path: Path) -> Any:
    mesh = path.with_name("uv.obj")
    return read_look(mesh, read_mesh(mesh), path)


def _pairs(path: Path) -> Any:
    return dataset_pairs(path.parent, None if path.suffix == ".json" else path)


_FACES = F_TEXT.replace("3 ", "", 1)
MESHES: Mapping[str, Target] = {
    "OFF": Target(
        read_mesh, "a.off", lambda: [OFF.encode(), *of_cases("colours.off", "comments.off", "edges.off")()], _mesh_holds
    ),
    "OBJ": Target(
        read_mesh, "a.obj", lambda: [OBJ.encode(), *of_cases("seam.obj", "more.obj", "edges.obj")()], _mesh_holds
    ),
    "PLY, text": Target(
        read_mesh, "a.ply", lambda: [PLY.encode(), *of_cases("elements.ply", "edges.ply")()], _mesh_holds
    ),
    "PLY, binary": Target(read_mesh, "b.ply", of_text(binary_ply(extra=True), binary_ply(">")), _mesh_holds),
    "STL, text": Target(read_mesh, "a.stl", lambda: [STL.encode(), *of_cases("two.stl")()], _mesh_holds),
    "STL, binary": Target(read_mesh, "b.stl", of_text(STL_BINARY), _mesh_holds),
    "PLY, lists and strips": Target(
        read_mesh, "c.ply", of_cases("flags.ply", "lists.ply", "strips.ply", "strips_text.ply"), _mesh_holds
    ),
    "GLB": Target(read_mesh, "a.glb", of_cases("one.glb", "loop.glb"), _mesh_holds),
    "GLB, scenes": Target(
        read_mesh, "b.glb", of_cases("halves.glb", "apart.glb", "quantised.glb", "skinned.glb"), _mesh_holds
    ),
    "glTF": Target(read_mesh, "a.gltf", of_cases("inside.gltf"), _mesh_holds),
    "VTK, text": Target(
        read_mesh, "a.vtk", of_cases("text3.0.vtk", "text5.1.vtk", "text5.0grid.vtk", "strips.vtk"), _mesh_holds
    ),
    "VTK, binary": Target(
        read_mesh, "b.vtk", of_cases("binary3.0.vtk", "binary5.1.vtk", "binary4.2grid.vtk", "field.vtk"), _mesh_holds
    ),
    "VTP, text": Target(read_mesh, "a.vtp", of_cases("ascii<u4.vtp"), _mesh_holds),
    "VTP, packed": Target(
        read_mesh,
        "b.vtp",
        of_cases(
            "binary<u4.vtp",
            "binaryvtkZLibDataCompressor.vtp",
            "rawvtkZLibDataCompressor.vtp",
            "raw>u8.vtp",
            "appendedvtkLZMADataCompressor.vtp",
            "rawvtkLZ4DataCompressor.vtp",
        ),
        _mesh_holds,
    ),
    "GIFTI": Target(read_mesh, "a.gii", of_cases("ASCII.gii", "Base64Binary.gii", "GZipBase64Binary.gii"), _mesh_holds),
    "FreeSurfer": Target(read_mesh, "lh.white", of_cases("lh.white", "longer.pial"), _mesh_holds),
    "FreeSurfer, text": Target(read_mesh, "a.asc", of_cases("lh.white.asc"), _mesh_holds),
    "polygons": Target(read_mesh, "p.obj", of_text(POLYGONS), _mesh_holds),
    "packed by gzip": Target(read_mesh, "a.off.gz", of_cases("a.off.gz"), _mesh_holds),
    "inside gzip": Target(read_mesh, "b.ply.gz", of_text(PLY), _mesh_holds, gzip.compress),
    **{
        f"habits of programs, {ending}": Target(read_mesh, f"h{ending}", habits(ending), _mesh_holds)
        for ending in (".ply", ".obj", ".off", ".stl", ".vtk", ".glb")
    },
    "TOSCA": Target(read_mesh, "a.tri", of_text(_FACES, "1 2 3\n1 3 4\n"), _mesh_holds, beside={"a.vert": V_TEXT}),
    "measured surface": Target(read_surface, "s.npz", surfaces),
    "colours, .obj": Target(_look, "a.obj", of_cases("colours.obj", "texture.obj", "more.obj")),
    "colours, .ply": Target(_look, "a.ply", of_cases("seams.ply", "face_colours.ply", "comment.ply")),
    "colours, .glb": Target(_look, "a.glb", of_text(glb())),
    "scenes, .glb": Target(_scene, "s.glb", of_cases("halves.glb", "apart.glb", "quantised.glb", "skinned.glb")),
    "texture": Target(_texture, "a.png", pictures, beside={"uv.obj": UV}),
}
MAPS: Mapping[str, Target] = {
    "map": Target(_load, "m.npz", maps, _map_holds),
    **{
        f"map, {name} inside": Target(_load, "m.npz", member(name), _map_holds, with_member(name))
        for name in ("meta", "face", "barycentric", "valid", "distortion")
    },
    "landmarks of a map": Target(read_marks, "m.npz", member("meta"), packed=with_member("meta")),
    "settings of a map": Target(read_settings, "m.npz", member("meta"), _settings_hold, with_member("meta")),
    "map, kept by a batch": Target(_kept, "m.npz", member("meta"), packed=with_member("meta")),
}
TEXTS: Mapping[str, Target] = {
    **{
        f"landmarks, {ending}": Target(read_landmarks, f"a{ending}", functools.partial(marks, ending), _marks_hold)
        for ending in (".csv", ".mrk.json", ".fcsv", ".tps", ".pts", ".vts", ".pp")
    },
    **{
        f"specimens, {ending}": Target(read_specimens, f"a{ending}", of_text(*texts), _specimens_hold)
        for ending, texts in SPECIMENS.items()
    },
    "landmark pairs": Target(read_marks, "a.txt", of_text("0 0\n5, 5  # nose\n", "0 0 1; 2.5 1e-3 -7\n")),
    "pair list": Target(read_list, "a.txt", of_text("a.off,b.off\nb.off, c.off\n", "# all\na.off\nb.off\n")),
    "settings": Target(read_settings, "a.toml", of_text(SETTINGS), _settings_hold),
    "values, .csv": Target(
        _values, "a.csv", of_text("value\n1\n2.5\n-3\n4e5\n", "0\n1\n2\n3\n", "1;2,5\n2;3\n3;4\n4;5\n")
    ),
    "values, .txt": Target(_labels, "a.txt", of_text("a 1\nb 2\n\n\xe9 3\nd 4\n", "0\n1\n2\n3\n")),
    "values, .npy": Target(_values, "a.npy", arrays(only=np.arange(8.0).reshape(4, 2))),
    "truth, .vts": Target(read_vts, "t.vts", of_text("1\n2\n30\n", "7\n")),
    "truth, .npz": Target(read_truth_npz, "t.npz", arrays(src=np.arange(4), gt=np.arange(4))),
    "pairs of a benchmark": Target(
        _pairs, "test_pairs.txt", of_text("# all\na b\nb, c\n"), beside={"corres/a.vts": "1\n"}
    ),
    "pairs.json": Target(_pairs, "pairs.json", of_text(LISTED)),
}
TARGETS: Mapping[str, Target] = {**MESHES, **MAPS, **TEXTS}


def lay_beside(target: Target, folder: Path) -> None:
    """Write the sound files that must lie beside the damaged one."""
    for name, content in target.beside.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(content, encoding="utf-8")

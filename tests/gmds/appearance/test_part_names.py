"""Objects, groups and materials of an OBJ, face by face along a map."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from generated_shapes import bumpy_sphere, subdivided

from geodesics import Mesh, SurfacePoints, read_mesh
from gmds.appearance import Look, carry_names, read_look, write_look
from gmds.cli import main
from gmds.correspondence import Correspondence

SHAPE = bumpy_sphere(2)
UPPER = (SHAPE.vertices[SHAPE.faces].mean(axis=1)[:, 2] > 0).tolist()


def named(uv: bool = False) -> str:
    """An OBJ with a head and a body, each of a material of its own, once they change in the order of faces."""
    lines = ["mtllib the wolf.mtl", *("v {!r} {!r} {!r}".format(*p) for p in SHAPE.vertices.tolist())]
    lines += ["vt 0 0", "vt 1 0", "vt 0 1"] if uv else []
    lines.append("o wolf")
    for face, upper in zip((SHAPE.faces + 1).tolist(), UPPER, strict=True):
        lines += [f"g {'head' if upper else 'body'}", f"usemtl {'Größe #1' if upper else 'fur'}"]
        lines.append("f " + " ".join(f"{i}/{t}" if uv else str(i) for t, i in enumerate(face, start=1)))
    return "\n".join(lines) + "\n"


def under(path: Path) -> list[tuple[str, ...]]:
    """Object, group and material of each face, as another reader has it."""
    now, found = {"o": "", "g": "", "usemtl": ""}, []
    for line in path.read_text(encoding="utf-8").splitlines():
        word, _, rest = line.partition(" ")
        if word in now:
            now[word] = rest
        elif word == "f":
            found.append(tuple(now.values()))
    return found


def run(folder: Path, source: Mesh, *more: str) -> tuple[dict, str]:
    lines = ["v {!r} {!r} {!r}".format(*p) for p in source.vertices.tolist()]
    lines += ["f {} {} {}".format(*face) for face in (source.faces + 1).tolist()]
    (folder / "dog.obj").write_text("\n".join(lines) + "\n", encoding="utf-8")
    target = read_mesh(folder / "wolf.obj")
    points = SurfacePoints.closest(target, source.vertices)
    Correspondence.from_points(read_mesh(folder / "dog.obj"), points).save(folder / "map.npz")
    files = ["--source", str(folder / "dog.obj"), "--target", str(folder / "wolf.obj"), "-o", str(folder / "out.obj")]
    done = CliRunner().invoke(main, ["transfer", str(folder / "map.npz"), *files, *more, "--json"])
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout), done.stderr


EXPECTED = [("wolf", "head", "Größe #1") if upper else ("wolf", "body", "fur") for upper in UPPER]


def test_the_same_mesh_keeps_every_name_in_its_place(tmp_path: Path) -> None:
    (tmp_path / "wolf.obj").write_text(named(), encoding="utf-8")
    result, told = run(tmp_path, SHAPE)
    assert under(tmp_path / "out.obj") == EXPECTED
    assert result["carried"] == "names" and sorted(result["materials"]) == ["Größe #1", "fur"]
    assert "the wolf.mtl is named in out.obj and not copied" in told and "not carried" not in told
    assert "mtllib the wolf.mtl" in (tmp_path / "out.obj").read_text(encoding="utf-8")
    assert np.array_equal(read_mesh(tmp_path / "out.obj").faces, SHAPE.faces)


def test_other_triangles_get_the_name_of_where_their_middle_goes(tmp_path: Path) -> None:
    (tmp_path / "wolf.obj").write_text(named(), encoding="utf-8")
    fine = subdivided(SHAPE)
    run(tmp_path, fine)
    upper = [name == ("wolf", "head", "Größe #1") for name in under(tmp_path / "out.obj")]
    middle = SurfacePoints.closest(SHAPE, fine.vertices[fine.faces].mean(axis=1)).face
    assert upper == [UPPER[face] for face in middle]


def test_one_image_goes_to_every_material(tmp_path: Path) -> None:
    image = pytest.importorskip("PIL.Image")
    (tmp_path / "wolf.obj").write_text(named(uv=True), encoding="utf-8")
    image.new("RGB", (4, 4)).save(tmp_path / "wolf.png")
    _, told = run(tmp_path, SHAPE, "--texture", str(tmp_path / "wolf.png"))
    assert "has 2 materials (fur, Größe #1), which get one image" in told or "(Größe #1, fur), which" in told
    assert under(tmp_path / "out.obj") == EXPECTED
    written = (tmp_path / "out.mtl").read_text(encoding="utf-8")
    assert written.count("map_Kd out.png") == 2 and "newmtl Größe #1" in written


def test_faces_without_a_name_behind_those_that_have_one(tmp_path: Path) -> None:
    text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 2 0\ng a\nf 1 2 3 4\nf 1 2\ng\nf 4 3 5\n"
    (tmp_path / "a.obj").write_text(text, encoding="utf-8")
    mesh = read_mesh(tmp_path / "a.obj")
    names = read_look(tmp_path / "a.obj", mesh).names
    assert names is not None and [names.called[i][1] for i in names.face] == ["a", "a", ""]
    answer = Correspondence.from_points(mesh, SurfacePoints.at_vertices(mesh, np.arange(5)))
    write_look(tmp_path / "b.obj", mesh, Look(names=carry_names(answer, names)))
    assert (tmp_path / "b.obj").read_text(encoding="utf-8").splitlines()[5:] == [
        "g a", "f 1 2 3", "f 1 3 4", "g default", "f 4 3 5",
    ]  # fmt: skip


def test_parts_of_a_scene_are_groups(tmp_path: Path) -> None:
    from file_cases import glb
    from other_formats import halves

    (tmp_path / "a.glb").write_bytes(glb(halves))
    mesh = read_mesh(tmp_path / "a.glb")
    names = read_look(tmp_path / "a.glb", mesh).names
    assert names is not None and names.materials == ("skin",) and names.face.tolist() == [0, 0, 1, 1]

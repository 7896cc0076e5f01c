"""A file cut short at any byte is refused, or it is the same mesh (row F07 of the reliability table)."""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path

import numpy as np
import pytest
from child_reader import read_in_child
from file_cases import OFF, PLY, PLY_HEAD, READ, STL
from generated_shapes import icosphere, rectangle

from geodesics import FormatError, read_mesh, write_mesh
from geodesics.io.truncation import refuse_cut_face


def in_every_format(folder: Path) -> list[Path]:
    paths = []
    for label, mesh in (("closed", icosphere(1)), ("open", rectangle(4, 4))):
        for suffix in (".off", ".obj", ".ply", ".stl", ".glb", ".tri"):
            write_mesh(mesh, folder / f"{label}{suffix}")
            paths.append(folder / f"{label}{suffix}")
    for name, content in (
        ("tetra.off", OFF),
        ("tetra.ply", PLY),
        ("tetra.stl", STL),
        ("seams.obj", {name: content for _, name, content in READ}["texture.obj"]),
    ):
        (folder / name).write_text(str(content))
        paths.append(folder / name)
    return paths


def declares_nothing(path: Path) -> bool:
    """Formats that tell no counts, where nothing can show that whole lines are missing."""
    return path.suffix == ".tri" or path.name in ("seams.obj", "tetra.stl")


def test_f07_no_truncation_at_any_byte_passes_as_another_mesh(tmp_path: Path) -> None:
    jobs, sizes = [], []
    for path in in_every_format(tmp_path):
        size = path.stat().st_size
        step = max(1, size // 150)
        cut = sorted({*range(0, size, step), *range(min(150, size)), *range(max(0, size - 150), size)})
        target = tmp_path / "cut" / path.name
        target.parent.mkdir(exist_ok=True)
        if path.suffix == ".tri":
            target.with_suffix(".vert").write_bytes(path.with_suffix(".vert").read_bytes())
        jobs.append({"path": str(path), "cut": cut, "target": str(target)})
        sizes.append((path, cut))
    found = iter(read_in_child(jobs))
    refused = 0
    for path, cut in sizes:
        whole = read_mesh(path)
        for size in cut:
            outcome = next(found)
            if "faces" in outcome and declares_nothing(path):
                assert outcome["faces"] == whole.faces[: len(outcome["faces"])].tolist(), (path.name, size)
            elif "faces" in outcome:
                assert np.array_equal(outcome["vertices"], whole.vertices), (path.name, size)
                assert np.array_equal(outcome["faces"], whole.faces), (path.name, size)
            else:
                assert outcome["code"] in {"E103", "E104", "E201", "E203", "E204", "E205", "E206", "E207", "E105"}, (
                    outcome
                )
                refused += 1
    assert refused > 2000


TEXTS = {  # format: what is above the vertices, before and after each face, and the index of the first vertex
    "off": ("OFF\n{} {} 0\n", "3 ", "", 0),
    "obj": ("", "f ", "", 1),
    "ply": (PLY_HEAD.replace("4", "{}"), "3 ", "", 0),
    "coloured.ply": (
        PLY_HEAD.replace("4", "{}").replace("indices\n", "indices\nproperty uchar red\n"),
        "3 ",
        " 255",
        0,
    ),
}


@pytest.mark.parametrize("name", TEXTS)
def test_a_last_digit_that_is_missing_is_missed(tmp_path: Path, name: str) -> None:
    """Vertex 40 or so of the last face has become 4; with something behind it the cut is seen to be elsewhere."""
    head, before, after, base = TEXTS[name]
    mesh = icosphere(1)
    faces = np.roll(mesh.faces, -1 - int(np.argmax(mesh.faces.max(axis=1))), axis=0)
    faces[-1] = np.roll(faces[-1], 2 - int(faces[-1].argmax()))
    assert faces[-1, 2] == 41
    lines = [("v " if name == "obj" else "") + " ".join(map(repr, row)) for row in mesh.vertices.tolist()]
    lines += [before + " ".join(map(str, row)) + after for row in (faces + base).tolist()]
    whole = head.format(mesh.n_vertices, mesh.n_faces) + "\n".join(lines)
    path = tmp_path / f"mesh.{name}"
    path.write_text(whole)
    assert np.array_equal(read_mesh(path).faces, faces)
    path.write_text(whole[:-1])
    with nullcontext() if after else pytest.raises(FormatError, match="E204"):
        assert np.array_equal(read_mesh(path).faces, faces)


@pytest.mark.parametrize(
    ("end", "last", "n_vertices", "base", "doubted"),
    [
        ("1", [0, 2, 1], 11, 0, True),  # 1 may have been 10
        ("1", [0, 2, 1], 10, 0, False),  # there is no vertex 10
        ("2", [0, 2, 1], 20, 1, True),  # counted from 1: may have been 20
        ("2", [0, 2, 1], 19, 1, False),
        ("0", [2, 1, 0], 100, 0, False),  # nobody writes 01
        ("1\n", [0, 2, 1], 100, 0, False),
        ("1 ", [0, 2, 1], 100, 0, False),
    ],
)
def test_only_an_index_that_may_have_lost_digits_is_doubted(
    end: str, last: list[int], n_vertices: int, base: int, doubted: bool
) -> None:
    def ask(neighbours: list[list[int]], any_size: bool = False) -> None:
        refuse_cut_face(f"3 0 2 {end}".encode(), [*neighbours, last], n_vertices, base, Path("a"), any_size=any_size)

    for neighbour in ([3, 4, 5], [3, 4, 5, 6]):  # a last face may well be smaller than others
        with pytest.raises(FormatError, match="E204") if doubted else nullcontext():
            ask([neighbour])
    ask([last[::-1]])  # every edge is shared: the face fits
    with nullcontext() if end.endswith("\n") else pytest.raises(FormatError, match="E204"):
        ask([[3, 4, 5, 6]], any_size=True)  # a quad may have lost its last corner

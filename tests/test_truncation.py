"""A file cut short at any byte is refused, or it is the same mesh (row F07 of the reliability table)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from file_cases import OFF, PLY, READ, STL
from reading import read_in_child
from shapes import icosphere, rectangle

from geodesics import read_mesh, write_mesh


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
    return path.suffix == ".tri" or path.name == "seams.obj"


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
                assert outcome["code"] in {"E104", "E201", "E203", "E204", "E205", "E206", "E207", "E105"}, outcome
                refused += 1
    assert refused > 2000

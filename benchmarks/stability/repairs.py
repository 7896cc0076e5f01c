"""Real meshes with real defects: checked, repaired, checked again, and used.

    GMDS_DATA=... python -m benchmarks.stability.repairs

Every mesh of tosca_hires, tosca_nonrigid_3k and shrec20 goes through `repair(mesh, cut=True, largest=True)`. It passes
when no warning is left, but for vertices at equal positions (W219) where edges of more than two faces were cut; when
the way back leads to the same positions; and when the metric, ten eigenpairs and a march from one vertex are finite.
Writes results/repairs.csv and results/repairs.md.
"""

from __future__ import annotations

import os
import sys
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.markdown import table
from benchmarks.places import RESULTS
from geodesics import GeodesicDistance, Mesh, SurfacePoints, eigenpairs, read_mesh, scale_invariant
from geodesics.check import check
from geodesics.io import atomic_write
from geodesics.repair.repairing import Repaired, repair
from gmds.files.table import write_table

FOLDERS = {"tosca_hires": "*.off", "tosca_nonrigid_3k": "*.vert", "shrec20/models": "*.obj"}


class Row(NamedTuple):
    """One mesh: what was found, what was done, what is left, and whether it can be used."""

    folder: str
    mesh: str
    vertices: int
    faces: int
    found: str
    vertices_after: int
    faces_after: int
    left: str
    passed: bool
    seconds: float


def warnings(mesh: Mesh) -> Counter[str]:
    """How many faces or vertices each warning means."""
    return Counter({note.code: note.count or 1 for note in check(mesh) if note.severity == "warning"})


def usable(mesh: Mesh) -> bool:
    """Whether the scale-invariant metric, its first eigenpairs and a march are finite."""
    metric = scale_invariant(mesh)
    found = eigenpairs(metric, 10)
    start = SurfacePoints(mesh, [0], [[1.0, 0, 0]])
    reached = GeodesicDistance(metric).field(start)
    arrays = (metric.l_sq, metric.mass, found.eigenvalues, found.eigenfunctions, reached)
    return all(bool(np.isfinite(array).all()) for array in arrays)


def leads_back(old: Mesh, new: Repaired) -> bool:
    """Whether the maps both ways name the same positions and faces."""
    there = new.new_vertex >= 0
    return bool(
        np.array_equal(new.mesh.vertices, old.vertices[new.vertex])
        and np.array_equal(np.sort(new.vertex[new.mesh.faces]), np.sort(old.faces[new.face]))
        and np.array_equal(new.mesh.vertices[new.new_vertex[there]], old.vertices[there])
    )


def row(folder: str, path: Path) -> Row:
    """One mesh from file to use."""
    mesh = read_mesh(path)
    start = time.process_time()
    found, new = warnings(mesh), repair(mesh, cut=True, largest=True)
    left = warnings(new.mesh)
    seconds = time.process_time() - start
    allowed = {"W219"} if found["W213"] or found["W214"] else set()
    passed = set(left) <= allowed and leads_back(mesh, new) and usable(new.mesh)
    told, remains = (", ".join(f"{code} {count}" for code, count in sorted(codes.items())) for codes in (found, left))
    sizes = (mesh.n_vertices, mesh.n_faces, told, new.mesh.n_vertices, new.mesh.n_faces, remains)
    return Row(folder, path.stem, *sizes, passed, round(seconds, 3))


def rows(data: Path) -> Iterator[Row]:
    """All meshes."""
    for folder, pattern in FOLDERS.items():
        for path in sorted((data / folder).glob(pattern)):
            yield row(folder, path)
            print(path.stem, file=sys.stderr)


def page(found: Sequence[Row]) -> str:
    """The table by folder, and the meshes that do not pass."""
    lines = [
        "# Repair of published meshes",
        "",
        "`python -m benchmarks.stability.repairs`; a row a mesh: [repairs.csv](repairs.csv).",
        "",
    ]
    cells = []
    for folder in dict.fromkeys(row.folder for row in found):
        here = [row for row in found if row.folder == folder]
        codes = Counter(item.split()[0] for row in here for item in row.found.split(", ") if item)
        defects = ", ".join(f"{code} in {count}" for code, count in sorted(codes.items()))
        kept = sum(row.faces_after for row in here) / sum(row.faces for row in here)
        passed = sum(row.passed for row in here)
        slowest = max(row.seconds for row in here)
        cells.append([folder, len(here), defects or "none", passed, f"{100 * kept:.1f} %", f"{slowest:.2f}"])
    head = ["folder", "meshes", "warnings before", "pass after", "faces kept", "slowest check, repair, check; CPU s"]
    lines += table(head, cells)
    failed = [row for row in found if not row.passed]
    lines += [f"Not passed: {', '.join(f'{row.mesh} ({row.left})' for row in failed)}." if failed else "All pass.", ""]
    return "\n".join(lines)


def main() -> None:
    """Run and write."""
    found = list(rows(Path(os.environ["GMDS_DATA"])))
    write_table(RESULTS / "repairs.csv", Row._fields, found)
    with atomic_write(RESULTS / "repairs.md") as stream:
        stream.write(page(found).encode("utf-8"))
    print(page(found))


if __name__ == "__main__":
    main()

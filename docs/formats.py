"""The table of mesh formats in docs/reference/files.md, measured by reading and writing; a test compares.

    python docs/formats.py         # writes it anew

Files are those of the tests (tests/support): each is read, and the table says what came of it: the codes of notes, or
that of the error.
"""

from __future__ import annotations

import re
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "reference" / "files.md"
TABLE = re.compile(r"(<!-- formats: begin -->\n).*?(<!-- formats: end -->)", re.DOTALL)
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "support")]


def read_as(folder: Path, name: str, content: str | bytes) -> str:
    """What comes of reading a file."""
    from geodesics import FormatError, MeshError, read_with_notes

    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    try:
        _, notes = read_with_notes(path)
    except (FormatError, MeshError) as error:
        return f"refused, {error.code}"
    told = ", ".join(sorted({note.code for note in notes}))
    return f"read, {told}" if told else "read"


def writable(folder: Path, suffix: str) -> str:
    """Whether a mesh comes back from a file of that ending, and how exactly."""
    import numpy as np
    from generated_shapes import bumpy_sphere

    from geodesics import FormatError, read_mesh, write_mesh

    mesh = bumpy_sphere(1)
    try:
        write_mesh(mesh, folder / f"a{suffix}")
    except FormatError:
        return "not written"
    again = read_mesh(folder / f"a{suffix}")
    exact = np.array_equal(again.vertices, mesh.vertices) and np.array_equal(again.faces, mesh.faces)
    return "written, every bit" if exact else "written, single precision"


def rows() -> Iterator[str]:
    """The lines of the table."""
    from format_cases import BESIDE, CASES

    yield from ("| format | what is in the file | reading | writing |", "|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name, content in BESIDE.items():
            (Path(folder) / name).write_text(content, encoding="utf-8")
        for title, suffix, cases in CASES:
            written = writable(Path(folder), suffix)
            for what, name, content in cases:
                yield f"| {title} | {what} | {read_as(Path(folder), name, content)} | {written} |"
                title, written = "", ""


def with_table(page: str) -> str:
    """The page with the table as it is now."""
    text = "\n".join(rows())
    return TABLE.sub(lambda found: f"{found[1]}{text}\n{found[2]}", page)


if __name__ == "__main__":
    PAGE.write_text(with_table(PAGE.read_text(encoding="utf-8")), encoding="utf-8")

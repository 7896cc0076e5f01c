"""Sound contents of files for the fuzzer to damage."""

from __future__ import annotations

import functools
import io
import json
import tempfile
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from file_cases import OBJ_V, READ
from generated_shapes import bumpy_sphere, icosphere
from odd_exporters import READ as ODD
from other_formats import NEURO, OTHERS

from geodesics import SurfacePoints
from gmds import __version__
from gmds.batch.surface_file import write_surface
from gmds.correspondence import Correspondence
from gmds.landmarks.files import Landmarks, write_landmarks
from gmds.maps.point_map import Candidate
from gmds.mds.losses import LeastSquares
from gmds.provenance import method_in_words
from gmds.surface.measured import measure

Contents = list[bytes]

SOURCE, TARGET = icosphere(0), icosphere(1)
UV = OBJ_V + "vt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/2\nf 1/1 4/2 2/2\nf 2/2 4/2 3/3\n"
POLYGONS = "v 1 2 0\nv 0 2 0\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0.1\nv 3 3 3\nf 1 2 3 4 5 6\nf 6 5 7\nf 1 6 4 7\n"
LISTED = json.dumps([{"name": "a", "source": "s/a.off", "target": "s/b.off", "truth": "a.npz", "group": "self"}])
SPECIMENS = {
    ".tps": ("LM3=2\n1 2 3\nNA NA NA\nID=fox\nSCALE=0.5\n\nLM3=2\n1 2 3\n4 5 6\nIMAGE=cow.ply\n",),
    ".csv": (
        "ID,X1,Y1,Z1,X2,Y2,Z2\nfox,1,2,3,4,5,6\ncow,1,2,3,NA,NA,NA\n",
        "specimen;name;x;y;z\nfox;a;1,5;2;3\n",
        "id,sex,x1,x2,y1,y2,z1,z2,\nfox,m,1,4,2,5,3,6,\n",
        "sep=;\nid;nose.x;nose.y;nose.z;a1.x;a1.y;a1.z\nfox;1;2;3;4;5;6\n",
    ),
    ".fcsv": ("# version = 2\n# label: x,y,z,sel,vis\nP1,1,2,3,1,1\nP2,4,5,6,1,1\n",),
    ".pts": ("1,2,3\n4,5,6\n", "# by hand\na;1,5;2;3\n"),
    ".nts": ("1 2L 6 1 -9 dim=3\nfox cow\n1 2 3 4 5 6\n1 2 3 -9 -9 -9\n", "1 2L 3 0 dim=3\na b\n1 2 3\n4 5 6\n"),
    ".txt": ("2\n1 2 3\n4,5 5 6e-1\n", "name x y z\na 1 2 3\nb NA NA NA\n", "//X Y Z Label\n1 2 3 a\n", "1,2,3,a\n"),
    ".landmarkAscii": (
        "# Avizo 3D ASCII 2.0\ndefine Markers 2\nMarkers { float[3] Coordinates } @1\n@1\n1 2 3\n4 5 6e0\n",
    ),
}
SETTINGS = """# some of them
[matching]
samples = 200
orientation = "any"
metric = "affine"
seed = 5
[match]
landmarks = ["a.csv", "b.csv"]
output = 'map.npz'
[batch]
pairs = "consecutive"
timeout = 2.5
both-ways = true
"""


def of_text(*texts: str | bytes) -> Callable[[], Contents]:
    """Those given."""
    return lambda: [text if isinstance(text, bytes) else text.encode() for text in texts]


def of_cases(*names: str) -> Callable[[], Contents]:
    """Legal files of the tests, by their name."""
    by_name = {name: content for _, name, content in [*READ, *OTHERS, *NEURO]}
    return of_text(*(by_name[name] for name in names))


def habits(ending: str) -> Callable[[], Contents]:
    """Sound files of that ending as other programs write them, unpacked."""
    return of_text(*(content for name, content in ODD.items() if name.endswith(ending)))


def written(name: str, write: Callable[[Path], object]) -> bytes:
    """What a function writes into a file of that name."""
    with tempfile.TemporaryDirectory() as folder:
        write(Path(folder) / name)
        return (Path(folder) / name).read_bytes()


def maps() -> Contents:
    """A map, one whose members are others, and one with candidates."""
    points = SurfacePoints.at_vertices(TARGET, np.arange(SOURCE.n_vertices))
    pairs = {"face": [0, 3], "barycentric": [[1, 0, 0], [0.5, 0.25, 0.25]]}
    made = {"n_samples": 12, "orientation": "preserve", "rng": 1, **method_in_words(None, LeastSquares())}
    made["landmarks"] = {"source": pairs, "target": pairs, "tolerance": [0.0, 0.05]}
    meta = {"parameters": made, "versions": {"gmds": __version__}, "evidence": {"stress": 0.1, "margin": 2.5}}
    answer = Correspondence.from_points(SOURCE, points, meta=meta)
    several = replace(answer, candidates=(Candidate(points, 0.2, -0.5), Candidate(points, 0.3, 0.5)))
    others = {"face": points.face, "barycentric": points.barycentric, "vertex": answer.vertex_map()}
    writers = answer.save, lambda path: np.savez(path, **others), several.save
    return [written("m.npz", write) for write in writers]


@functools.cache
def _members() -> dict[str, Any]:
    with np.load(io.BytesIO(maps()[0])) as archive:
        return dict(archive)


def member(name: str) -> Callable[[], Contents]:
    """The array of that name in a map, as .npy; the meta data as the text that it is."""
    if name == "meta":
        return lambda: [_members()[name].tobytes()]
    return lambda: [written("m.npy", lambda path: np.save(path, _members()[name]))]


def with_member(name: str) -> Callable[[bytes], bytes]:
    """Makes the map that has another content of this member, its sums right."""

    def packed(content: bytes) -> bytes:
        stream = io.BytesIO()
        np.savez(stream, **{other: array for other, array in _members().items() if other != name})
        if name == "meta":
            array, content = np.frombuffer(content, dtype=np.uint8), b""
            content = written("m.npy", lambda path: np.save(path, array))
        with zipfile.ZipFile(stream, "a") as archive:
            archive.writestr(f"{name}.npy", content)
        return stream.getvalue()

    return packed


def marks(ending: str) -> Contents:
    """Landmarks in a format, by position and by vertex."""
    space = Landmarks(("nose", "left ear", "=tail"), np.array([[0.1, 2, 3e-5], [-1, 0, 0], [7, 8, 9.25]]))
    at = Landmarks(("1", "2", "3"), np.array([5, 0, 11]))
    kinds = [at] if ending == ".vts" else [space, at] if ending == ".csv" else [space]
    return [written(f"a{ending}", functools.partial(write_landmarks, landmarks=marks)) for marks in kinds]


def pictures() -> Contents:
    """A small image in three formats."""
    from PIL import Image

    grey = Image.fromarray(np.arange(48, dtype=np.uint8).reshape(6, 8))
    return [written(f"a.{kind}", grey.save) for kind in ("png", "jpg", "bmp")]


def surfaces() -> Contents:
    """A measured surface."""
    return [written("s.npz", lambda path: write_surface(path, measure(bumpy_sphere(1))))]


def arrays(**named: Any) -> Callable[[], Contents]:
    """An .npz of these arrays; an .npy of one that is called `only`."""
    if "only" in named:
        return lambda: [written("a.npy", lambda path: np.save(path, named["only"]))]
    return lambda: [written("a.npz", lambda path: np.savez(path, **named))]

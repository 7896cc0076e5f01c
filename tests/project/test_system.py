"""What the system does to us: kills, full disks, folders that can not be written, other processes (rows B01-B10, S09).

Each test runs a script in a process of its own, which says what happened as JSON.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import pytest
from places import ROOT

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="processes and limits of Linux")

PRELUDE = """
import json, os, signal, sys, time
sys.path.insert(0, "tests/support")
from pathlib import Path
import numpy as np
from generated_shapes import bumpy_sphere, icosphere
from geodesics import GeodesicDistance, Mesh, SurfacePoints, embedded, read_mesh, write_mesh
from gmds.correspondence import Correspondence
folder = Path(sys.argv[1])
A, B = bumpy_sphere(2, seed=1), bumpy_sphere(2, seed=2)
MAPS = [Correspondence.from_points(A, SurfacePoints.at_vertices(B, np.arange(162)), meta={"size": ["x"] * n})
        for n in (10, 5000)]
def save(name, which):
    if name.endswith(".npz"):
        MAPS[which].save(folder / name)
    else:
        write_mesh((A, B)[which], folder / name)
NAMES = ["m.off", "m.obj", "m.ply", "m.stl", "m.glb", "m.npz"]
WANTED = {}
for name in NAMES:
    for which in (0, 1):
        save(name, which)
        WANTED[name, which] = (folder / name).read_bytes()
def whole(name):
    return (folder / name).read_bytes() in (WANTED[name, 0], WANTED[name, 1])
"""


def said(script: str, folder: Path, *flags: str, prelude: str = PRELUDE, **environment: str) -> Any:
    """What a script prints last."""
    done = subprocess.run(
        [sys.executable, *flags, "-c", prelude + script, str(folder)],
        env={**os.environ, **environment},
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-3000:]
    return json.loads(done.stdout.splitlines()[-1])


def test_b01_a_killed_writer_leaves_the_old_file_or_the_new_one(tmp_path: Path) -> None:
    """100 kills at random moments while files of all formats are written over and over."""
    script = """
rng, broken, mid = np.random.default_rng(0), [], 0
for kill in range(100):
    child = os.fork()
    if child == 0:
        turn = kill
        while True:
            for name in NAMES:
                save(name, turn % 2)
            turn += 1
    time.sleep(rng.uniform(0, 0.03))
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    broken += [name for name in NAMES if not whole(name)]
    left = [path for path in folder.iterdir() if path.name not in NAMES]
    mid += bool(left)
    for path in left:
        path.unlink()
print(json.dumps([broken, mid]))
"""
    broken, killed_in_the_middle = said(script, tmp_path)
    assert broken == []
    assert killed_in_the_middle > 10


LIMITS = (0, 100, 2000)  # bytes that a file may have


@pytest.fixture(scope="module")
def full_disks(tmp_path_factory: pytest.TempPathFactory) -> list[Any]:
    """For each limit: the errors of all writers, and whether all files are as they were."""
    script = f"""
import resource
from gmds.landmarks.files import Landmarks, write_landmarks
marks = [Landmarks(tuple(f"mark {{i}}" for i in range(n)), np.full((n, 3), 0.1)) for n in (3, 500)]
write_landmarks(folder / "m.csv", marks[0])
before = {{path.name: path.read_bytes() for path in folder.iterdir()}}
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
_, most = resource.getrlimit(resource.RLIMIT_FSIZE)
found = []
for limit in {LIMITS}:
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, most))
    errors = []
    for name in [*NAMES, "m.csv"]:
        try:
            write_landmarks(folder / name, marks[1]) if name == "m.csv" else save(name, 1)
        except OSError as error:
            errors.append(error.errno)
    after = {{path.name: path.read_bytes() for path in folder.iterdir()}}
    found.append([errors, before == after])
print(json.dumps(found))
"""
    told: list[Any] = said(script, tmp_path_factory.mktemp("full"))
    return told


@pytest.mark.parametrize("number", range(len(LIMITS)), ids=map(str, LIMITS))
def test_b02_a_full_disk_leaves_the_old_file_and_no_other(full_disks: list[Any], number: int) -> None:
    errors, same = full_disks[number]
    assert errors == [27] * 7 and same  # EFBIG


READ_ONLY = """
from click.testing import CliRunner
import geodesics.io, gmds.cli.commands.check, gmds.cli.commands.repair
from gmds.cli import main
for name in ("w.ply", "none/w.ply"):  # so that all is imported that nobody may read later
    CliRunner().invoke(main, ["repair", str(folder / "m.off"), "-o", str(folder / name)])
(folder / "w.ply").unlink()
os.chmod(folder, 0o555)
if os.geteuid() == 0:
    os.setuid(65534)
before = sorted(os.listdir(folder))
done = [CliRunner().invoke(main, arguments) for arguments in (
    ["check", str(folder / "m.off")],
    ["repair", str(folder / "m.off"), "-o", str(folder / "n.off")],
    ["repair", str(folder / "m.off"), "-o", str(folder / "m.ply")])]
print(json.dumps([[run.exit_code for run in done], done[1].stderr, sorted(os.listdir(folder)) == before]))
"""


def test_b03_a_folder_that_can_not_be_written_is_named() -> None:
    with tempfile.TemporaryDirectory() as folder:  # the folders above that of `tmp_path` let no one else in
        codes, message, same = said(READ_ONLY, Path(folder))
    assert codes == [0, 2, 2]  # refused before anything is computed
    last = message.splitlines()[-1]
    assert folder in last and "Permission" in last
    assert same


def test_b03_without_a_place_for_compiled_kernels_they_are_compiled_again(tmp_path: Path) -> None:
    script = """
import numba, geodesics._kernels.jit as jit
from numba.core import caching
def nowhere(*_): raise RuntimeError("cannot cache function: no locator available")
caching.FunctionCache.__init__ = nowhere
def twice(x): return 2 * x
print(json.dumps([jit.njit(twice)(21), jit.cache_folder()]))
"""
    assert said(script, tmp_path, prelude="import json\n") == [42, None]


def test_b04_writers_of_one_file_do_not_mix(tmp_path: Path) -> None:
    script = """
children = []
for which in (0, 1, 0):
    if not (child := os.fork()):
        for _ in range(60):
            for name in NAMES:
                save(name, which)
        os._exit(0)
    children.append(child)
broken = looks = 0
while children:
    broken += sum(not whole(name) for name in NAMES)
    looks += 1
    children = [child for child in children if os.waitpid(child, os.WNOHANG) == (0, 0)]
print(json.dumps([broken, looks, sorted(path.name for path in folder.iterdir()) == sorted(NAMES)]))
"""
    broken, looks, alone = said(script, tmp_path)
    assert broken == 0 and looks > 10 and alone


def test_b09_forks_threads_and_pickles_give_the_same_bytes(tmp_path: Path) -> None:
    script = """
import asyncio, pickle
from concurrent.futures import ThreadPoolExecutor
mesh = bumpy_sphere(3)
points = SurfacePoints.at_vertices(mesh, np.arange(40))
def field(_=None):
    return GeodesicDistance(embedded(Mesh(mesh.vertices, mesh.faces)), threads=3).field(points).tobytes()
wanted = field()
if not (child := os.fork()):
    os._exit(0 if field() == wanted else 1)
same = [os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0]
with ThreadPoolExecutor(8) as pool:
    same += [found == wanted for found in pool.map(field, range(16))]
async def several():
    return await asyncio.gather(*(asyncio.to_thread(field) for _ in range(4)))
same += [found == wanted for found in asyncio.run(several())]
again = pickle.loads(pickle.dumps(MAPS[0]))
same += [again.points.mesh is again.target, np.array_equal(again.points.positions, MAPS[0].points.positions)]
frozen = (again.points.face, again.points.barycentric, again.valid, again.distortion, again.source.faces)
same += [again.status is MAPS[0].status, not any(array.flags.writeable for array in frozen)]
print(json.dumps(same))
"""
    assert all(said(script, tmp_path))


MATCHED = """
import hashlib, sys
sys.path.insert(0, "tests/support")
import json
from generated_shapes import bumpy_sphere, moved
import gmds
answer = gmds.match(bumpy_sphere(2), moved(bumpy_sphere(2, height=0.2)), n_samples=40)
arrays = (answer.points.face, answer.points.barycentric, answer.valid, answer.distortion)
print(json.dumps(hashlib.sha256(b"".join(array.tobytes() for array in arrays)).hexdigest()))
"""


def test_c5_b10_a_map_does_not_depend_on_the_interpreter_or_its_surroundings(tmp_path: Path) -> None:
    blas = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"), "4")
    odd: list[tuple[tuple[str, ...], dict[str, str]]] = [
        ((), {"PYTHONHASHSEED": "1", "GMDS_THREADS": "1"}),
        (("-O",), {"PYTHONHASHSEED": "2", "GMDS_THREADS": "4", "LC_ALL": "C", "TZ": "Asia/Kathmandu"}),
        (("-W", "error"), {"GMDS_THREADS": "2", "LC_ALL": "de_DE.UTF-8", **blas}),
    ]
    assert len({said(MATCHED, tmp_path, *flags, prelude="", **settings) for flags, settings in odd}) == 1


WATCHED = """
import json, sys
opened, reached = set(), []
def watch(event, arguments):
    if event == "open" and isinstance(arguments[0], (str, bytes)):
        opened.add(str(arguments[0]))
    elif event.startswith(("socket.connect", "socket.getaddrinfo", "socket.bind", "subprocess", "os.system", "os.exec",
                           "os.posix_spawn", "urllib", "http", "ftplib")):
        reached.append(event)
sys.path.insert(0, "tests/support")
from pathlib import Path
folder = Path(sys.argv[1])
import numpy, generated_shapes as shapes, gmds, geodesics, trimesh, trimesh.exchange.gltf, trimesh.exchange.stl
from file_cases import OBJ, OFF, PLY, STL_BINARY, glb, setting
from geodesics.check import check
from gmds.report import __file__ as page
ball = shapes.bumpy_sphere(2)
gmds.match(ball, ball, n_samples=30).save(folder / "warm.npz")
files = {"a.obj": b"mtllib /etc/passwd\\nmtllib http://example.org/a.mtl\\n" + OBJ.encode(), "a.off": OFF.encode(),
         "a.ply": PLY.replace("element v", "comment TextureFile /etc/passwd\\nelement v").encode(),
         "a.stl": STL_BINARY, "a.glb": glb(),
         "b.glb": glb(setting("buffers", 0, "uri", value="http://example.org/a.bin")),
         "c.glb": glb(setting("images", value=[{"uri": "file:///etc/passwd"}]))}
for name, content in files.items():
    (folder / name).write_bytes(content)
sys.addaudithook(watch)
for name in files:
    try:
        check(geodesics.read_mesh(folder / name))
    except geodesics.FormatError as error:
        assert error.code == "E222", error
answer = gmds.match(ball, shapes.moved(ball), n_samples=30)
answer.save(folder / "map.npz")
gmds.Correspondence.load(folder / "map.npz", answer.source, answer.target)
outside = [name for name in opened if not name.startswith((str(folder), sys.prefix, sys.base_prefix, "/proc", "/sys"))
           and "__pycache__" not in name and not name.endswith((".py", ".nbc", ".nbi"))]
print(json.dumps([reached, outside]))
"""


def test_s09_c9_nothing_is_reached_or_opened_but_what_was_named(tmp_path: Path) -> None:
    reached, outside = said(WATCHED, tmp_path, prelude="")
    assert reached == [] and outside == []

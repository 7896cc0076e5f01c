"""Drawing by pyvista without a screen, in a process of its own: where there is no driver it may end the process."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from geodesics.arrays import Floats, Integers
from geodesics.extras import how_to_install
from gmds.errors import RenderingError
from gmds.pictures.software import OVERSAMPLING, Shot, averaged

PATIENCE = 120  # seconds that drawing may take: a bound, as a graphics driver can hang
AROUND = np.array([[0, 3, 6, 5], [1, 4, 6, 3], [2, 5, 6, 4]])  # of the seven points of a face, those nearest a corner
WORKER = Path(__file__).with_name("offscreen_worker.py")


def offscreen(shots: Sequence[Shot]) -> list[Floats]:
    """Draw by pyvista, in another process: where there is no graphics driver it may end the process that it runs in.

    Parameters
    ----------
    shots : sequence of Shot
        What is to be drawn.

    Returns
    -------
    list of arrays of shape (height, width, 3)
        Images in [0, 1], on white.

    Raises
    ------
    RenderingError
        E510, where pyvista is not installed or cannot draw; the message says what to do.

    See Also
    --------
    software : On any machine.
    """
    if not _installed():
        raise RenderingError(f"pyvista is not installed; install it with: {how_to_install('viz')}")
    with tempfile.TemporaryDirectory(prefix="gmds-") as folder:
        for i, shot in enumerate(shots):
            _hand_over(shot, Path(folder) / f"{i}.npz")
        _run([sys.executable, "-P", str(WORKER), folder, str(len(shots))])
        images = [Path(folder) / f"{i}.npy" for i in range(len(shots))]
        if not all(image.exists() for image in images):
            raise RenderingError("pyvista drew nothing and did not say why")
        return [averaged(np.load(image, allow_pickle=False) / 255, OVERSAMPLING) for image in images]


def _installed() -> bool:
    return importlib.util.find_spec("pyvista") is not None


def _run(command: list[str]) -> None:
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=PATIENCE, check=False)
    except subprocess.TimeoutExpired as error:
        raise RenderingError(f"pyvista did not draw within {PATIENCE} s") from error
    if done.returncode:
        lines = [line.strip() for line in done.stderr.splitlines() if line.strip()]
        how = f"signal {-done.returncode}" if done.returncode < 0 else f"exit code {done.returncode}"
        why = f"{how}: {lines[-1][:200]}" if lines else how
        raise RenderingError(f"pyvista cannot draw here ({why}); it needs a graphics driver, EGL or OSMesa")


def _hand_over(shot: Shot, path: Path) -> None:
    """What the worker needs of a shot: polygons with normals and colours, in pixels, seen along z."""
    frame = shot.frame(OVERSAMPLING)
    points, faces = np.column_stack([frame.xy * [1, -1], frame.depth]), shot.mesh.faces
    normals, colours = shot.normals, shot.colours
    if shot.sharp:
        points, normals, colours = _spread(points, faces), _spread(normals, faces), colours[faces].reshape(-1, 3)
        faces = np.arange(7 * len(faces)).reshape(-1, 7)[:, AROUND].reshape(-1, 4)
    levels = np.rint(255 * colours.clip(0, 1)).astype(np.uint8)
    size = [frame.width, frame.height]
    np.savez(path, points=points, faces=faces, normals=normals, colours=levels, size=size)


def _spread(values: Floats, faces: Integers) -> Floats:
    """Values (7 m, 3) at the corners, the middles of the edges and the middle of each face, from those of vertices."""
    a, b, c = (values[faces[:, k]] for k in range(3))
    return np.stack([a, b, c, (a + b) / 2, (b + c) / 2, (c + a) / 2, (a + b + c) / 3], axis=1).reshape(-1, 3)

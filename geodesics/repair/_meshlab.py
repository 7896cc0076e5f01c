"""pymeshlab, which is GPL-3 and may crash, in a process of its own: this file is imported by us, and run by itself.

A filter that crashes, hangs or writes nonsense raises an error here; the mesh it was given does not change.
"""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from geodesics.arrays import Floats, Integers
from geodesics.extras import how_to_install

SECONDS = 1800  # of wall time, after which a filter is stopped; set by hand, no measurement depends on it


def apply_filter(name: str, vertices: Floats, faces: Integers, **options: Any) -> tuple[Floats, Integers]:
    """Vertices and faces after one pymeshlab filter. Raises `MissingExtra`, and `MeshError` when the filter fails."""
    from geodesics.errors import MeshError, MissingExtra

    if importlib.util.find_spec("pymeshlab") is None:
        raise MissingExtra(f"{name} needs pymeshlab; install it with: {how_to_install('repair')}")
    with tempfile.TemporaryDirectory() as folder:
        given, made = Path(folder) / "given.npz", Path(folder) / "made.npz"
        np.savez(given, vertices=vertices, faces=faces.astype(np.int32))
        command = [sys.executable, "-P", __file__, name, json.dumps(options), str(given), str(made)]
        try:
            done = subprocess.run(command, capture_output=True, timeout=SECONDS, check=False)
        except subprocess.TimeoutExpired as error:
            raise MeshError(f"pymeshlab ({name}) was given up after {SECONDS} s; try fewer vertices") from error
        if done.returncode != 0 or not made.exists():
            said = done.stderr.decode(errors="replace").strip().splitlines()
            how = f"was ended by signal {-done.returncode}" if done.returncode < 0 else "; ".join(said[-1:])
            raise MeshError(f"pymeshlab ({name}) cannot process the mesh: it {how or 'stopped'}; repair the mesh first")
        with np.load(made, allow_pickle=False) as arrays:
            return arrays["vertices"], arrays["faces"].astype(np.int64)


def _work(name: str, options: str, given: str, made: str) -> None:
    """The process that runs the filter."""
    import pymeshlab

    with np.load(given, allow_pickle=False) as arrays:
        mesh = pymeshlab.Mesh(arrays["vertices"], arrays["faces"])
    values = {
        key: pymeshlab.PureValue(value) if key == "targetlen" else value for key, value in json.loads(options).items()
    }
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(mesh)
    try:
        meshes.apply_filter(name, **values)
    except pymeshlab.PyMeshLabException as error:
        sys.exit(f"said {' '.join(str(error).split())}")
    np.savez(made, vertices=meshes.current_mesh().vertex_matrix(), faces=meshes.current_mesh().face_matrix())


if __name__ == "__main__":
    _work(*sys.argv[1:])

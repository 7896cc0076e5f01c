"""Surfaces that cannot be collapsed as they are: a simplified mesh must still come, in little memory."""

from __future__ import annotations

import json
import resource
import subprocess
import sys

import pytest
from places import ROOT

TESTS = ROOT / "tests"
MEMORY = 8 << 30  # bytes of address space; a collapse that goes astray takes all there is
SECONDS = 60  # that a surface may take
CODE = """
import json, os, signal, sys, traceback
import numpy as np, generated_shapes as shapes
from geodesics import Mesh
from gmds.registration.deformable import DeformableMesh
from gmds.surface import measure
from test_matching_robust import moebius
ball = shapes.bumpy_sphere(3)
n = ball.n_vertices
vertices = np.concatenate([ball.vertices, ball.vertices[:3]])

def check(mesh):
    whole = measure(mesh)
    simplified = DeformableMesh.simplified(whole, 300)
    assert simplified.mesh.n_faces <= 300 or simplified.mesh is whole.mesh
    assert np.isfinite(simplified.mesh.vertices).all()
    assert abs(simplified.areas.sum() - 1) < 1e-9
    assert np.isin(simplified.origin[simplified.usable], np.unique(whole.mesh.faces)).all()

told = {}
for name, made in json.load(sys.stdin).items():
    child = os.fork()  # which may take all the memory it has, crash, or not end
    if child == 0:
        signal.alarm(SECONDS)
        try:
            check(eval(made))
        except BaseException:
            traceback.print_exc()
            os._exit(1)
        os._exit(0)
    told[name] = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
print(json.dumps(told))
"""
MESHES = {
    "a face with a corner twice": "Mesh(vertices, [*ball.faces, [4, 4, 9]])",
    "a face with a corner thrice": "Mesh(vertices, [*ball.faces, [7, 7, 7]])",
    "a face with a corner twice, off the rest": "Mesh(vertices, [*ball.faces, [4, 4, 300], [5, 6, 6]])",
    "two vertices in one place": "Mesh(vertices, [*ball.faces, [0, n, 1]])",
    "faces twice": "Mesh(vertices, [*ball.faces, *ball.faces[:5]])",
    "faces turned over": "Mesh(vertices, [*ball.faces[7:], *ball.faces[:7, ::-1]])",
    "faces of no area": "Mesh(np.where(np.isin(np.arange(n), ball.faces[5])[:, None], 1.0, ball.vertices), ball.faces)",
    "one side": "moebius(400)",
}


@pytest.fixture(scope="module")
def ended() -> dict[str, tuple[int, str]]:
    """How the process of each surface ended, and what all of them said."""
    done = subprocess.run(
        [sys.executable, "-c", CODE.replace("SECONDS", str(SECONDS))],
        input=json.dumps(MESHES),
        capture_output=True,
        text=True,
        check=False,
        cwd=ROOT,
        env={
            "PYTHONPATH": f"{ROOT}:{TESTS}/support:{TESTS}/gmds/matching",
            "OMP_NUM_THREADS": "1",
            "OPENBLAS_NUM_THREADS": "1",
            "GMDS_THREADS": "1",
        },
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY)),
        timeout=10 * SECONDS,
    )
    assert done.returncode == 0, done.stderr[-500:]
    return {name: (code, done.stderr) for name, code in json.loads(done.stdout).items()}


@pytest.mark.parametrize("name", MESHES)
def test_the_outline_of_a_damaged_surface_is_found(name: str, ended: dict[str, tuple[int, str]]) -> None:
    code, said = ended[name]
    assert code == 0, said[-2000:]

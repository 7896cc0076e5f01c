"""The page of a map that docs/howto/looking.md shows: the map is in docs/live, the page is made when the site is built.

python docs/live.py     # match anew, and keep the map; ten seconds
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

import gmds
from geodesics import Mesh, SurfacePoints
from gmds.shapes import quadruped, truth

KEPT = Path(__file__).with_name("live") / "map.npz"
VERTICES = 1200  # of either animal: enough to look right, in a page of a third of a megabyte


def pair() -> tuple[Mesh, Mesh, SurfacePoints]:
    """An animal, the same in another pose with its head twice as big and other triangles, and the true map.

    Rounded to single precision: whatever a machine does with the last digits, the map is one of the same meshes.
    """
    made = quadruped(n_vertices=VERTICES), quadruped("walk", head_scale=2.0, n_vertices=VERTICES, seed=1)
    source, target = (Mesh(mesh.vertices.astype(np.float32), mesh.faces) for mesh in made)
    true = truth(*made)
    return source, target, SurfacePoints(target, true.face, true.barycentric)


def write_page(path: Path) -> None:
    """Write the page of the kept map, with its errors."""
    source, target, true = pair()
    answer = gmds.Correspondence.load(KEPT, source, target)
    errors = gmds.geodesic_error(answer, true)
    path.parent.mkdir(parents=True, exist_ok=True)
    answer.report(path, errors, title="A map to turn", names=("standing", "walking"))


if __name__ == "__main__":
    gmds.match(*pair()[:2]).save(KEPT)

"""Ways in which a mesh loses what its faces have in common; and all ways, by name."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from benchmarks.fuzzing.moves import MOVES, Faces, Points
from geodesics import Mesh

Tear = Callable[[Points, Faces, np.random.Generator], tuple[Points, Faces]]


def scattered(count: int) -> Tear:
    """So many faces among random vertices, pinched wherever they meet."""
    return lambda v, _, rng: (v, np.array([rng.permutation(len(v))[:3] for _ in range(count)]))


def pinched(share: float) -> Tear:
    """A share of the vertices made one with any other."""

    def change(v: Points, faces: Faces, rng: np.random.Generator) -> tuple[Points, Faces]:
        stand, count = np.arange(len(v)), max(1, int(share * len(v)))
        stand[rng.permutation(len(v))[:count]] = rng.integers(len(v), size=count)
        return v, stand[faces]

    return change


def thinned(share: float) -> Tear:
    """Without a share of the faces, at random: vertices of several fans, and some on no face."""
    return lambda v, faces, rng: (v, faces[rng.random(len(faces)) >= share])


def repeated(share: float) -> Tear:
    """A share of the faces once more, from another corner or turned over."""

    def change(v: Points, faces: Faces, rng: np.random.Generator) -> tuple[Points, Faces]:
        again = faces[rng.random(len(faces)) < share]
        return v, np.concatenate([faces, again[::2, [1, 2, 0]], again[1::2, ::-1]])

    return change


def turned(share: float) -> Tear:
    """A share of the faces turned over."""

    def change(v: Points, faces: Faces, rng: np.random.Generator) -> tuple[Points, Faces]:
        return v, np.where(rng.random((len(faces), 1)) < share, faces[:, ::-1], faces)

    return change


def apart(gap: float) -> Tear:
    """Every face with corners of its own, shrunk by so much."""

    def change(v: Points, faces: Faces, _: object) -> tuple[Points, Faces]:
        corners = v[faces]
        center = corners.mean(axis=1, keepdims=True)
        shrunk = corners + gap * (center - corners)
        return shrunk.reshape(-1, 3), np.arange(faces.size).reshape(-1, 3)

    return change


def charts(v: Points, faces: Faces, rng: np.random.Generator) -> tuple[Points, Faces]:
    """Vertices doubled along the seams between random directions."""
    directions = rng.standard_normal((5, 3))
    middle = v[faces].mean(axis=1) - v.mean(axis=0)
    key = faces * len(directions) + (middle @ directions.T).argmax(axis=1)[:, None]
    unique, corners = np.unique(key, return_inverse=True)
    return v[unique // len(directions)], corners.reshape(-1, 3)


def one_giant(size: float) -> Tear:
    """A face more, of a vertex and two so many extents away."""

    def change(v: Points, faces: Faces, rng: np.random.Generator) -> tuple[Points, Faces]:
        away = size * np.ptp(v, axis=0).max() * rng.standard_normal((2, 3))
        return np.concatenate([v, away]), np.concatenate([faces, [[0, len(v), len(v) + 1]]])

    return change


def slivers(height: float) -> Tear:
    """A tenth of the faces cut in three at a point so near to an edge, in lengths of it."""

    def change(v: Points, faces: Faces, rng: np.random.Generator) -> tuple[Points, Faces]:
        chosen = rng.random(len(faces)) < 0.1
        a, b, c = (corner := faces[chosen]).T
        x, y, z = v[corner].transpose(1, 0, 2)
        new = len(v) + np.arange(len(corner))
        points = np.concatenate([v, (x + y) / 2 + height * (z - (x + y) / 2)])
        parts = [np.stack(one, axis=1) for one in ((a, b, new), (b, c, new), (c, a, new))]
        return points, np.concatenate([faces[~chosen], *parts])

    return change


def loose(distance: float) -> Tear:
    """As many vertices on no face as there are on some, so many extents away."""

    def change(v: Points, faces: Faces, rng: np.random.Generator) -> tuple[Points, Faces]:
        off = distance * np.ptp(v, axis=0).max() * rng.standard_normal(v.shape)
        return np.concatenate([v + off, v]), faces + len(v)

    return change


def index_degenerate(share: float) -> Tear:
    """A share of the faces with a corner twice."""

    def change(v: Points, faces: Faces, rng: np.random.Generator) -> tuple[Points, Faces]:
        return v, np.where(rng.random((len(faces), 1)) < share, faces[:, [0, 0, 2]], faces)

    return change


TEARS: dict[str, Tear] = {
    **{f"{k} faces among random vertices": scattered(k) for k in (1, 3, 10, 50, 300)},
    **{f"{s:.1%} one with any other": pinched(s) for s in (0.01, 0.1, 0.5)},
    **{f"without {s:.0%} of the faces": thinned(s) for s in (0.1, 0.5, 0.9)},
    **{f"{s:.0%} of the faces again": repeated(s) for s in (0.1, 1.0)},
    **{f"{s:.0%} of the faces turned": turned(s) for s in (0.1, 0.5)},
    **{f"faces apart by {s:.0e}": apart(s) for s in (0.0, 1e-9, 1e-2)},
    "cut into charts": charts,
    **{f"a giant face of {s:.0e} extents": one_giant(s) for s in (1e1, 1e3, 1e6, 1e12)},
    **{f"slivers of {s:.0e}": slivers(s) for s in (1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 0.0)},
    **{f"vertices on no face, {d:.0e} extents away": loose(d) for d in (1.0, 1e6, 1e12)},
    **{f"{s:.0%} of the faces degenerate": index_degenerate(s) for s in (0.1, 0.9)},
}
DAMAGES = (*MOVES, *TEARS)


def hurt(name: str, mesh: Mesh, seed: int) -> tuple[Points, Faces]:
    """Vertices and faces of a mesh that was damaged in the way of that name."""
    rng = np.random.default_rng(seed)
    if name in MOVES:
        return MOVES[name](mesh.vertices, mesh.faces, rng), mesh.faces
    return TEARS[name](mesh.vertices, mesh.faces, rng)

"""Synchronisation in a common spectral basis beside agreement on the surfaces: is consistent ZoomOut worth its while?

    GMDS_DATA=... python -m benchmarks.study.consistent_zoomout MAPS [--sets 'FAUST;horses, scaled'] [--specimens 4]

From the maps of all ordered pairs, those that `benchmarks.study.atlas` has left in MAPS among them. *direct* is each
map as it is. *zoomout* takes it as functional maps from 20 to 100 eigenfunctions and back to points of triangles
(Melzi et al. 2019).
*synchronised* writes all maps as functional maps of 100 eigenfunctions at once, finds functions that are the same on
all shapes (the latent basis of Wang, Huang and Guibas 2013: least squares under a fixed norm, an eigenproblem) and
takes every map through them. *consistent* does so at every size from 20 to 100, each from the maps of the one before
(Huang, Ren, Wonka and Ovsjanikov 2020). Errors x100 of the judged points of each set, means over its pairs.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from scipy.linalg import eigh

import gmds
from benchmarks.study.atlas_sets import SETS, Set
from geodesics import SurfacePoints, eigenpairs
from geodesics.arrays import Floats
from gmds.evaluation import geodesic_error
from gmds.spectral.extension import closest_points
from gmds.spectral.functional_maps import functional_map
from gmds.surface.view import View

SIZES = (20, 28, 40, 56, 76, 100)  # of the ladder: by about 1.4, as that of the matcher

Maps = dict[tuple[str, str], SurfacePoints]


def some_of(known: Set, count: int | None) -> Set:
    """The first specimens of a set, and the pairs of them."""
    names = list(known.meshes)[:count]
    pairs = [pair for pair in known.pairs if pair.source in names and pair.target in names]
    return known._replace(meshes={name: known.meshes[name] for name in names}, pairs=pairs)


def loaded(known: Set, folder: Path) -> Maps:
    """The map of every ordered pair; made where it is not there."""
    folder.mkdir(parents=True, exist_ok=True)
    found = {}
    for a in known.meshes:
        for b in known.meshes:
            path = folder / f"{a}__{b}.npz"
            if a != b and not path.exists():
                gmds.match(known.meshes[a], known.meshes[b], **known.options[0]).save(path)
            if a != b:
                found[a, b] = gmds.Correspondence.load(path, known.meshes[a], known.meshes[b]).points
    return found


def matrices(maps: Maps, views: dict[str, View], k: int) -> dict[tuple[str, str], Floats]:
    """What pulls functions of the second shape back to the first, (k, k), for each map."""
    return {
        (a, b): functional_map(views[a].functions[:, :k], points.interpolate(views[b].functions[:, :k]))
        for (a, b), points in maps.items()
    }


def synchronised(pulled: dict[tuple[str, str], Floats], names: list[str], latent: int) -> dict[tuple[str, str], Floats]:
    """The same through common functions: the least of sum |P_ab Y_b - Y_a|^2 with sum Y'Y = 1."""
    k = len(next(iter(pulled.values())))
    at = {name: slice(i * k, (i + 1) * k) for i, name in enumerate(names)}
    total = np.zeros((k * len(names), k * len(names)))
    for (a, b), matrix in pulled.items():
        total[at[a], at[a]] += np.eye(k)
        total[at[b], at[b]] += matrix.T @ matrix
        total[at[a], at[b]] -= matrix
        total[at[b], at[a]] -= matrix.T
    basis = eigh(total, subset_by_index=(0, latent - 1))[1]
    return {(a, b): basis[at[a]] @ np.linalg.pinv(basis[at[b]]) for a, b in pulled}


def through(pulled: dict[tuple[str, str], Floats], views: dict[str, View]) -> Maps:
    """Functional maps as points."""
    found = {}
    for (a, b), matrix in pulled.items():
        k = len(matrix)
        found[a, b] = closest_points(views[b], views[b].functions[:, :k] @ matrix.T, views[a].functions[:, :k])
    return found


def error(maps: Maps, known: Set) -> float:
    """The mean over the judged pairs."""
    found = []
    for pair in known.pairs:
        right = SurfacePoints.at_vertices(known.meshes[pair.target], pair.there)
        found.append(geodesic_error(maps[pair.source, pair.target][pair.here], right).mean())
    return 100 * float(np.mean(found))


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("maps", type=Path)
    parser.add_argument("--sets", default="FAUST;horses, scaled")
    parser.add_argument("--specimens", type=int, help="the first so many of a set alone")
    parser.add_argument("--ratio", type=float, default=0.8, help="common functions, as a share of eigenfunctions")
    given = parser.parse_args()
    for name in given.sets.split(";"):
        known = some_of(SETS[name](), given.specimens)
        maps, names = loaded(known, given.maps / name / "maps" / "maps" / "pairs"), list(known.meshes)
        views = {one: View.of(eigenpairs(mesh, SIZES[-1])) for one, mesh in known.meshes.items()}
        found = {"direct": error(maps, known)}
        alone, consistent = maps, maps
        for k in SIZES:
            alone = through(matrices(alone, views, k), views)
            together = synchronised(matrices(consistent, views, k), names, round(given.ratio * k))
            consistent = through(together, views)
        once = synchronised(matrices(maps, views, SIZES[-1]), names, round(given.ratio * SIZES[-1]))
        found["zoomout"] = error(alone, known)
        found["synchronised"] = error(through(once, views), known)
        found["consistent"] = error(consistent, known)
        print(name, len(maps), {key: round(value, 3) for key, value in found.items()}, flush=True)


if __name__ == "__main__":
    main()

"""Pairs to choose hyper-parameters on, so that `scaled`, every 8th FAUST and every 10th TOSCA pair stay for reporting.

    GMDS_DATA=... python -m benchmarks.accuracy.development_pairs OUT_DIR

writes OUT_DIR/scaled and OUT_DIR/{faust_5k,tosca_5k,tosca_cross_5k}.txt. The first holds locally scaled copies, made
here, of shapes that the published `scaled` pairs do not use: one to three of six extremities grown or shrunk by a
smooth field, positions fitted to the new edge lengths (as rigid as possible but for size), remeshed by pymeshlab. The
others are lists of pairs: FAUST 4, 12, 20 ..., TOSCA 5, 15, 25 ..., gorilla - human 1, 6, 11 .... Then

    gmds benchmark OUT_DIR/scaled ;  gmds benchmark $GMDS_DATA/faust_5k --pairs OUT_DIR/faust_5k.txt
"""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

import igl
import numpy as np
import potpourri3d as pp3d
import scipy.sparse as sp
import scipy.sparse.linalg as sla

from geodesics import Mesh, SurfacePoints, read_mesh, write_mesh
from geodesics.repair.remeshing import remesh

SHAPES = (
    *(("tosca_5k", a, a) for a in ("cat2", "horse5", "centaur2")),
    ("faust_5k", "tr_reg_021", "tr_reg_021"),
    ("tosca_5k", "michael4", "michael4"),
    *(("tosca_5k", a, b) for a, b in (("cat5", "cat8"), ("horse14", "horse6"), ("centaur3", "centaur5"))),
    ("faust_5k", "tr_reg_041", "tr_reg_047"),
    *(("tosca_5k", a, b) for a, b in (("michael6", "michael2"), ("cat7", "cat9"))),
)
LISTS = {"faust_5k": (4, 8), "tosca_5k": (5, 10), "tosca_cross_5k": (1, 5)}  # first pair and step


def field(vertices: np.ndarray, faces: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """A smooth logarithmic scale (n,): one to three of six farthest points grown or shrunk."""
    solver = pp3d.MeshHeatMethodDistanceSolver(vertices, faces, use_robust=True)
    tips = [int(solver.compute_distance(0).argmax())]
    nearest = solver.compute_distance(tips[0])
    for _ in range(5):
        tips.append(int(nearest.argmax()))
        nearest = np.minimum(nearest, solver.compute_distance(tips[-1]))
    count = rng.integers(1, 4)
    chosen = rng.choice(6, count, replace=False)
    sizes, radii = np.log(rng.choice([0.5, 1.6, 2, 2.5], count)), rng.uniform(0.35, 0.6, count)
    total = np.zeros(len(vertices))
    for tip, size, radius in zip(chosen, sizes, radii, strict=True):
        x = np.clip((radius - solver.compute_distance(tips[tip])) / (0.35 * radius) + 0.5, 0, 1)
        total += size * x * x * (3 - 2 * x)
    return total


def fitted(vertices: np.ndarray, faces: np.ndarray, log_scale: np.ndarray) -> np.ndarray:
    """Positions whose edges are those of the shape, turned, times exp of the mean log scale of their ends."""
    cotangents = sp.csr_matrix(-igl.cotmatrix(vertices, faces)).tocoo()
    off = cotangents.row != cotangents.col
    i, j = cotangents.row[off], cotangents.col[off]
    w = np.maximum(-cotangents.data[off], 1e-3)
    n = len(vertices)
    graph = sp.coo_matrix((w, (i, j)), shape=(n, n)).tocsr()
    laplacian = (sp.diags(np.asarray(graph.sum(1)).ravel()) - graph + 1e-9 * sp.eye(n)).tocsc()
    edges = (vertices[i] - vertices[j]) * np.exp((log_scale[i] + log_scale[j]) / 2)[:, None]
    turns, placed = np.repeat(np.eye(3)[None], n, 0), vertices
    for _ in range(6):
        right = np.zeros_like(vertices)
        np.add.at(right, i, w[:, None] * np.einsum("kab,kb->ka", (turns[i] + turns[j]) / 2, edges))
        placed = sla.spsolve(laplacian, right)
        spread = np.zeros((n, 3, 3))
        pull = w[:, None, None] * np.einsum("ka,kb->kab", vertices[i] - vertices[j], placed[i] - placed[j])
        np.add.at(spread, i, pull)
        u, _, vt = np.linalg.svd(spread)
        vt[np.linalg.det(np.einsum("kba,kcb->kac", vt, u)) < 0, 2] *= -1
        turns = np.einsum("kba,kcb->kac", vt, u)
    return placed


def main(data: Path, out: Path) -> None:
    """Write the pairs and the lists."""
    out.mkdir(parents=True, exist_ok=True)
    for folder, (first, step) in LISTS.items():
        lines = [line for line in (data / folder / "test_pairs.txt").read_text().splitlines() if line.strip()]
        (out / f"{folder}.txt").write_text("\n".join(lines[first::step]) + "\n")
    rng, pairs = np.random.default_rng(7), []
    (out / "scaled").mkdir(exist_ok=True)
    for folder, a, b in SHAPES:
        mesh = read_mesh(data / folder / f"{b}.off")
        size = np.sqrt(igl.doublearea(mesh.vertices, mesh.faces).sum() / 2)
        unit = mesh.vertices / size
        placed = Mesh(fitted(unit, mesh.faces, field(unit, mesh.faces, rng)), mesh.faces)
        target, name = remesh(placed, 5000), f"{a}_{b}"
        truth = SurfacePoints.closest(target, placed.vertices).nearest_vertices()
        source, there, flipped = (
            np.loadtxt(data / folder / "corres" / f"{k}.vts", dtype=np.int64) - 1 for k in (a, b, f"{b}.sym")
        )
        write_mesh(target, out / "scaled" / f"{name}.off")
        write_mesh(read_mesh(data / folder / f"{a}.off"), out / "scaled" / f"source_{name}.off")
        np.savez(out / "scaled" / f"{name}.npz", src=source, gt=truth[there], gt_sym=truth[flipped])
        group = "self" if a == b else "pose"
        paths = {"source": f"scaled/source_{name}.off", "target": f"scaled/{name}.off", "truth": f"scaled/{name}.npz"}
        pairs.append({"name": name, "group": group, **paths})
        print(name, target)
    (out / "scaled" / "pairs.json").write_text(json.dumps(pairs, indent=1))


if __name__ == "__main__":
    main(Path(os.environ["GMDS_DATA"]), Path(sys.argv[1]))

"""The sets of `benchmarks.study.atlas`: meshes of one kind of thing, and where the same points are on them."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from geodesics import Mesh, SurfacePoints, read_mesh
from geodesics.arrays import Floats, Integers
from gmds.shapes import Figure, quadruped, truth

PEOPLE = ("006", "001", "012", "023", "034", "045")
TRIED = ("000", "011", "022", "033", "044", "005")  # people on whom the vote and the error bar were tried
JUDGED = 50  # points of a pair


class Pair(NamedTuple):
    """Names of two specimens, vertices of the one, and the vertices of the other where they belong."""

    source: str
    target: str
    here: Integers
    there: Integers


class Set(NamedTuple):
    """Meshes by name, pairs with truth, and where the same points are on all specimens, where that is known.

    `options` of `match` and of the atlas: which sides are mirrored is to be found out where the data do not say it.
    """

    meshes: dict[str, Mesh]
    pairs: list[Pair]
    points: dict[str, Floats]
    options: tuple[dict[str, Any], dict[str, Any]] = ({}, {})


def faust(people: Sequence[str] = PEOPLE) -> Set:
    """Six people in six poses."""
    folder = Path(os.environ["GMDS_DATA"]) / "faust_5k"
    meshes = {name: read_mesh(folder / f"tr_reg_{name}.off") for name in people}
    points = {name: np.loadtxt(folder / f"corres/tr_reg_{name}.vts", dtype=np.int64) - 1 for name in people}
    some = np.random.default_rng(0).choice(len(points[people[0]]), JUDGED, replace=False)
    couples = [(people[i], people[(i + step) % 6]) for step, count in ((1, 5), (2, 3)) for i in range(count)]
    pairs = [Pair(a, b, points[a][some], points[b][some]) for a, b in couples]
    return Set(meshes, pairs, {name: meshes[name].vertices[points[name]] for name in people})


def animals() -> Set:
    """Five built-in animals in four poses, whose ears, legs and heads have other sizes."""
    rng, figures = np.random.default_rng(5), dict[str, Figure]()
    for i in range(5):
        ear, leg, head = np.exp(0.2 * rng.standard_normal(3)).tolist()
        pose = ("stand", "walk", "graze", "turn")[i % 4]
        figures[f"animal{i}"] = quadruped(
            pose, n_vertices=1500 + 10 * i, seed=i, ear_scale=ear, leg_scale=leg, head_scale=head
        )
    first, *_ = names = list(figures)
    some = rng.choice(figures[first].n_vertices, 500, replace=False)
    places = {name: truth(figures[first], figures[name]).positions[some] for name in names}
    nearest = {name: SurfacePoints.closest(figures[name], places[name]).nearest_vertices() for name in names}
    few = rng.choice(len(some), JUDGED, replace=False)
    pairs = [Pair(a, b, nearest[a][few], nearest[b][few]) for a in names for b in names if a < b]
    return Set(dict(figures), pairs, places)


def anatomy(start: str, count: int = 4) -> Set:
    """The first `count` specimens of `anatomy/pairs.json` whose names start so, each once, in all ordered pairs."""
    root = Path(os.environ["GMDS_DATA"])
    found = [e for e in json.loads((root / "anatomy" / "pairs.json").read_text()) if e["name"].startswith(start)]
    entries = found[: count - 1]
    sides = any(entry.get("orientation") == "any" for entry in entries)
    known = [np.load(root / entry["truth"]) for entry in entries]
    path = root / entries[0]["source"]
    meshes, points = {_name(path): read_mesh(path)}, {_name(path): known[0]["src"]}
    order = np.arange(len(known[0]["src"]))
    for i, (entry, right) in enumerate(zip(entries, known, strict=True)):
        path = root / entry["target"]
        name = _name(path)
        meshes[name] = read_mesh(path)
        points[name] = right["gt"][order]
        if i + 1 < len(known):  # the target is the source of the next pair, with other vertices
            there = read_mesh(root / entries[i + 1]["source"]).vertices[known[i + 1]["src"]]
            order = cKDTree(there).query(meshes[name].vertices[points[name]])[1]
    whole = np.all([np.isin(points[name], meshes[name].faces) for name in points], axis=0)
    some = np.random.default_rng(0).permutation(np.flatnonzero(whole))[:JUDGED]
    pairs = [Pair(a, b, points[a][some], points[b][some]) for a in points for b in points if a != b]
    return Set(meshes, pairs, {}, ({"orientation": "any"}, {"mirror": "auto"}) if sides else ({}, {}))


def _name(path: Path) -> str:
    return path.stem.replace("__", "_")


def horses() -> Set:
    """A horse, and copies of it of which parts are scaled, one of them in another pose."""
    root = Path(os.environ["GMDS_DATA"])
    entries = [e for e in json.loads((root / "scaled" / "pairs.json").read_text()) if "horse" in e["name"]]
    meshes = {"horse": read_mesh(root / entries[0]["source"])}
    known = {}
    for entry in entries:
        if entry["source"] == entries[0]["source"]:
            meshes[entry["name"]] = read_mesh(root / entry["target"])
            known[entry["name"]] = np.load(root / entry["truth"])
    same = np.array(sorted(set.intersection(*(set(one["src"].tolist()) for one in known.values()))))
    points = {name: one["gt"][[one["src"].tolist().index(i) for i in same]] for name, one in known.items()}
    some = np.random.default_rng(0).permutation(len(same))[:JUDGED]
    pairs = [Pair(a, b, points[a][some], points[b][some]) for a in points for b in points if a != b]
    for name in ("horse6", "horse15"):
        meshes[name] = read_mesh(root / "tosca_5k" / f"{name}.off")
    return Set(meshes, pairs, {})


DEVELOPMENT = ("FAUST, development", "animals, built-in", "faces, meshmonk")
SETS: dict[str, Callable[[], Set]] = {
    "FAUST": faust,
    "horses, scaled": horses,
    "animals, built-in": animals,
    "faces": lambda: anatomy("scalismo"),
    "endocasts": lambda: anatomy("primate"),
    "teeth": lambda: anatomy("pnas", 3),
    "faces, meshmonk": lambda: anatomy("meshmonk"),
    "FAUST, development": lambda: faust(TRIED),
}

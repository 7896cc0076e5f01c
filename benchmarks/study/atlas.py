"""An atlas against direct maps and maps composed through one template, on shapes whose truth is known.

    GMDS_DATA=... python -m benchmarks.study.atlas MAPS [--sets 'FAUST;teeth'] [--workers 1]

Sets: six people in six poses of FAUST, judged on eight ordered pairs; copies of a horse of which parts are scaled, one
in another pose, of `scaled/`; teeth, faces and endocasts of `anatomy/`, judged on the pairs of `pairs.json` (a specimen
that is the source of one pair and, renumbered, the target of another is there twice). Errors x100 by the protocol of
the field, of 50 points at most. *composed* goes through the atlas of one template without neighbours, which is
composition; *neighbours* through one of one template as `gmds atlas` makes it; *voted* through one of three templates.
*settled* is *neighbours* with each pair registered once more from there (`settled_places`): no longer one
triangulation; and `seconds` is the CPU time of that. The cycle is how far from home points of one specimen come through
two others on registered meshes, over the root of its area. Where all specimens have the same points, generalisation and
specificity of a model of the true points, and of the points where the atlas carries those of the first specimen. Modest
on purpose: minutes of CPU a set. MAPS keeps maps from run to run.
Writes results/atlas.csv and results/atlas.md.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import gmds
from benchmarks.accuracy.runs import code_version
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from geodesics import Mesh, SurfacePoints, read_mesh
from geodesics.arrays import Floats, Integers
from gmds.batch import local_client
from gmds.batch.collection import Shape
from gmds.batch.store import Store
from gmds.evaluation import geodesic_error
from gmds.files.table import write_table
from gmds.matching.settling import CommonPoints, settled_places
from gmds.morphometrics.quality import generalisation, specificity
from gmds.morphometrics.shape_model import ShapeModel

# other shapes than those on which the vote was tried (000, 011, 022, 033, 044, 005)
PEOPLE = ("006", "001", "012", "023", "034", "045")
JUDGED = 50  # points of a pair
ATLASES: dict[str, tuple[str, dict[str, int]]] = {
    "composed": ("one", {"neighbours": 0}),
    "neighbours": ("one", {}),
    "voted": ("three", {"templates": 3}),
}
"""Of each kind of atlas the folder, which those with the same maps share, and the options."""


class Pair(NamedTuple):
    """Names of two specimens, vertices of the one, and the vertices of the other where they belong."""

    source: str
    target: str
    here: Integers
    there: Integers


class Set(NamedTuple):
    """Meshes by name, pairs with truth, and of all specimens the same points, where they are known."""

    meshes: dict[str, Mesh]
    pairs: list[Pair]
    points: dict[str, Integers]


def faust() -> Set:
    """Six people in six poses."""
    folder = Path(os.environ["GMDS_DATA"]) / "faust_5k"
    meshes = {name: read_mesh(folder / f"tr_reg_{name}.off") for name in PEOPLE}
    points = {name: np.loadtxt(folder / f"corres/tr_reg_{name}.vts", dtype=np.int64) - 1 for name in PEOPLE}
    some = np.random.default_rng(0).choice(len(points[PEOPLE[0]]), JUDGED, replace=False)
    couples = [(PEOPLE[i], PEOPLE[(i + step) % 6]) for step, count in ((1, 5), (2, 3)) for i in range(count)]
    pairs = [Pair(a, b, points[a][some], points[b][some]) for a, b in couples]
    return Set(meshes, pairs, points)


def anatomy(group: str) -> Set:
    """The specimens of a group of `anatomy/pairs.json`."""
    root = Path(os.environ["GMDS_DATA"])
    entries = [one for one in json.loads((root / "anatomy" / "pairs.json").read_text()) if one["group"] == group]
    meshes, pairs = {}, []
    for entry in entries:
        names = [Path(entry[side]).stem.replace("__", "_") for side in ("source", "target")]
        for side, name in zip(("source", "target"), names, strict=True):
            meshes[name] = read_mesh(root / entry[side])
        truth = np.load(root / entry["truth"])
        some = np.random.default_rng(0).permutation(len(truth["src"]))[:JUDGED]
        pairs.append(Pair(*names, truth["src"][some], truth["gt"][some]))
    return Set(meshes, pairs, {})


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
    pairs = [Pair(a, b, points[a][some], points[b][some]) for a in points for b in points if a < b]
    return Set(meshes, pairs, {})


SETS: dict[str, Callable[[], Set]] = {
    "FAUST": faust,
    "horses, scaled": horses,
    "teeth": lambda: anatomy("teeth"),
    "faces": lambda: anatomy("faces"),
    "endocasts": lambda: anatomy("endocasts"),
}


def direct(pair: Pair, meshes: dict[str, Mesh], folder: Path) -> SurfacePoints:
    """Where a map of the pair alone sends the points."""
    source, target, path = meshes[pair.source], meshes[pair.target], folder / f"{pair.source}--{pair.target}.npz"
    if not path.exists():
        gmds.match(source, target).save(path)
    return gmds.Correspondence.load(path, source, target).points[pair.here]


def through(made: gmds.Atlas, pair: Pair, meshes: dict[str, Mesh]) -> SurfacePoints:
    """Where an atlas sends them."""
    places = made.carry(meshes[pair.source].vertices[pair.here], pair.source, pair.target)
    return SurfacePoints.closest(meshes[pair.target], places)


def cycle(made: gmds.Atlas) -> float:
    """How far from home points of the first specimen come through the next two, at the most."""
    a, b, c = made.names[:3]
    start = SurfacePoints(made.registered[0], np.arange(200), np.full((200, 3), 1 / 3)).positions
    home = made.carry(made.carry(made.carry(start, a, b), b, c), c, a)
    return float(np.linalg.norm(home - start, axis=1).max() / np.sqrt(made.registered[0].area))


def models(made: gmds.Atlas, known: Set) -> dict[str, float]:
    """Generalisation and specificity, with two components, of the true points and of those that the atlas carries."""
    first = made.names[0]
    start = known.meshes[first].vertices[known.points[first]]
    configurations: dict[str, Floats] = {
        "true": np.stack([known.meshes[name].vertices[known.points[name]] for name in made.names]),
        "atlas": np.stack([made.carry(start, first, name) for name in made.names]),
    }
    found = {}
    for name, x in configurations.items():
        model = ShapeModel().fit(x)
        found[f"generalisation_{name}"] = float(generalisation(model)[1])
        found[f"specificity_{name}"] = float(specificity(model)[1])
    return found


class Settled:
    """Pairs registered once more, from where an atlas has them."""

    def __init__(self, made: gmds.Atlas, meshes: dict[str, Mesh], folder: Path) -> None:
        self.made, self.meshes, self.seconds = made, meshes, list[float]()
        folder.mkdir(exist_ok=True)
        self.store = Store(folder)
        self.records = {name: self.store.keep(Shape(name, mesh)) for name, mesh in meshes.items()}

    def __call__(self, pair: Pair) -> SurfacePoints:
        """Where the points of a pair go."""
        here, there = (self.made.positions[self.made.index(name)] for name in (pair.source, pair.target))
        surfaces = [self.store.surface(self.records[name]) for name in (pair.source, pair.target)]
        started = time.process_time()
        places = settled_places(*surfaces, CommonPoints(here, there, self.made.faces))
        self.seconds.append(time.process_time() - started)
        start = self.meshes[pair.source].vertices[pair.here]
        on = SurfacePoints.closest(Mesh(here, self.made.faces), start)
        ends = (on.barycentric[:, :, None] * places[self.made.faces[on.face]]).sum(axis=1)
        return SurfacePoints.closest(self.meshes[pair.target], ends)


def measured(name: str, maps: Path, workers: int) -> tuple[list[dict[str, Any]], dict[str, float]]:
    """A row for every judged pair, and what is known of the atlases of the set."""
    known, folder = SETS[name](), maps / name
    folder.mkdir(parents=True, exist_ok=True)
    made = {}
    with local_client(workers) as client:
        for kind, (place, options) in ATLASES.items():
            made[kind] = gmds.atlas(known.meshes, folder / place, client=client, **options)
            print(name, kind, made[kind].templates, dict(made[kind].failures), flush=True)
    settled = Settled(made["neighbours"], known.meshes, folder / "shapes")
    rows = []
    for pair in known.pairs:
        errors = {"direct": direct(pair, known.meshes, folder)}
        errors |= {kind: through(one, pair, known.meshes) for kind, one in made.items()}
        errors["settled"] = settled(pair)
        truth = SurfacePoints.at_vertices(known.meshes[pair.target], pair.there)
        row = {kind: 100 * float(geodesic_error(points, truth).mean()) for kind, points in errors.items()}
        rows.append({"set": name, "pair": f"{pair.source}-{pair.target}", **row})
        print(rows[-1], flush=True)
    facts = {"cycle": cycle(made["neighbours"]), "seconds": float(np.mean(settled.seconds))}
    return rows, facts | (models(made["neighbours"], known) if known.points else {})


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("maps", type=Path)
    parser.add_argument("--sets", default=";".join(SETS))
    parser.add_argument("--workers", type=int, default=1)
    given = parser.parse_args()
    rows, facts = [], {}
    for name in given.sets.split(";"):
        found, facts[name] = measured(name, given.maps, given.workers)
        rows += found
    write_table(RESULTS / "atlas.csv", list(rows[0]), ([*row.values()] for row in rows), digits=4)
    (RESULTS / "atlas.md").write_text(page(rows, facts), encoding="utf-8")


def page(rows: list[dict[str, Any]], facts: dict[str, dict[str, float]]) -> str:
    """Means of each set, and what is known of the models."""
    kinds = ("direct", *ATLASES, "settled")
    lines = []
    for name, known in facts.items():
        some = [row for row in rows if row["set"] == name]
        means = [float(np.mean([row[kind] for row in some])) for kind in kinds]
        lines.append(
            [name, len(some), *(f"{mean:.2f}" for mean in means), f"{known['seconds']:.2f}", f"{known['cycle']:.1e}"]
        )
    told = f"`python -m benchmarks.study.atlas MAPS` at {code_version()}; see the script for the protocol."
    text = ["# Atlas", "", told, "", *table(["set", "pairs", *kinds, "seconds", "cycle"], lines)]
    pairs = [(name, known) for name, known in facts.items() if "generalisation_true" in known]
    head = ["set", "generalisation, true points", "atlas", "specificity, true points", "atlas"]
    keys = ("generalisation_true", "generalisation_atlas", "specificity_true", "specificity_atlas")
    return "\n".join([*text, *table(head, [[name, *(f"{known[key]:.5f}" for key in keys)] for name, known in pairs])])


if __name__ == "__main__":
    main()

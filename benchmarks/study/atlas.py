"""An atlas against direct maps and maps composed through one template, on shapes whose truth is known.

    GMDS_DATA=... python -m benchmarks.study.atlas MAPS [--sets 'FAUST;teeth'] [--workers 1]

Sets: six people in six poses of FAUST, judged on eight ordered pairs; copies of a horse of which parts are scaled, one
in another pose, of `scaled/`, with two more poses of the horse itself; five built-in animals; four faces, four
endocasts and three teeth (not measured yet) of `anatomy/`, each once, judged on all ordered pairs. Errors x100 by the
protocol of the field, of 50 points at most.
*direct* is the map of each pair alone. *composed* goes through the atlas of one template without neighbours, which is
composition; *atlas* is `gmds atlas` as it stands; *voted* is it with `--templates 6`, all specimens of a set
being templates. The cycle is how far from home points of one specimen come through two others on registered meshes,
over the root of its area. Where all specimens have the same points, generalisation and specificity of a model of the
true points, and of the points where the atlas carries those of the first specimen. Modest on purpose: minutes of CPU a
set. MAPS keeps maps from run to run, and the figures of each set, so that sets can be run one by one.
Writes results/atlas.csv and results/atlas.md.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np

import gmds
from benchmarks.accuracy.runs import code_version
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from benchmarks.study.atlas_sets import SETS, Pair, Set
from geodesics import Mesh, SurfacePoints
from geodesics.arrays import Floats
from gmds.atlases.sheets import located
from gmds.batch import local_client
from gmds.evaluation import geodesic_error
from gmds.files.table import write_table
from gmds.morphometrics.quality import generalisation, specificity
from gmds.morphometrics.shape_model import ShapeModel

ATLASES: dict[str, dict[str, Any]] = {
    "composed": {"neighbours": 0},
    "atlas": {},
    "voted": {"templates": 6},
}
"""Options of each kind of atlas."""


def direct(pair: Pair, known: Set, maps: Path) -> SurfacePoints:
    """Where the map of the pair alone sends the points: one that an atlas is made of, if it is there."""
    source, target = known.meshes[pair.source], known.meshes[pair.target]
    path = maps / f"{pair.source}__{pair.target}.npz"
    if not path.exists():
        gmds.match(source, target, **known.options[0]).save(path)
    return gmds.Correspondence.load(path, source, target).points[pair.here]


def through(made: gmds.Atlas, pair: Pair, meshes: dict[str, Mesh]) -> SurfacePoints:
    """Where an atlas sends them: on the surface of the other specimen, where it faces as the registered one does."""
    target, registered = meshes[pair.target], made.registered
    common, there = registered[made.index(pair.source)], registered[made.index(pair.target)]
    here = SurfacePoints.at_vertices(meshes[pair.source], pair.here)
    points = SurfacePoints(there, *located(here, common.vertices, common.faces))
    return SurfacePoints(target, *located(points, target.vertices, target.faces))


def cycle(made: gmds.Atlas) -> float:
    """How far from home points of the first specimen come through the next two, at the most."""
    a, b, c = made.names[:3]
    start = SurfacePoints(made.registered[0], np.arange(200), np.full((200, 3), 1 / 3)).positions
    home = made.carry(made.carry(made.carry(start, a, b), b, c), c, a)
    return float(np.linalg.norm(home - start, axis=1).max() / np.sqrt(made.registered[0].area))


def models(made: gmds.Atlas, known: Set) -> dict[str, float]:
    """Generalisation and specificity, with two components, of the true points and of those that the atlas carries."""
    first = made.names[0]
    start = known.points[first]
    configurations: dict[str, Floats] = {
        "true": np.stack([known.points[name] for name in made.names]),
        "atlas": np.stack([made.carry(start, first, name) for name in made.names]),
    }
    found = {}
    for name, x in configurations.items():
        model = ShapeModel().fit(x)
        found[f"generalisation_{name}"] = float(generalisation(model)[1])
        found[f"specificity_{name}"] = float(specificity(model)[1])
    return found


def measured(name: str, maps: Path, workers: int) -> tuple[list[dict[str, Any]], dict[str, float]]:
    """A row for every judged pair, and what is known of the atlases of the set."""
    known, folder = SETS[name](), maps / name
    folder.mkdir(parents=True, exist_ok=True)
    made = {}
    with local_client(workers) as client:
        for kind, options in ATLASES.items():
            made[kind] = gmds.atlas(known.meshes, folder / "maps", client=client, **options, **known.options[1])
            print(name, kind, made[kind].templates, made[kind].mirrored.sum(), dict(made[kind].failures), flush=True)
    rows = []
    for pair in known.pairs:
        errors = {"direct": direct(pair, known, folder / "maps" / "maps" / "pairs")}
        errors |= {kind: through(one, pair, known.meshes) for kind, one in made.items()}
        right = SurfacePoints.at_vertices(known.meshes[pair.target], pair.there)
        row = {kind: 100 * float(geodesic_error(points, right).mean()) for kind, points in errors.items()}
        rows.append({"set": name, "pair": f"{pair.source}-{pair.target}", **row})
        print(rows[-1], flush=True)
    return rows, {"specimens": len(made["voted"].names), "cycle": cycle(made["voted"])} | (
        models(made["voted"], known) if known.points else {}
    )


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("maps", type=Path)
    parser.add_argument("--sets", default=";".join(SETS))
    parser.add_argument("--workers", type=int, default=1)
    given = parser.parse_args()
    for name in given.sets.split(";"):
        rows, facts = measured(name, given.maps, given.workers)
        told = {"version": code_version(), "rows": rows, "facts": facts}
        (given.maps / name / "figures.json").write_text(json.dumps(told), encoding="utf-8")
    found = {name: given.maps / name / "figures.json" for name in SETS}
    known = {name: json.loads(path.read_text(encoding="utf-8")) for name, path in found.items() if path.exists()}
    rows = [row for one in known.values() for row in one["rows"]]
    write_table(RESULTS / "atlas.csv", list(rows[0]), ([*row.values()] for row in rows), digits=4)
    (RESULTS / "atlas.md").write_text(page(known), encoding="utf-8")


def page(known: dict[str, dict[str, Any]]) -> str:
    """Means of each set, and what is known of the models."""
    kinds = ("direct", *ATLASES)
    lines = []
    for name, one in known.items():
        means = [float(np.mean([row[kind] for row in one["rows"]])) for kind in kinds]
        facts, figures = one["facts"], (f"{mean:.2f}" for mean in means)
        lines.append([name, facts["specimens"], len(one["rows"]), *figures, f"{facts['cycle']:.1e}", one["version"]])
    told = "`python -m benchmarks.study.atlas MAPS`; see the script for the protocol."
    about = (
        "Where maps of the pairs themselves are hardly better than composed ones, as of faces and endocasts, which are "
        "smooth and in one pose, no atlas is 15 % better than composition: what all maps have in common stays. More "
        "neighbours, the template registered from each, weights by disagreement, more rounds and a common spectral "
        'basis were tried on development sets and gained little or nothing (notes.md, "Atlas").'
    )
    text = ["# Atlas", "", told, about, "", *table(["set", "specimens", "pairs", *kinds, "cycle", "version"], lines)]
    pairs = [(name, one["facts"]) for name, one in known.items() if "generalisation_true" in one["facts"]]
    head = ["set", "generalisation, true points", "atlas", "specificity, true points", "atlas"]
    keys = ("generalisation_true", "generalisation_atlas", "specificity_true", "specificity_atlas")
    return "\n".join([*text, *table(head, [[name, *(f"{facts[key]:.5f}" for key in keys)] for name, facts in pairs])])


if __name__ == "__main__":
    main()

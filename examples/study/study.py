"""From a folder of meshes to a study: atlas, model, growth, groups, points; compared with what was put in.

python study.py [-o study] [--count 12] [--vertices 1500] [--workers 2]
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np
import species
from points import write_and_read_back

import gmds
from geodesics import write_mesh
from gmds.atlases.groups_output import write_growth, write_tests
from gmds.atlases.model_output import write_model
from gmds.atlases.output import write_atlas
from gmds.batch import local_client
from gmds.files.table import write_table
from gmds.morphometrics.components import principal_components
from gmds.morphometrics.group_tests import design, point_tests, shape_test
from gmds.morphometrics.hotelling import hotelling_test
from gmds.pictures.values import write_values


def study(out: Path, count: int = 12, n_vertices: int = 1500, client: Any = None) -> dict[str, float]:
    """All of it, into a folder; what was found beside what was put in."""
    known = {one.name: one for one in species.specimens(count, n_vertices)}
    (out / "meshes").mkdir(parents=True, exist_ok=True)
    for name, one in known.items():
        write_mesh(one.mesh, out / "meshes" / f"{name}.ply")
    rows = [[name, one.species, one.ear, one.leg] for name, one in known.items()]
    write_table(out / "specimens.csv", ["name", "species", "ear", "leg"], rows)

    mirror = [name for name, one in known.items() if one.mirrored]
    atlas = gmds.atlas(out / "meshes", out / "atlas", mirror=mirror, client=client)
    write_atlas(atlas, out / "atlas")
    write_model(gmds.ShapeModel.from_atlas(atlas), out / "model")

    growth = atlas.growth
    columns = design([known[name].species for name in atlas.names])
    whole = np.isfinite(growth).all(axis=0)
    told = {"shape": atlas.superposition.aligned, "growth": growth[:, whole]}
    tests = {name: (shape_test(x, columns), hotelling_test(x, columns)) for name, x in told.items()}
    points = point_tests(growth, columns[:, 0])
    write_tests(tests, points, atlas.mean, out / "groups")
    write_growth(growth, atlas.names, out / "groups")
    first = write_first_component(out, atlas, growth)
    return {**compared(known, atlas, growth, points, tests, first), **write_and_read_back(atlas, out)}


def write_first_component(out: Path, atlas: gmds.Atlas, growth: np.ndarray) -> np.ndarray:
    """The scores (k,) of the first principal component of growth, which is drawn."""
    deviations = np.nan_to_num(growth)  # what a specimen lacks is as in the mean
    _, axes = principal_components(deviations - deviations.mean(axis=0), 2)
    scores = deviations @ axes[0]
    shown = [("first component of growth", atlas.mean, axes[0] * scores.std())]
    write_values(out / "growth.png", shown, signed=True, label="log of the change of length", pixels=460)
    return np.asarray(scores)


def compared(
    known: dict[str, species.Specimen],
    atlas: gmds.Atlas,
    growth: np.ndarray,
    points: Any,
    tests: dict[str, Any],
    first: np.ndarray,
) -> dict[str, float]:
    """What was found, and what was put in."""
    template = known[atlas.templates[0]]
    part = species.parts(template.places(atlas.positions[atlas.index(template.name)]))
    found = {}
    relative = growth - np.nanmedian(growth[:, part["trunk"]], axis=1, keepdims=True)
    for name, sizes in (("ears", [known[n].ear for n in atlas.names]), ("legs", [known[n].leg for n in atlas.names])):
        logs = np.log(sizes)
        here = np.nanmedian(relative[:, part[name]], axis=1)
        found[f"{name}: correlation of growth with the truth"] = float(np.corrcoef(here, logs)[0, 1])
        found[f"{name}: mean error of log growth"] = float(np.abs(here - here.mean() - logs + logs.mean()).mean())
    slope = points.slope - np.nanmedian(points.slope[part["trunk"]])
    found["ears: difference of species, found"] = float(np.nanmedian(slope[part["ears"]]))
    groups = {s: np.mean([np.log(one.ear) for one in known.values() if one.species == s]) for s in species.EARS}
    found["ears: difference of species, put in"] = float(groups["short"] - groups["long"])
    factor = np.log([known[name].ear / known[name].leg for name in atlas.names])
    found["first component of growth: correlation with the known factor"] = abs(float(np.corrcoef(first, factor)[0, 1]))
    found["p of the difference in growth"] = tests["growth"][0].p
    found["p of the difference in growth, Hotelling's T squared"] = tests["growth"][1].p
    lame = "long1"
    found["share of the specimen without a leg that is missing"] = float(1 - atlas.valid[atlas.index(lame)].mean())
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, default=Path("study"))
    parser.add_argument("--count", type=int, default=12)
    parser.add_argument("--vertices", type=int, default=1500)
    parser.add_argument("--workers", type=int, default=None)
    given = parser.parse_args()
    with local_client(given.workers) as client:
        for what, value in study(given.output, given.count, given.vertices, client).items():
            print(f"{what}: {value:.3f}")


if __name__ == "__main__":
    main()

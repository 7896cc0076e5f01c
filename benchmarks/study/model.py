"""A shape model of an atlas of built-in animals beside one of their true points.

    python -m benchmarks.cost.atlas_cost FOLDER --counts 8
    python -m benchmarks.study.model FOLDER 8

The animals of `benchmarks.cost.atlas_cost`, as it has left their atlas in FOLDER: all vertices of the first template on
every specimen, by the atlas and by what they were made from. `error` is the mean distance of the two, over the root of
the area, x100. Both models have all specimens but one in turn (generalisation), or are drawn from (specificity), with
1, 2, ... components. Growth is that from the first template to each, on its triangles, by the atlas and by the true
points: the correlation of ranks, and the median error of the logarithm of length, in the median of specimens. Writes
results/model.md.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from scipy.stats import spearmanr

import gmds
from benchmarks.accuracy.runs import code_version
from benchmarks.cost.atlas_cost import animals
from benchmarks.markdown import table
from benchmarks.places import RESULTS
from geodesics import Mesh
from geodesics.arrays import Floats
from gmds.morphometrics.quality import generalisation, specificity
from gmds.shapes import truth

COMPONENTS = 4  # of the models: what the goal asks of


def growths(made: gmds.Atlas, right: Floats) -> tuple[float, float]:
    """Correlation of ranks with the growth of the true points (k, n, 3), and error; medians of specimens."""
    start = made.index(made.templates[0])
    meshes = [[Mesh(x, made.faces) for x in places] for places in (made.positions, right)]
    found = []
    for i in range(len(made.names)):
        if i != start:
            ours, true = (gmds.growth_between(one[start], one[i]).length for one in meshes)
            found.append((spearmanr(ours, true)[0], np.median(np.abs(ours - true))))
    rank, error = np.median(found, axis=0)
    return float(rank), float(error)


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    parser.add_argument("count", type=int)
    parser.add_argument("--vertices", type=int, default=5000)
    given = parser.parse_args()
    made = gmds.Atlas.load(given.folder / f"atlas-{given.count}" / "atlas.npz")
    figures = dict(animals(given.count, given.vertices))
    first = figures[made.templates[0]]
    right = np.stack([truth(first, figures[name]).positions for name in made.names])
    sizes = np.sqrt([figures[name].area for name in made.names])
    errors = 100 * np.linalg.norm(made.positions - right, axis=2).mean(axis=1) / sizes
    aligned = np.linalg.norm(made.positions - right, axis=2).mean(axis=1) / made.superposition.sizes
    others = [i for i, name in enumerate(made.names) if name != made.templates[0]]
    models = [gmds.ShapeModel(COMPONENTS).fit(x) for x in (right, made.positions)]
    lines = []
    for what, measure in (("generalisation", generalisation), ("specificity", specificity)):
        one, other = (measure(model)[:COMPONENTS] for model in models)
        for i in range(COMPONENTS):
            noisy = f"{np.hypot(one[i], aligned[others].mean()):.6f}" if what == "generalisation" else ""
            lines.append([what, i + 1, f"{one[i]:.6f}", noisy, f"{other[i]:.6f}", f"{other[i] / one[i] - 1:+.1%}"])
    rank, off = growths(made, right)
    told = f"`python -m benchmarks.study.model FOLDER {given.count}` at {code_version()}, {given.vertices:,} vertices."
    mean, worst = errors[others].mean(), errors.max()
    about = (
        f"Places are off by {mean:.2f} in the mean of specimens, {worst:.2f} in the worst (x100); that is "
        f"{aligned[others].mean():.6f} beside centroid sizes, which no component foretells. *With that* is the root of "
        "the sum of squares of it and of the generalisation of the true points. Growth from the first template to each "
        f"goes with that of the true points by a correlation of ranks of {rank:.3f}, and is off by {off:.3f} in the "
        "median, as a logarithm of length."
    )
    head = ["", "components", "true points", "with that", "atlas", "difference"]
    page = "\n".join(["# A model of built-in animals", "", told, "", about, "", *table(head, lines)])
    (RESULTS / "model.md").write_text(page, encoding="utf-8")
    print(page)


if __name__ == "__main__":
    main()

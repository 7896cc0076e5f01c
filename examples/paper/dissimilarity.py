"""How far apart are two shapes (abstract, sec. 5)? Small dogs with large ears, large dogs with small ears, and cats.

"Distortion" is `gmds.dissimilarity`: what the best embeddings found of two shapes in each other distort. "Bound" is
`gmds.least_distortion`: what no embedding that keeps area goes below, and what large collections are compared by; in
the regular metric or in those of `distance_profile`, members of the scale-invariant family. The embeddings need not
keep area, so the distortion may be less than the bound. Parameters were chosen on the classes cat, centaur, david, dog,
gorilla and horse. The nearest shape is sought among all others of the collection; two shapes of a class have had limbs
scaled, at the strengths of Table 1.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
from common import Z_UP, options, picture, publish, save
from compared_shapes import built_in, published_animals
from dissimilarity_tables import markdown

from geodesics import Mesh, Metric, embedded, read_mesh
from gmds import distance_profile, least_distortion
from gmds.comparison.clustering import families, nearest, neighbour_accuracy
from gmds.comparison.distortion import embedding_distortion
from gmds.comparison.figure import comparison_figure
from gmds.comparison.profiles import METRICS, views
from gmds.deformations import deformed
from gmds.files.folders import mesh_files
from gmds.retrieval.mending import largest_piece

Array = np.ndarray
Numbers = dict[str, Any]
CHOSEN_ON = ("cat", "centaur", "david", "dog", "gorilla", "horse")
METRIC_SETS: dict[str, Sequence[Callable[[Mesh], Metric]]] = {"regular": (embedded,), "invariant": METRICS}
GROWN = (3, 5)  # strengths of local scale
EMBEDDED = 2  # shapes of each class not chosen on that are embedded in each other
GREY = (0.72, 0.76, 0.82)
Y_UP = (0, 1, 0)


def matrix_of(items: Sequence[Any], compare: Callable[[Any, Any], float]) -> Array:
    """All dissimilarities (k, k)."""
    result = np.zeros((len(items), len(items)))
    for i, j in combinations(range(len(items)), 2):
        result[i, j] = result[j, i] = compare(items[i], items[j])
    return result


def all_of(shapes: Mapping[str, Mesh]) -> dict[str, Array]:
    """The distortion of the best embeddings, the bound, and the bound in the regular metric, for every pair."""
    matrices = {"distortion": matrix_of([views(mesh) for mesh in shapes.values()], embedding_distortion)}
    for name, metrics in (("bound", METRICS), ("bound, regular metric", (embedded,))):
        profiles = [distance_profile(mesh, metrics) for mesh in shapes.values()]
        matrices[name] = matrix_of(profiles, least_distortion)
    return matrices


def question(names: Sequence[str], matrices: Mapping[str, Array]) -> Numbers:
    """The largest dissimilarity of two dogs, the smallest of a dog and a cat, and all of them."""
    dogs, cats = ([i for i, name in enumerate(names) if animal in name] for animal in ("dog", "cat"))
    numbers: Numbers = {"names": list(names)}
    for kind, matrix in matrices.items():
        numbers[kind] = {
            "dog to dog, at most": matrix[np.ix_(dogs, dogs)].max().round(4),
            "dog to cat, at least": matrix[np.ix_(dogs, cats)].min().round(4),
            "matrix": matrix.round(4).tolist(),
        }
    return numbers


def accuracies(matrix: Array, names: Sequence[str]) -> Numbers:
    """Per cent of shapes whose nearest is of their class: of the classes chosen on, of the others, of all."""
    family = np.array(families(names))
    asked = np.array([np.count_nonzero(family == one) > 1 for one in family])
    right = family[nearest(matrix)[:, 0]] == family
    chosen = np.isin(family, CHOSEN_ON)
    groups = {"chosen on": asked & chosen, "others": asked & ~chosen, "all": asked}
    return {label: (100 * right[group].mean()).round(1) for label, group in groups.items()}


def grown(meshes: Mapping[str, Mesh], strength: int) -> dict[str, Mesh]:
    """Two shapes of each class with some limbs grown and others shrunk."""
    family = dict(zip(meshes, families(list(meshes)), strict=True))
    members = {one: [name for name in meshes if family[name] == one] for one in sorted(set(family.values()))}
    asked = [name for names in members.values() for name in names[1:3]]
    return {
        name: deformed(largest_piece(meshes[name]), "local-scale", strength, rng=i)[0] for i, name in enumerate(asked)
    }


def recognised(queries: Mapping[str, Array], profiles: Mapping[str, Array]) -> Numbers:
    """Of how many changed shapes the nearest, among all unchanged ones but itself, is of their class."""
    family = dict(zip(profiles, families(list(profiles)), strict=True))
    right: dict[str, bool] = {}
    for name, mine in queries.items():
        others = [other for other in profiles if other != name]
        best = min(others, key=lambda other: least_distortion(mine, profiles[other]))
        right[name] = family[best] == family[name]
    groups = {
        "chosen on": [right[name] for name in right if family[name] in CHOSEN_ON],
        "others": [right[name] for name in right if family[name] not in CHOSEN_ON],
    }
    return {label: {"right": sum(hits), "of": len(hits)} for label, hits in groups.items()}


def collection(meshes: Mapping[str, Mesh]) -> tuple[Numbers, Array]:
    """Nearest neighbours in the metrics of `distance_profile` and in that of space, and the invariant bounds (k, k)."""
    changed = {strength: grown(meshes, strength) for strength in GROWN}
    numbers: Numbers = {"shapes": len(meshes)}
    for kind, metrics in METRIC_SETS.items():
        profiles = {name: distance_profile(mesh, metrics) for name, mesh in meshes.items()}
        matrix = matrix_of(list(profiles.values()), least_distortion)
        numbers[kind] = {"nearest of the same class, %": accuracies(matrix, list(meshes))}
        for strength, shapes in changed.items():
            queries = {name: distance_profile(mesh, metrics) for name, mesh in shapes.items()}
            numbers[kind][f"limbs scaled, strength {strength}"] = recognised(queries, profiles)
    return numbers, matrix


def embedded_classes(meshes: Mapping[str, Mesh]) -> Numbers:
    """The same of a few shapes of each class not chosen on, all of them embedded in each other."""
    family = families(list(meshes))
    members: dict[str, list[str]] = {}
    for name, one in zip(meshes, family, strict=True):
        if one not in CHOSEN_ON:
            members.setdefault(one, []).append(name)
    names = [name for every in members.values() if len(every) >= EMBEDDED for name in every[:EMBEDDED]]
    matrices = all_of({name: meshes[name] for name in names})
    rates = {kind: neighbour_accuracy(matrix, families(names)) for kind, matrix in matrices.items()}
    return {"names": names, "nearest of the same class, %": {kind: 100 * (rate or 0) for kind, rate in rates.items()}}


def drawn(shapes: Mapping[str, Mesh], matrix: Array, up: tuple[int, int, int]) -> Any:
    """The tree, the matrix and the map of a few shapes, with pictures of them."""
    images = [picture(mesh, np.tile(GREY, (mesh.n_vertices, 1)), up, pixels=130) for mesh in shapes.values()]
    return comparison_figure(list(shapes), matrix, images)


def main() -> None:
    """Write pictures and numbers."""
    settings = options(__doc__ or "", ("--report", {"type": Path, "help": "write the tables as Markdown, too"}))
    settings.output.mkdir(parents=True, exist_ok=True)
    shapes = built_in(settings.small)
    matrices = all_of(shapes)
    numbers: Numbers = {"built-in": question(list(shapes), matrices)}
    figure = drawn(shapes, matrices["distortion"], Z_UP)
    if settings.data is not None:
        numbers |= published(settings.data, settings.output)
    publish(settings.output, "dissimilarity", figure, numbers)
    if settings.report is not None:
        settings.report.write_text(markdown(__doc__ or "", numbers), encoding="utf-8")


def published(data: Path, output: Path) -> Numbers:
    """The numbers of published shapes, and their pictures."""
    numbers: Numbers = {}
    animals = published_animals(data / "tosca_nonrigid_3k")
    matrices = all_of(animals)
    numbers["TOSCA"] = question(list(animals), matrices)
    save(output / "dissimilarity_tosca.png", drawn(animals, matrices["distortion"], Z_UP))
    species = {path.stem: read_mesh(path) for path in mesh_files(data / "shrec20" / "models")}
    matrices = all_of(species)
    numbers["species"] = {"names": list(species), **{kind: m.round(4).tolist() for kind, m in matrices.items()}}
    save(output / "dissimilarity_species.png", drawn(species, matrices["distortion"], Y_UP))
    meshes = {path.stem: read_mesh(path) for path in mesh_files(data / "tosca_nonrigid_3k")}
    numbers["collection"], matrix = collection(meshes)
    figure = comparison_figure(list(meshes), matrix)
    figure.set_dpi(70)
    save(output / "dissimilarity_collection.png", figure)
    numbers["embedded"] = embedded_classes(meshes)
    return numbers


if __name__ == "__main__":
    main()

"""Table 1: shapes recognised by bags of features after seven kinds of change in five strengths, with six descriptors.

A SHREC'10-like benchmark: the original is not to be had. The collection is one shape of each class and shapes of other
collections to tell them from. A query is another pose of a class, or its shape changed by `gmds.deformations.KINDS`. It
is recognised when the nearest shape of the collection is the one of its class; "<= s" are the queries of strengths 1 to
s. Vocabularies are learned from the shapes of the classes DEVELOPMENT, on whose queries all parameters were chosen.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from common import options, publish
from matplotlib.figure import Figure
from numpy.typing import NDArray
from transformed_shapes import KINDS, STRENGTHS, Item, built_in, collection, published

from gmds.retrieval import (
    INVARIANT,
    INVARIANT_FREQUENCIES,
    REGULAR,
    REGULAR_FREQUENCIES,
    Described,
    bag_distances,
    learned,
    retrieval_scores,
    signatures_of,
)

DEVELOPMENT = ("animal", "cat", "centaur", "david", "gorilla", "seahorse", "star3", "wolf")
SINGLE = (REGULAR, REGULAR_FREQUENCIES, INVARIANT, INVARIANT_FREQUENCIES)
ROWS = {d.name: (d,) for d in SINGLE} | {
    "invariant HKS + SI-HKS": (INVARIANT, REGULAR_FREQUENCIES),
    "invariant HKS + HKS": (INVARIANT, REGULAR),
}
PUBLISHED = dict(zip(KINDS, (97.44, 97.82, 100, 100, 83.73, 100, 100), strict=True))  # of its Table 1, <= 5

Parts = Sequence[Sequence[Described]]


def bags(items: Sequence[Item], parts: Parts, name: str) -> NDArray[np.float64]:
    """The bags (items, words) of all shapes by the descriptors of a row."""
    which = [SINGLE.index(descriptor) for descriptor in ROWS[name]]
    chosen = [[each[i] for i in which] for each in parts]
    examples = [each for item, each in zip(items, chosen, strict=True) if item.kind == "null" and development(item)]
    features = learned(ROWS[name], examples)
    return np.array([features.of(each) for each in chosen])


def development(item: Item) -> bool:
    """Whether parameters were chosen on this shape's class."""
    return item.label in DEVELOPMENT


def recognition(items: Sequence[Item], found: NDArray[np.float64]) -> dict[str, Any]:
    """By kind and "<= s": the percentage recognised, the mean of 100 / rank of the right shape, the queries.

    With one right answer a query, the latter is the mean average precision, as which the published table adds up.
    """
    target = [i for i, item in enumerate(items) if item.strength == 0]
    result: dict[str, Any] = {}
    for kind in KINDS:
        result[kind] = {}
        for strength in STRENGTHS:
            asked = [i for i, item in enumerate(items) if item.kind == kind and 0 < item.strength <= strength]
            distances = bag_distances(found[asked], found[target])
            scores = retrieval_scores(distances, [items[i].label for i in asked], [items[i].label for i in target])
            rates = {"recognised": scores.nearest_neighbour, "mean precision": scores.mean_average_precision}
            result[kind][f"<= {strength}"] = rates | {"queries": scores.queries}
    return result


def categories(items: Sequence[Item], found: NDArray[np.float64]) -> dict[str, Any]:
    """Poses of all classes, each asked for the others: nearest neighbour, first tier, mean average precision."""
    poses = [i for i, item in enumerate(items) if item.kind == "null" or (item.kind == "isometry" and item.genuine)]
    labels = [items[i].label for i in poses]
    return asdict(retrieval_scores(bag_distances(found[poses], found[poses]), labels, labels, leave_out_self=True))


def table(result: dict[str, Any]) -> Figure:
    """The percentages recognised, by descriptor, kind and strength."""
    figure = Figure(figsize=(10.5, 6.2), dpi=110, layout="constrained")
    axes = figure.subplots(2, len(result) // 2, sharex=True, sharey=True)
    for axis, (name, rates) in zip(axes.ravel(), result.items(), strict=True):
        values = np.array([[rates[kind][f"<= {s}"]["recognised"] for s in STRENGTHS] for kind in KINDS])
        axis.imshow(values, cmap="cividis", vmin=40, vmax=100, aspect="auto")
        for (i, j), value in np.ndenumerate(values):
            axis.text(j, i, f"{value:.1f}", ha="center", va="center", fontsize=8, color="k" if value > 70 else "w")
        axis.set_xticks(range(5), ["1", *(f"≤ {s}" for s in STRENGTHS[1:])], fontsize=8)
        axis.set_yticks(range(len(KINDS)), KINDS, fontsize=9)
        axis.set_title(name, fontsize=10)
    figure.supxlabel("strength", fontsize=9)
    figure.suptitle("Table 1: changed shapes whose nearest unchanged shape is the right one, %", fontsize=11)
    return figure


def markdown(numbers: dict[str, Any]) -> str:
    """The tables of benchmarks/results/retrieval.md."""
    names = list(ROWS)
    lines = ["# Retrieval (Table 1)", "", f"`python examples/paper/table1_retrieval.py`. {numbers['about']}", ""]
    for who, title in (("reporting", "Classes kept for reporting"), ("all", "All classes")):
        rates = numbers["recognition"][who]
        lines += [f"## {title}: recognised at strength <= 5, % (in brackets: mean average precision)", ""]
        lines += [f"| | queries | {' | '.join(names)} | the paper, its own shapes |", "|---" * (len(names) + 3) + "|"]
        for kind in KINDS:
            last = [rates[name][kind]["<= 5"] for name in names]
            cells = [f"{one['recognised']:.1f} ({one['mean precision']:.1f})" for one in last]
            lines.append(f"| {kind} | {last[0]['queries']} | {' | '.join(cells)} | {PUBLISHED[kind]:g} |")
        lines.append("")
    lines += ["## By strength, all classes: recognised, %", ""]
    for name in names:
        lines += [f"| {name} | 1 | <= 2 | <= 3 | <= 4 | <= 5 |", "|---" * 6 + "|"]
        for kind in KINDS:
            row = [f"{numbers['recognition']['all'][name][kind][f'<= {s}']['recognised']:.1f}" for s in STRENGTHS]
            lines.append(f"| {kind} | {' | '.join(row)} |")
        lines.append("")
    lines += ["## Categories: every pose asks for the others of its class", ""]
    lines += ["| | queries | nearest neighbour | first tier | mAP |", "|---" * 5 + "|"]
    for name in names:
        one = numbers["categories"][name]
        shown = [f"{one[key]:.1f}" for key in ("nearest_neighbour", "first_tier", "mean_average_precision")]
        lines.append(f"| {name} | {one['queries']} | {' | '.join(shown)} |")
    return "\n".join(lines) + "\n"


def main() -> None:
    """Run, and write the picture and the numbers."""
    settings = options(__doc__ or "", ("--report", {"type": Path, "help": "write the tables as Markdown, too"}))
    shapes = built_in(settings.small) if settings.data is None else published(settings.data)
    items: list[Item] = []
    parts: list[tuple[Described, ...]] = []
    for item in collection(*shapes, strengths=(1, 5) if settings.small else STRENGTHS):
        parts.append(signatures_of(item.mesh, SINGLE))
        items.append(item.without_mesh())
    numbers = judged(items, parts)
    publish(settings.output, "table1_retrieval", table(numbers["recognition"]["all"]), numbers)
    if settings.report is not None:
        settings.report.write_text(markdown(numbers), encoding="utf-8")


def judged(items: Sequence[Item], parts: Parts) -> dict[str, Any]:
    """All numbers: what there is, recognition rates by half of the classes, and category retrieval."""
    recognised: dict[str, Any] = {"all": {}, "reporting": {}, "development": {}}
    grouped: dict[str, Any] = {}
    for name in ROWS:
        found = bags(items, parts, name)
        for who, result in recognised.items():
            kept = [i for i, item in enumerate(items) if item.strength == 0 or who in ("all", half(item))]
            result[name] = recognition([items[i] for i in kept], found[kept])
        grouped[name] = categories(items, found)
    kinds = [item.kind for item in items]
    number = {"classes": kinds.count("null"), "others": kinds.count("distractor")}
    number["queries"] = len(items) - sum(number.values())
    about = " ".join((__doc__ or "").split("\n\n", 1)[1].split())
    return {"about": about, "collection": number, "recognition": recognised, "categories": grouped}


def half(item: Item) -> str:
    """The half of the classes that a shape belongs to."""
    return "development" if development(item) else "reporting"


if __name__ == "__main__":
    main()

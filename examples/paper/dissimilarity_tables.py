"""The numbers of dissimilarity.py as tables in Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

Numbers = dict[str, Any]
RATE = "nearest of the same class, %"


def table(names: Sequence[str], matrix: Any) -> list[str]:
    """A matrix of dissimilarities in Markdown."""
    lines = [f"| | {' | '.join(names)} |", "|---" * (len(names) + 1) + "|"]
    for i, (name, row) in enumerate(zip(names, matrix, strict=True)):
        lines.append(f"| {name} | {' | '.join('' if i == j else f'{x:.3f}' for j, x in enumerate(row))} |")
    return [*lines, ""]


def markdown(about: str, numbers: Numbers) -> str:
    """The tables of benchmarks/results/dissimilarity.md, under what the docstring `about` says after its first line."""
    about = " ".join(about.split("\n\n", 1)[1].split())
    lines = ["# Dissimilarity", "", f"`python examples/paper/dissimilarity.py --data DATA --report FILE`. {about}", ""]
    lines += ["## Are two dogs whose ears and sizes differ closer to each other than to a cat?", ""]
    lines += ["| | | dog to dog, at most | dog to cat, at least |", "|---|---|---|---|"]
    asked = [(where, numbers[where]) for where in ("built-in", "TOSCA") if where in numbers]
    for where, one in asked:
        for kind in list(one)[1:]:
            values = [f"{one[kind][key]:.3f}" for key in ("dog to dog, at most", "dog to cat, at least")]
            lines.append(f"| {where} | {kind} | {' | '.join(values)} |")
    lines.append("")
    for where, one in asked:
        lines += [f"Distortion, {where}:", "", *table(one["names"], one["distortion"]["matrix"])]
    if "collection" in numbers:
        lines += collection_tables(numbers)
    return "\n".join(lines).replace("\n\n\n", "\n\n")


def collection_tables(numbers: Numbers) -> list[str]:
    """Those of the published collections."""
    found, some = numbers["collection"], numbers["embedded"]
    lines = [f"## The {found['shapes']} shapes of TOSCA: nearest of the same class, by the bound", ""]
    lines += ["| | | classes chosen on | other classes | all |", "|---" * 5 + "|"]
    for kind in ("regular", "invariant"):
        rates = found[kind][RATE]
        lines.append(f"| {kind} | as they are, % | {' | '.join(f'{rate:.1f}' for rate in rates.values())} |")
        for change, counts in list(found[kind].items())[1:]:
            every = [*counts.values(), {key: sum(one[key] for one in counts.values()) for key in ("right", "of")}]
            lines.append(f"| {kind} | {change} | {' | '.join(map('{right} of {of}'.format_map, every))} |")
    rates = some[RATE]
    lines += ["", f"Among {len(some['names'])} shapes of other classes ({', '.join(some['names'])}), all embedded in "]
    lines[-1] += "each other: " + ", ".join(f"{rate:.0f} % by the {kind}" for kind, rate in rates.items()) + "."
    species = numbers["species"]
    for kind in ("distortion", "bound"):
        lines += ["", f"## Across species (SHREC'20): {kind}", "", *table(species["names"], species[kind])]
    return lines

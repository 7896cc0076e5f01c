"""Which shapes of a collection are matched with which: functions from their names to pairs of names."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Sequence

from geodesics.errors import BadArgument
from gmds.suggestions import did_you_mean

Pairs = Iterable[tuple[str, str]]
Choice = Callable[[Sequence[str]], Pairs]


def all_pairs(names: Sequence[str]) -> Pairs:
    """Every shape to every later one; the way back is `Correspondence.inverse`, or asked for by `both_ways`."""
    return itertools.combinations(names, 2)


def consecutive(names: Sequence[str]) -> Pairs:
    """Every shape to the next: the frames of a sequence."""
    return itertools.pairwise(names)


def with_template(template: str) -> Choice:
    """The choice that matches one shape to all others: what is known of it is then known of all."""

    def choose(names: Sequence[str]) -> Pairs:
        if template not in names:
            raise BadArgument(f"there is no shape {template!r}{did_you_mean(template, names)}")
        return ((template, name) for name in names if name != template)

    return choose


def both_ways(choice: Choice) -> Choice:
    """The pairs of another choice, each followed by its opposite."""

    def choose(names: Sequence[str]) -> Pairs:
        return (pair for one, other in choice(names) for pair in ((one, other), (other, one)))

    return choose

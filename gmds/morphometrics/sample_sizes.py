"""Ways of dealing out labels anew, of which a permutation test takes some or all, and what few specimens can tell."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from math import factorial, prod

import numpy as np
from numpy.typing import ArrayLike

from geodesics.arrays import Floats, Integers
from geodesics.errors import BadArgument

CONVINCING = 0.05  # probability, a convention
FEW = 720  # ways, up to which a test takes them all: of six numbers; set by hand


def dealt(columns: Floats, permutations: int, rng: int) -> tuple[list[Integers], bool]:
    """Orders (k,) of the rows (k, c) of a design: all that differ where these are few, or else some by chance.

    The second says whether they are all, with that of the design among them: then a test is exact.
    """
    labels = np.unique(columns, axis=0, return_inverse=True)[1].ravel()
    if _ways(labels.tolist()) > FEW:
        random = np.random.default_rng(rng)
        return [random.permutation(len(labels)) for _ in range(permutations)], False
    example = np.unique(labels, return_index=True)[1]
    return [example[list(one)] for one in _all_ways(Counter(labels.tolist()), len(labels))], True


def probability(found: float, others: Sequence[float], is_all: bool, tolerance: float) -> float:
    """The share of what other orders give that is as large as what was found, which is one of them."""
    beaten = sum(one >= found * (1 - tolerance) for one in others)
    return beaten / len(others) if is_all else (beaten + 1) / (len(others) + 1)


def _ways(labels: Sequence[object]) -> int:
    return factorial(len(labels)) // prod(map(factorial, Counter(labels).values()))


def _all_ways(left: Counter[int], count: int) -> Iterator[tuple[int, ...]]:
    if count == 0:
        yield ()
    for label in sorted(left):
        if left[label]:
            for rest in _all_ways(left - Counter([label]), count - 1):
                yield (label, *rest)


def least_probability(values: Sequence[str] | ArrayLike) -> float:
    """The least p of a permutation test, of groups (k words) or a covariate (k numbers), whatever the difference.

    It is one over the number of ways in which labels can be dealt out that are not the same division into groups: what
    is found is one of them.

    Examples
    --------
    >>> least_probability(["cat", "cat", "cat", "dog", "dog", "dog"])  # 20 ways, in pairs that are the same
    0.1
    """
    labels = np.asarray(values).tolist()
    ways = _ways(labels)
    if np.asarray(values).dtype.kind not in "fiu":  # groups of the same size can change names
        ways //= prod(map(factorial, Counter(Counter(labels).values()).values()))
    return 1 / ways


def told_of_sizes(values: Sequence[str] | ArrayLike, names: Sequence[str]) -> list[str]:
    """Which groups have one specimen, and what that, or how few there are, means for p, as sentences; else none.

    Raises `BadArgument` (E604) where no group of two or more has a second specimen.

    Examples
    --------
    >>> told_of_sizes(["cat", "cat", "cat", "dog"], ["a", "b", "c", "d"])[0]
    'group dog has one specimen, d: how much it varies is not known, and is taken to be as much as in the others'
    """
    words = np.asarray(values).tolist()
    sizes = {} if np.asarray(values).dtype.kind in "fiu" else dict(sorted(Counter(words).items()))
    if 1 < len(sizes) == len(words):
        raise BadArgument(f"too few for a test: each of the {len(sizes)} groups has one ({', '.join(list(sizes)[:5])})")
    unknown = "how much it varies is not known, and is taken to be as much as in the others"
    told = [
        f"group {x} has one specimen, {names[words.index(x)]}: {unknown}" for x, count in sizes.items() if count == 1
    ]
    least = least_probability(values)
    if least >= CONVINCING:
        divided = f" ({', '.join(f'{group} {count}' for group, count in sizes.items())})" if sizes else ""
        told.append(f"of {len(words)} specimens{divided} p is {least:.2g} at the least, whatever the difference")
    return told

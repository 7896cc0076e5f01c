"""Whether the maps of a collection agree: where points end up that go from shape to shape around a triangle."""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from geodesics import SurfacePoints
from geodesics.arrays import Bools, Floats, Integers

Pair = tuple[str, str]
Route = tuple[str, str, str]

# triangles of shapes that are looked at, a bound of time; of more, as many are drawn at random, the same every time
MOST_TRIANGLES = 20_000
FEW_SHAPES = 100  # up to which all triangles are listed before any are drawn: at most 161,700, 100 over 3


@dataclass(frozen=True, eq=False)
class CarriedMap:
    """A map as what it does to functions: `matrix` (n_source, n_target) times values there are values here.

    `positions` (n_source, 3) in the target, `valid` (n_source,); `samples` of the source, evenly spread; `place` (n, 3)
    of its vertices, `size` the root of the target's area.
    """

    matrix: sp.csr_matrix
    positions: Floats
    valid: Bools
    samples: Integers
    place: Floats
    size: float

    @classmethod
    def of(cls, points: SurfacePoints, valid: Bools, samples: Integers, place: Floats) -> CarriedMap:
        """The map that sends source vertices, which are at `place` (n, 3), to `points` (n,)."""
        corners, n = points.mesh.faces[points.face], len(points)
        entries = points.barycentric.ravel(), (np.repeat(np.arange(n), 3), corners.ravel())
        matrix = sp.csr_matrix(entries, shape=(n, points.mesh.n_vertices))
        return cls(matrix, points.positions, valid, samples, place, float(np.sqrt(points.mesh.area)))


@dataclass(frozen=True)
class Cycle:
    """Three maps that should agree, and by how much they do not.

    With three shapes `route` a, b, c, points of a go a -> b -> c -> a if `home`, else a -> b -> c beside a -> c.
    `mean`: mean distance in space from where they should be, over the root of the area of that shape: never more than
    the distance on the surface; `within_005`, `within_010`: the share of points that are nearer than that.
    """

    route: Route
    home: bool
    mean: float
    within_005: float
    within_010: float

    @property
    def pairs(self) -> tuple[Pair, Pair, Pair]:
        """The maps it is made of."""
        a, b, c = self.route
        return (a, b), (b, c), (c, a) if self.home else (a, c)

    def __str__(self) -> str:
        a, b, c = self.route
        return f"{a} > {b} > {c} > {a}" if self.home else f"{a} > {b} > {c} = {a} > {c}"


@dataclass(frozen=True)
class Consistency:
    """Cycles, worst first, and for each pair its `blame`: the median over its cycles of their mean distances.

    A map that is wrong spoils all the cycles it is in; one that is right only those that it shares with a wrong one.
    """

    cycles: tuple[Cycle, ...]

    @property
    def blame(self) -> dict[Pair, float]:
        """The blame of every pair that is part of a cycle, most blamed first."""
        shares: dict[Pair, list[float]] = defaultdict(list)
        for cycle in self.cycles:
            for pair in cycle.pairs:
                shares[pair].append(cycle.mean)
        found = {pair: float(np.median(means)) for pair, means in shares.items()}
        return dict(sorted(found.items(), key=lambda item: (-item[1], item[0])))

    @property
    def mean(self) -> float | None:
        """The mean over all cycles; None if there are none."""
        return float(np.mean([cycle.mean for cycle in self.cycles])) if self.cycles else None


def consistency(
    pairs: Sequence[Pair],
    load: Callable[[Pair], CarriedMap],
    most: int = MOST_TRIANGLES,
    progress: Callable[[float], None] | None = None,
) -> Consistency:
    """How well the maps of `pairs`, as `load` gives them, agree around triangles of shapes, at most `most` of them."""
    routes = list(_cycles(set(pairs), _triangles(pairs, most)))
    found = []
    for number, (route, home) in enumerate(routes):
        found.append(_judged(route, home, load))
        if progress is not None:
            progress((number + 1) / len(routes))
    return Consistency(tuple(sorted(found, key=lambda cycle: (-cycle.mean, cycle.route))))


def _judged(route: Route, home: bool, load: Callable[[Pair], CarriedMap]) -> Cycle:
    """Coordinates are carried back along the route, as functions, and compared with what they should be."""
    a, b, c = route
    first, second, last = load((a, b)), load((b, c)), load((c, a) if home else (a, c))
    rows, samples = first.matrix[first.samples], first.samples
    if home:
        reached, goal, size = rows @ (second.matrix @ last.positions), first.place[samples], last.size
        lost = second.matrix @ ~last.valid
    else:
        reached, goal, size = rows @ second.positions, last.positions[samples], second.size
        lost = np.zeros(len(second.valid))
    bad = rows @ ((lost > 0) | ~second.valid) > 0
    fine = first.valid[samples] & ~bad
    if not home:  # else it starts on the third shape, and `lost` knows what it lacks
        fine = fine & last.valid[samples]
    gap = np.linalg.norm(reached - goal, axis=1)[fine] / size
    if len(gap) == 0:
        return Cycle(route, home, 1.0, 0.0, 0.0)
    return Cycle(route, home, *(float(x) for x in (gap.mean(), (gap < 0.05).mean(), (gap < 0.10).mean())))


def _cycles(known: set[Pair], triangles: Iterable[Route]) -> Iterator[tuple[Route, bool]]:
    """The cycles in each triangle: around it both ways, or where that cannot be done, one way beside the other."""
    for a, b, c in triangles:
        ways: tuple[Route, Route] = (a, b, c), (a, c, b)
        around = [route for route in ways if {*itertools.pairwise((*route, a))} <= known]
        yield from ((route, True) for route in around)
        if not around:
            orders = itertools.permutations((a, b, c))
            yield from (((x, y, z), False) for x, y, z in orders if {(x, y), (y, z), (x, z)} <= known)


def _triangles(pairs: Sequence[Pair], most: int) -> list[Route]:
    """Triangles of shapes of which each two are matched in some direction: all, or `most` of them drawn at random."""
    near: dict[str, set[str]] = defaultdict(set)
    for one, other in pairs:
        if one != other:
            near[one].add(other)
            near[other].add(one)
    rng = np.random.default_rng(0)
    if len(near) <= FEW_SHAPES:
        listed = [
            (a, b, c)
            for a, b in itertools.combinations(sorted(near), 2)
            if b in near[a]
            for c in sorted(near[a] & near[b])
            if c > b
        ]
        if len(listed) <= most:
            return listed
        return [listed[i] for i in sorted(rng.choice(len(listed), most, replace=False))]
    drawn: dict[tuple[str, ...], None] = {}
    for _ in range(4 * most):
        one, other = pairs[int(rng.integers(len(pairs)))]
        third = sorted(near[one] & near[other])
        if third and one != other:
            drawn[tuple(sorted((one, other, third[int(rng.integers(len(third)))])))] = None
        if len(drawn) == most:
            break
    return [(a, b, c) for a, b, c in sorted(drawn)]

"""Where a part may lie on a whole: many rough maps, each deformed onto the whole, the few likeliest made better."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence

import numpy as np

from geodesics.arrays import Bools, Floats, Integers
from geodesics.threads import side_by_side
from gmds.parts.alignments import Judged, alignments
from gmds.parts.assignments import consistent_assignments
from gmds.parts.extremities import Anchors, all_extremities, inner_extremities, with_interior
from gmds.parts.local_stress import LocalStress
from gmds.parts.part_map import CONVERGED, IN_PLACE, ONTO_WHOLE, PartMap
from gmds.parts.recombination import recombined
from gmds.parts.trilateration import Trilateration
from gmds.registration.deformable import DeformableMesh
from gmds.registration.distinct import distinct
from gmds.registration.register import Registered, register, settled
from gmds.surface.measured import Surface

# Chosen on the development half of the PFAUST pairs (benchmarks/results/notes.md, "Parts").
REGISTERED = 50  # rough maps, those of least residual, that are deformed onto the whole
DOUBTFUL = -1.35  # a likelihood above which points inside are assigned as well: right maps have -1.4 to -2.4
INTERIOR = (3, 30)  # of them, on the part and on the whole
IMPROVED = 8  # of these, apart from each other, that are placed again by distances
ROUNDS = 3  # of placing and deforming
SLIDING = 3  # maps, the likeliest, that slide until they converge: as many as are followed further
APART = 0.06  # root mean square distance, in root areas of the whole, between two maps that are two
BELIEF_TIME = 3e-3  # heat time, in units of the area of the part, over which strain is averaged

ALIGNED = 40  # alignments that are deformed; set by hand
SIZES = (0.3, 1.0)  # of a part of unit area on a whole of unit area: a bound, a tenth of the area and all of it


def part_maps(
    source: Surface, target: Surface, meshes: tuple[DeformableMesh, DeformableMesh], tell: Callable[[float], None]
) -> list[PartMap]:
    """Maps of the part `source` onto `target`, the likeliest first; `meshes` are both simplified. Maybe none.

    Extremities of both are assigned to each other where they agree on a scale (`consistent_assignments`), every vertex
    is placed by its distances from them (`Trilateration`), and the simplified part is deformed as that says; or it is
    deformed from where it fits as it is (`alignments`). A part of which all extremities are at its boundary, as of a
    scan from one side, has those. Of the likeliest, vertices are placed anew by distances from those that fit well
    (`LocalStress`), a few times, and of these the likeliest is put together anew (`recombined`). In the end the
    likeliest slide until they converge (`slid`).
    """
    ours, theirs = side_by_side(inner_extremities, (source, target))
    begun = _aligned(source, target, meshes) + _from_anchors(source, target, meshes, ours, theirs, None)
    tell(0.4)
    found = _improved(meshes, begun)
    if len(ours.vertices) < 2:
        at_cuts = _from_anchors(source, target, meshes, all_extremities(source), theirs, None)
        found = [*found, *_improved(meshes, at_cuts)]
    found = _put_together(meshes, found)
    tell(0.6)
    if not found or found[0].neg_log_likelihood > DOUBTFUL:
        (ours, tips), (goals, ends) = with_interior(source, INTERIOR[0]), with_interior(target, INTERIOR[1])
        more = _from_anchors(source, target, meshes, ours, goals, tips[:, None] == ends[None])
        found = _put_together(meshes, [*found, *_improved(meshes, more)])
    return found


def _aligned(source: Surface, target: Surface, meshes: tuple[DeformableMesh, DeformableMesh]) -> list[PartMap]:
    """Maps from where the part fits as it is."""
    ours, theirs = meshes
    found = alignments(Judged(source, ours), Judged(target, theirs), SIZES, ALIGNED)
    places = list(found.moved(ours.mesh.vertices))
    return side_by_side(lambda y: PartMap.of(ours, settled(ours, theirs, y, IN_PLACE)), places)


def _from_anchors(
    source: Surface,
    target: Surface,
    meshes: tuple[DeformableMesh, DeformableMesh],
    ours: Anchors,
    theirs: Anchors,
    alike: Bools | None,
) -> list[PartMap]:
    """Maps from assignments of the anchors of both."""
    if len(ours.vertices) < 2 or len(theirs.vertices) < 2:
        return []
    between = ours.distances[:, ours.vertices], theirs.distances[:, theirs.vertices]
    assigned = consistent_assignments(*between, alike)
    rows = Trilateration(source.mesh, target.mesh, ours, theirs, meshes[0].origin, meshes[1].origin)
    residuals = side_by_side(rows.residual, assigned)
    likely = [assigned[i] for i in np.argsort(residuals, kind="stable")[:REGISTERED]]
    return side_by_side(lambda one: _deformed(meshes, rows.images(one)), likely)


def _improved(meshes: tuple[DeformableMesh, DeformableMesh], begun: Sequence[PartMap]) -> list[PartMap]:
    """The likeliest of some maps, improved, the likeliest first."""
    apart = distinct(begun, meshes[0].areas, APART, count=IMPROVED)
    return distinct(side_by_side(functools.partial(improved, meshes), apart), meshes[0].areas, APART)


def _put_together(meshes: tuple[DeformableMesh, DeformableMesh], found: Sequence[PartMap]) -> list[PartMap]:
    """The maps, and what the likeliest became with regions of the others; then the likeliest slide. Likeliest first."""
    more = recombined(*meshes, found) if found else []
    more += [improved(meshes, one) for one in more[-1:]]
    apart = distinct([*more, *found], meshes[0].areas, APART)
    likely = side_by_side(functools.partial(slid, meshes), apart[:SLIDING])
    return distinct([*likely, *apart[SLIDING:]], meshes[0].areas, APART)


def slid(meshes: tuple[DeformableMesh, DeformableMesh], start: PartMap) -> PartMap:
    """The likelier of a map and of what it converges to, sliding as one stiff piece before details are sought anew."""
    trial = PartMap.of(meshes[0], settled(*meshes, start.registered.y, CONVERGED))
    return min(start, trial, key=lambda one: one.neg_log_likelihood)


def improved(meshes: tuple[DeformableMesh, DeformableMesh], start: PartMap) -> PartMap:
    """The likeliest of the map and of what `ROUNDS` of placing by distances and deforming make of it."""
    source, target = meshes
    best, now = start, start
    stress = LocalStress(source, target)
    for _ in range(ROUNDS):
        images = target.usable[target.tree.query(source.moved_features(now.registered.y))[1]]
        now = _deformed(meshes, stress.placed(images, belief(source, now.registered), now.size))
        best = min(best, now, key=lambda one: one.neg_log_likelihood)
    return best


def belief(source: DeformableMesh, registered: Registered) -> Floats:
    """How far the image of each vertex (n,) is believed: 1 / (1 + (strain / median strain)^2)."""
    average = source.laplacian.heat_step(BELIEF_TIME)
    strain = average(source.areas * registered.strain)
    return np.asarray(1 / (1 + (strain / max(float(np.median(strain[source.usable])), 1e-12)) ** 2), dtype=np.float64)


def _deformed(meshes: tuple[DeformableMesh, DeformableMesh], images: Integers) -> PartMap:
    """The simplified part deformed as a map to vertices of the simplified whole says."""
    source, target = meshes
    return PartMap.of(source, register(source, target, target.mesh.vertices[images], ONTO_WHOLE))

"""match(): the front door. A composition that anyone can copy and change; the arithmetic lives elsewhere."""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, Literal

import numpy as np

from geodesics import Distance, Mesh
from geodesics.threads import on_one_blas_thread, side_by_side
from gmds import initialization
from gmds.correspondence import Correspondence
from gmds.errors import SampleCountError
from gmds.initialization.from_landmarks import landmarks as from_landmarks
from gmds.landmarks.checking import place_landmarks
from gmds.matching.candidates import GivenDistances, MapCandidate, make_candidate, mirrored
from gmds.matching.large_surfaces import CoarseCopies
from gmds.matching.notes import match_notes
from gmds.matching.pair import SurfacePair
from gmds.matching.polishing import polished
from gmds.matching.proposals import Proposal, Start, distinct, proposals
from gmds.matching.result import contenders, correspondence_of
from gmds.mds.losses import LeastSquares, Loss
from gmds.provenance import method_in_words
from gmds.suggestions import suggest_keywords
from gmds.surface.measured import Surface, measure, view_of
from gmds.surface.view import View

FEWEST_SAMPLES = 3  # fewer leave a surface free to turn

SAMPLES = 300  # of each surface, placed by the solver: with as many it was measured (benchmarks/results/notes.md)
# Hard landmarks, and landmarks of any kind, that need no other starts: chosen on development pairs of SHREC'20
# (benchmarks/results/notes.md, "Landmarks"). With fewer than six, a wrong one does less harm beside the other starts.
ENOUGH_HARD = 3
ENOUGH = 6
EMBEDDED = 3  # maps of a pair, at the most, whose samples are placed: each costs 0.8 CPU seconds; set by hand
# Of log-likelihood from the best: no map that fell short by more was the answer on 15 development pairs, the farthest
# by 0.05 (benchmarks/results/notes.md, "Speed of a match").
SHORTFALL = 0.8
REFLECTED = {"preserve": (False,), "reverse": (True,), "any": (False, True)}

Report = Callable[[str, float], None]


@suggest_keywords
@on_one_blas_thread
def match(  # noqa: PLR0913 - the signature is a promise
    source: Mesh | Surface,
    target: Mesh | Surface,
    *,
    distance: Callable[[Mesh], Distance] | None = None,
    loss: Loss | None = None,
    n_samples: int | None = None,
    landmarks: Any = None,
    orientation: Literal["preserve", "reverse", "any"] = "preserve",
    rng: int = 0,
    progress: Callable[[str, float], None] | None = None,
) -> Correspondence:
    """For every vertex of `source` the point of `target` it corresponds to, by generalised multidimensional scaling.

    Sec. 5: many starts are refined in the scale-invariant metric (2.1) and in the metric of space, and then in the
    metric of the target in which the map keeps area; for the most promising maps `n_samples` farthest points (300) are
    embedded in the target by `solve` with `loss` (least squares), anywhere on its triangles, and extended to every
    vertex; the one that best keeps distances, curvature and orientation is the answer. With `distance`, a function
    Mesh -> Distance that is called on each surface brought to unit area, starts and embedding use that alone.

    A surface with more than 8,000 vertices is matched as a copy with some 5,000, and the map is prolonged to all of
    them, unless a `distance` is given.

    Either may be a `Surface`, made by `gmds.surface.measure`: what was computed of it for one match serves the next.

    `landmarks` are known correspondences, see `gmds.landmarks.check_landmarks`: those at vertices are met exactly,
    those inside a face to within the size of faces; `SoftLandmarks` pull, as far as they can be right. `rng` seeds
    whatever is random; in the method as it stands nothing is. `progress(stage, fraction)` is called as work goes on.
    Raises `MeshError`, `LandmarkError` (E300-E305), `SampleCountError` (E401), `SolverError` (E403).
    """
    if orientation not in REFLECTED:
        raise ValueError(f"orientation must be 'preserve', 'reverse' or 'any', not {orientation!r}")
    measured, facing = (s if isinstance(s, Surface) else measure(Mesh.from_object(s)) for s in (source, target))
    loss = LeastSquares() if loss is None else loss
    placed = None if landmarks is None else place_landmarks(landmarks, measured.original, facing.original)
    constraints = None if placed is None else placed.constraints.within(measured.mesh.faces, facing.mesh.faces)
    count = SAMPLES if n_samples is None else check_sample_count(n_samples, measured.original)
    report = progress or (lambda stage, fraction: None)
    started = time.perf_counter()

    report("measuring", 0.0)
    copies = None if distance is not None else CoarseCopies.of(measured, facing)
    if copies is not None:
        constraints = None if constraints is None else copies.landmarks(constraints)
        measured, facing = copies.copies
    candidates: list[MapCandidate] = []
    for reflected in REFLECTED[orientation]:
        pair = SurfacePair(measured, facing.reflection if reflected else facing, constraints, reflected)
        views, given = views_of(pair, distance)
        proposed = proposals(pair, views, starts_of(pair), lambda share: report("proposing", 0.2 + 0.3 * share))
        likely = distinct(proposed, pair.simplified[0], EMBEDDED, SHORTFALL)
        candidates += embedded(pair, likely, loss, count, given, report)
    candidates.sort(key=lambda candidate: candidate.evidence.neg_log_likelihood)
    if distance is None:
        candidates = registered(candidates, report)
    candidates += mirrored(candidates[0])

    settings = {
        "n_samples": min(count, len(measured.regular.usable)),
        **method_in_words(distance, loss),
        "orientation": orientation,
        "rng": rng,
    }
    answer = correspondence_of(candidates, {"parameters": settings})
    answer = answer if copies is None else copies.prolonged(answer)
    notes = match_notes(measured.original, facing.original, answer.status)
    if placed is not None:
        answer, missed = placed.applied(answer)
        notes += [*placed.notes, *missed]
    report("done", 1.0)
    seconds = round(time.perf_counter() - started, 3)
    return replace(answer, meta={**answer.meta, "notes": [str(note) for note in notes], "seconds": seconds})


def views_of(
    pair: SurfacePair, distance: Callable[[Mesh], Distance] | None
) -> tuple[list[tuple[View, View]], GivenDistances | None]:
    """Both surfaces in each metric in which maps are proposed, and the distances that are given, if any."""
    if distance is None:
        ours, theirs = side_by_side(lambda surface: surface.views, (pair.source, pair.target))
        return list(zip(ours, theirs, strict=True)), None
    distances = distance(pair.source.mesh), distance(pair.target.mesh)
    views = view_of(distances[0], pair.source), view_of(distances[1], pair.target)
    return [views], GivenDistances(views, distances)


def starts_of(pair: SurfacePair) -> list[Start]:
    """Those of `gmds.initialization`, and those from landmarks, alone where there are enough of these."""
    starts: list[Start] = list(initialization.ALL)
    if pair.landmarks is None:
        return starts
    enough = len(pair.landmarks.hard) >= ENOUGH_HARD or len(pair.landmarks) >= ENOUGH
    return [from_landmarks(*pair.landmarks.vertices), *(() if enough else starts)]


def embedded(
    pair: SurfacePair,
    proposed: Sequence[Proposal],
    loss: Loss,
    count: int,
    given: GivenDistances | None,
    report: Report,
) -> list[MapCandidate]:
    """The proposals with `count` samples placed by the solver, prolonged to all vertices."""
    report("embedding", 0.5)
    count = min(count, len(pair.source.regular.usable))
    place = functools.partial(make_candidate, pair, loss=loss, count=count, given=given)
    return side_by_side(place, proposed, lambda share: report("embedding", 0.5 + 0.2 * share))


def registered(candidates: Sequence[MapCandidate], report: Report) -> list[MapCandidate]:
    """The candidates, the most likely first, after the one or two that contend to be the answer were polished."""
    report("refining", 0.7)
    rivals = contenders(candidates)
    tell = functools.partial(_tell, report)
    done = side_by_side(lambda one: polished(one, tell if one is rivals[0] else None), rivals)
    ranked = sorted(done, key=lambda candidate: candidate.evidence.neg_log_likelihood)
    return ranked + [candidate for candidate in candidates if candidate not in rivals]


def _tell(report: Report, share: float) -> None:
    report("refining", 0.7 + 0.3 * share)


def check_sample_count(count: Any, mesh: Mesh) -> int:
    """`count` as an int, from 3 to the number of vertices that lie on a face; else `SampleCountError` (E401)."""
    most = len(np.unique(mesh.faces))
    if isinstance(count, (bool, np.bool_)) or not isinstance(count, (int, np.integer)):
        raise SampleCountError(f"n_samples must be a whole number from {FEWEST_SAMPLES} to {most}, not {count!r:.40}")
    if not FEWEST_SAMPLES <= count <= most:
        raise SampleCountError(
            f"n_samples = {count} is outside the allowed range {FEWEST_SAMPLES} to {most} of {mesh!r}"
        )
    return int(count)

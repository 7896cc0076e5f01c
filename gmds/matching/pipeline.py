"""match(): the front door. A composition that anyone can copy and change; the arithmetic lives elsewhere."""

from __future__ import annotations

import functools
import time
from collections.abc import Callable
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
from gmds.matching.candidates import MapCandidate, make_candidate, mirrored
from gmds.matching.large_surfaces import CoarseCopies
from gmds.matching.notes import match_notes
from gmds.matching.pair import SurfacePair
from gmds.matching.polishing import polished
from gmds.matching.proposals import Start, distinct, proposals
from gmds.matching.result import contenders, correspondence_of
from gmds.mds.losses import LeastSquares, Loss
from gmds.provenance import method_in_words
from gmds.suggestions import suggest_keywords
from gmds.surface.measured import Surface, measure, view_of

FEWEST_SAMPLES = 3

SAMPLES = 300
ENOUGH = 3  # hard landmarks that need no other starts
ENOUGH_SOFT = 6  # landmarks of any kind that need none: should one be wrong, the others outweigh it
REFINED = 3  # maps whose samples are placed by the solver
UNLIKELY = 0.8  # log-likelihood short of the best, at which no map of development pairs was the answer in the end
REFLECTED = {"preserve": (False,), "reverse": (True,), "any": (False, True)}


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

    A surface with more than 8,000 vertices is matched as a copy with some 5,000, and the map is carried to all of them,
    unless a `distance` is given.

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
    given = None if landmarks is None else place_landmarks(landmarks, measured.original, facing.original)
    constraints = None if given is None else given.constraints.within(measured.mesh.faces, facing.mesh.faces)
    count = SAMPLES if n_samples is None else check_sample_count(n_samples, measured.original)
    report = progress or (lambda stage, fraction: None)
    started = time.perf_counter()

    report("measuring", 0.0)
    copies = None if distance is not None else CoarseCopies.of(measured, facing)
    if copies is not None:
        constraints = None if constraints is None else copies.landmarks(constraints)
        measured, facing = copies.copies
    placed: list[MapCandidate] = []
    for reflected in REFLECTED[orientation]:
        pair = SurfacePair(measured, facing.reflection if reflected else facing, constraints, reflected)
        placed += _candidates(pair, distance, loss, count, report)
    placed.sort(key=lambda e: e.evidence.neg_log_likelihood)
    report("refining", 0.7)
    if distance is None:
        rivals, tell = contenders(placed), lambda share: report("refining", 0.7 + 0.3 * share)
        done = side_by_side(lambda e: polished(e, tell if e is rivals[0] else None), rivals)
        placed = sorted(done, key=lambda e: e.evidence.neg_log_likelihood) + [e for e in placed if e not in rivals]
    other = mirrored(placed[0])
    placed += [] if other is None else [other]

    settings = {
        "n_samples": min(count, len(measured.regular.usable)),
        **method_in_words(distance, loss),
        "orientation": orientation,
        "rng": rng,
    }
    found = correspondence_of(placed, {"parameters": settings})
    found = found if copies is None else copies.prolonged(found)
    notes = match_notes(measured.original, facing.original, found.status)
    if given is not None:
        found, missed = given.applied(found)
        notes += [*given.notes, *missed]
    report("done", 1.0)
    seconds = round(time.perf_counter() - started, 3)
    return replace(found, meta={**found.meta, "notes": [str(note) for note in notes], "seconds": seconds})


def _candidates(
    pair: SurfacePair,
    distance: Callable[[Mesh], Distance] | None,
    loss: Loss,
    count: int,
    report: Callable[[str, float], None],
) -> list[MapCandidate]:
    """The few maps of a pair that deserve it, their samples placed by the solver."""
    given = None
    if distance is None:
        ours, theirs = side_by_side(lambda surface: surface.views, (pair.source, pair.target))
        views = list(zip(ours, theirs, strict=True))
    else:
        distances = distance(pair.source.mesh), distance(pair.target.mesh)
        given = (view_of(distances[0], pair.source), view_of(distances[1], pair.target)), distances
        views = [given[0]]
    starts: list[Start] = list(initialization.ALL)
    if pair.landmarks is not None:
        enough = len(pair.landmarks.hard) >= ENOUGH or len(pair.landmarks) >= ENOUGH_SOFT
        starts = [from_landmarks(*pair.landmarks.vertices), *(() if enough else starts)]
    report("proposing", 0.2)
    found = proposals(pair, views, starts, lambda share: report("proposing", 0.2 + 0.3 * share))
    chosen = distinct(found, pair.simplified[0], REFINED, UNLIKELY)
    report("embedding", 0.5)
    count = min(count, len(pair.source.regular.usable))
    place = functools.partial(make_candidate, pair, loss=loss, count=count, given=given)
    return side_by_side(place, chosen, lambda share: report("embedding", 0.5 + 0.2 * share))


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

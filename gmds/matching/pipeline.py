"""match(): the front door. A composition that anyone can copy and change; the arithmetic lives elsewhere."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from geodesics import Distance, Mesh
from geodesics.errors import BadArgument, Note
from geodesics.threads import on_one_blas_thread, side_by_side
from gmds.correspondence import Correspondence
from gmds.errors import SampleCountError
from gmds.landmarks.checking import place_landmarks
from gmds.matching.attempts import ASKED, Orientation, Wanted, attempted, finished
from gmds.matching.bodies import bodies_of
from gmds.matching.candidates import mirrored
from gmds.matching.clean_copies import cleaning_notes, on_clean, on_given
from gmds.matching.large_surfaces import CoarseCopies
from gmds.matching.method import loss_of
from gmds.matching.notes import doubt_notes, image_notes, match_notes, part_notes, rival_note
from gmds.matching.other_images import likelier_image, rival_image, with_candidate
from gmds.matching.part_answers import PARTS, Parts, likelier_part
from gmds.matching.result import correspondence_of
from gmds.matching.several_bodies import beyond, incomplete, match_bodies
from gmds.mds.losses import Loss
from gmds.provenance import method_in_words
from gmds.suggestions import suggest_keywords
from gmds.surface.measured import Surface, measure

FEWEST_SAMPLES = 3  # fewer leave a surface free to turn

SAMPLES = 300  # of each surface, placed by the solver: with as many it was measured (benchmarks/results/notes.md)


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
    orientation: Orientation = "preserve",
    parts: Parts = "auto",
    rng: int = 0,
    progress: Callable[[str, float], None] | None = None,
) -> Correspondence:
    """For every vertex of `source` the point of `target` it corresponds to, by generalised multidimensional scaling.

    Sec. 5: many starts are refined in the scale-invariant metric (2.1) and in the metric of space, and weighed by what
    it costs to deform the source as they say. For the most promising, farthest points are placed by `solve`, anywhere
    on the triangles of the target, in the metric of the target in which the map keeps area; the map is extended to
    every vertex and registered. The one that best keeps distances, curvature and orientation is the answer.

    A surface with more than 8,000 vertices is matched as a copy with some 5,000, and the map is prolonged to all of
    them, unless a `distance` is given.

    Parameters
    ----------
    source, target : Mesh or Surface
        The surfaces. A `Surface`, made by `gmds.surface.measure`, keeps what is computed of it for the next match.
    distance : callable, optional
        A function Mesh -> Distance of surfaces of unit area: plain generalised multidimensional scaling. Maps are
        proposed in its metric and others, samples placed in it alone; splines continue them, nothing is registered.
    loss : Loss, optional
        How the residuals of the embedding add up; least squares unless given. `Minimax` is reached through powers.
    n_samples : int, optional
        Farthest points that are placed, from 3 to the number of vertices; 300 unless given. Of more than 1,000,
        the pairs with the first 250 count, so that memory grows with their number.
    landmarks : array_like, pair or SoftLandmarks, optional
        Corresponding points in a form of `gmds.landmarks.check_landmarks`: those at vertices are met exactly, those
        inside a face to within the size of faces; `SoftLandmarks` pull, as far as they can be right.
    orientation : {"preserve", "reverse", "any", "auto"}
        What the map is to do to the orientation of the surface; "any" takes the likelier of both. With "preserve" it is
        told when the mirror image of the target, or the target with its faces turned, is far likelier: the answer is
        POOR and has the map to that as its first candidate. "auto" takes that map then. Where the mirror image explains
        more of the curvature (a hand on the other hand, or a body in a mirrored pose) the answer is AMBIGUOUS.
    parts : {"auto", "neither", "source", "target", "both"}
        Which surface is but a part of what the other is. With "auto" that is asked of a surface with a boundary, unless
        landmarks or a distance are given: its vertices then all have a counterpart, and of the other surface those in
        the region that it covers (`valid`, `covered`). Where both have a boundary ("both") each may lack what the other
        has, and what they have in common is looked for. Where a part is asked for by name, landmarks have no say in
        where it is looked for, and those at vertices are met in the end; a distance of your own is refused.
    rng : int
        Seeds whatever is random; in the method as it stands nothing is.
    progress : callable, optional
        Called as `progress(stage, fraction)`.

    Returns
    -------
    Correspondence
        With the other candidates, best first; `status` and `distortion` say how far to trust it.

    Raises
    ------
    MeshError
        As `Mesh` and `measure` do.
    LandmarkError
        As `check_landmarks` does (E300 to E305).
    SampleCountError
        For another number of samples (E401).
    SolverError
        When a distance is not a number (E403).

    See Also
    --------
    match_collection : Many pairs.
    self_symmetry : A surface with itself.
    solve : The embedding alone.

    References
    ----------
    Sec. 5 of Aflalo, Kimmel, Raviv: Scale invariant geometry for nonrigid shapes (2013). What was added and why:
    `benchmarks/results/notes.md`.

    Examples
    --------
    >>> import gmds
    >>> from gmds.shapes import quadruped, truth
    >>> source, target = quadruped(n_vertices=200), quadruped('walk', n_vertices=200)
    >>> answer = gmds.match(source, target)
    >>> answer.points.positions.shape  # a point of the target for every vertex of the source
    (200, 3)
    """
    if orientation not in ASKED:
        raise BadArgument(f"orientation must be one of {', '.join(map(repr, ASKED))}, not {orientation!r}")
    if parts not in PARTS:
        raise BadArgument(f"parts must be one of {', '.join(map(repr, PARTS))}, not {parts!r}")
    if parts not in ("auto", "neither") and distance is not None:
        raise BadArgument(f"parts={parts!r} is looked for without a distance of your own; leave one of them out")
    loss = loss_of(distance, loss)
    given = side_by_side(lambda s: s if isinstance(s, Surface) else measure(Mesh.from_object(s)), (source, target))
    measured, facing = given
    placed = None if landmarks is None else place_landmarks(landmarks, measured.given, facing.given)
    count = SAMPLES if n_samples is None else check_sample_count(n_samples, measured.original)
    report = progress or (lambda stage, fraction: None)
    started = time.perf_counter()
    report("measuring", 0.0)
    whole, bodies = (measured, facing), (bodies_of(measured), bodies_of(facing))
    if max(map(len, bodies)) > 1:
        options = {"distance": distance, "loss": loss, "orientation": orientation, "parts": parts, "rng": rng}
        return match_bodies(match, bodies, whole, placed, n_samples, options, report)
    constraints = None if placed is None else on_clean(placed.constraints, measured, facing)
    copies = None if distance is not None else CoarseCopies.of(measured, facing)
    if copies is not None:
        constraints = None if constraints is None else copies.landmarks(constraints)
        measured, facing = copies.copies
    looked_for = distance is None and (landmarks is None or parts != "auto")
    wanted = Wanted(constraints, distance, loss, count, parts, report, looked_for)
    settings = {**method_in_words(distance, loss), "orientation": orientation, "parts": parts, "rng": rng}
    answer, of_images = _answered(measured, facing, orientation, wanted, settings)
    answer = on_given(answer if copies is None else copies.prolonged(answer), *whole)
    of_a_part = "part" in answer.meta
    notes = match_notes(measured.original, facing.original, answer.status, of_a_part=of_a_part)
    notes += of_images
    notes += part_notes(measured.mesh, facing.mesh, parts, answer.meta.get("part"))
    notes += [*cleaning_notes(*whole), *doubt_notes(answer)]
    if more := beyond(bodies, whole):
        answer, notes = replace(answer, status=incomplete(answer.status)), [*notes, *more]
    if placed is not None:
        answer, missed = placed.applied(answer)
        notes += [*placed.notes, *missed]
    report("done", 1.0)
    seconds = round(time.perf_counter() - started, 3)
    return replace(answer, meta={**answer.meta, "notes": [str(note) for note in notes], "seconds": seconds})


def _answered(
    source: Surface, target: Surface, orientation: Orientation, wanted: Wanted, settings: Mapping[str, Any]
) -> tuple[Correspondence, list[Note]]:
    """The likeliest map, of a whole or a part, and what is said of images of the target that were not asked for."""
    tried = attempted(source, target, orientation, wanted)
    meta = {"parameters": {"n_samples": min(wanted.count, len(source.regular.usable)), **settings}}
    other = likelier_image(tried, orientation, wanted)
    if other is not None and orientation != "preserve":
        tried = [other]
    of_parts = [one for attempt in tried for one in attempt.of_parts]
    part = likelier_part(of_parts, [one for attempt in tried for one in attempt.maps], wanted.parts)
    if part is not None:
        answer = part.correspondence(meta)
    else:
        candidates = tried[0].finished if len(tried) == 1 else finished(tried)
        answer = correspondence_of([*candidates, *mirrored(candidates[0])], meta)
    if other is not None:
        taken = orientation != "preserve"
        return answer if taken else with_candidate(answer, tried, other), image_notes(other.image, taken=taken)
    rival = rival_image(tried, orientation, wanted)
    if rival is not None:
        return with_candidate(answer, tried, rival, undecided=True), [rival_note()]
    return answer, []


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

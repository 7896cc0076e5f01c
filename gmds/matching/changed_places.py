"""Whether bodies of one mesh, which are paired by where they are, have changed places rather than shapes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from geodesics.errors import Note
from gmds.correspondence import Correspondence
from gmds.maps.point_map import MatchStatus
from gmds.matching.evidence import Evidence
from gmds.matching.rating import AMBIGUOUS_MARGIN


def changed_places(answer: Correspondence, others: Sequence[tuple[Correspondence, tuple[int, int]]]) -> Note | None:
    """What is said of the `answer` for a pair of bodies where that of another pair is far likelier, by shape.

    `others`: the maps of all pairs that were made, with a vertex of the one and of the other body.
    """
    said = [(_neg_log_likelihood(one), at) for one, at in others if one.status is not MatchStatus.POOR]
    best, at = min(said, key=lambda one: one[0], default=(np.inf, (0, 0)))
    if not _neg_log_likelihood(answer) - best > AMBIGUOUS_MARGIN:
        return None
    message = (
        f"the bodies are paired by where they are; by its shape that of the source at vertex {at[0]} is rather that of "
        f"the target at vertex {at[1]}: if bodies have changed places, split the meshes and match them one by one"
    )
    return Note("W310", "warning", message, at)


def doubted(answer: Correspondence, note: Note) -> Correspondence:
    """The answer, AMBIGUOUS at the best: one pairing of the bodies is as likely as the other."""
    status = max(answer.status, MatchStatus.AMBIGUOUS, key=lambda one: one.rank)
    meta = {**answer.meta, "notes": [*answer.meta.get("notes", ()), str(note)]}
    return replace(answer, status=status, confidence=answer.confidence / 2, meta=meta)


def _neg_log_likelihood(answer: Correspondence) -> float:
    """That of a map of two wholes; infinite for that of a part, which is not to be compared with it."""
    told = answer.meta.get("evidence", {})
    return np.inf if "part" in answer.meta or "outline" not in told else Evidence.from_meta(told).neg_log_likelihood

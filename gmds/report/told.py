"""What the page tells of the map that is shown: how far to trust it, its figures, and what to do next."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from geodesics.arrays import Floats
from gmds.evaluation import summary
from gmds.maps.overlap import overlap
from gmds.maps.point_map import Candidate, MatchStatus, PointMap
from gmds.report.tables import Card, Rows

VERDICTS = {
    MatchStatus.GOOD: ("good", "GOOD"),
    MatchStatus.INCOMPLETE: ("fair", "INCOMPLETE"),
    MatchStatus.AMBIGUOUS: ("fair", "AMBIGUOUS"),
    MatchStatus.UNRATED: ("plain", "UNRATED"),
    MatchStatus.POOR: ("poor", "POOR"),
}
NEXT = {
    MatchStatus.GOOD: "Check a few places that you know (tips of limbs, eyes, joints): point at them and see where "
    "their partner lights up.",
    MatchStatus.INCOMPLETE: "See in the notes which body has no partner: where it should have one, give both "
    "meshes the same bodies.",
    MatchStatus.AMBIGUOUS: "Compare the best map with the candidates (the list above the surfaces): of maps that do "
    "about as well, often one has left and right exchanged. Two or three landmarks settle which is right.",
    MatchStatus.UNRATED: "Nothing is known of how good this map is. Check it where you know the answer.",
    MatchStatus.POOR: "Do not use this map before you have looked at it closely. Try the candidates; give a few "
    "landmarks; see whether the two surfaces are of the same kind.",
}
CANDIDATE = ("plain", "Candidate")
OF_CANDIDATE = "Not the best map, but another one to compare with it. Nobody has rated it."
NEXT_OF_CANDIDATE = (
    "Compare it with the best map: point at places that you know in both. If this one is right, two or three landmarks "
    "make it the best."
)


@dataclass(frozen=True)
class Told:
    """A badge (its kind and word), a sentence on the status, what to do next, figures large and in a table."""

    badge: str
    verdict: str
    status: str
    next: str
    cards: list[Card]
    facts: Rows

    def as_data(self) -> dict[str, Any]:
        """As the script of the page reads it."""
        return asdict(self)


def told(answer: PointMap, errors: Floats | None) -> list[Told]:
    """Of the map and of each of its candidates; `errors` (k, n) of the first k of them."""
    rows: list[Floats | None] = [None] * (1 + len(answer.candidates))
    rows[: 0 if errors is None else len(errors)] = [] if errors is None else list(errors)
    return [_of_best(answer, rows[0]), *map(_of_candidate, [answer] * len(rows), answer.candidates, rows[1:])]


def facts(answer: PointMap, errors: Floats | None, *, shares: bool = True) -> Rows:
    """Counts, what has a counterpart, distortion, and errors (n,) by the protocol.

    `shares`: whether to tell how much of the area of both is matched, which takes 2 s for 100,000 vertices.
    """
    valid = answer.valid
    rows = [
        *_sizes(answer),
        ("source vertices with a counterpart", f"{int(valid.sum()):,}, {100 * valid.mean():.1f} %"),
    ]
    if shares:
        ours, theirs = (f"{100 * share:.1f} %" for share in overlap(answer))
        rows.append(("area with a counterpart, of the source and of the target", f"{ours}, {theirs}"))
    expected = answer.confidence[valid].mean() if valid.any() else np.nan
    if np.isfinite(expected):
        rows.append(("points expected within 0.05 of the truth (mean confidence)", f"{100 * expected:.0f} %"))
    if valid.any() and np.ptp(answer.distortion) > 0:
        middle, most = np.median(answer.distortion[valid]), answer.distortion[valid].max()
        rows.append(("distortion, median and largest", f"{middle:.4g}, {most:.4g}"))
    return [*rows, *_judged(errors)]


def _of_best(answer: PointMap, errors: Floats | None) -> Told:
    valid = answer.valid
    found: list[Card] = [(f"{100 * valid.mean():.1f} %", "of the source has a counterpart", "")]
    if valid.any() and not np.isnan(answer.confidence).all():
        expected = f"{100 * answer.confidence[valid].mean():.0f} %"
        found.append((expected, "of points expected within 0.05 of the truth", "confidence"))
    elif valid.any() and np.ptp(answer.distortion) > 0:
        found.append((f"{np.median(answer.distortion[valid]):.3g}", "median distortion", "distortion"))
    if answer.candidates:
        one = len(answer.candidates) == 1
        found.append((str(len(answer.candidates)), f"other map{'' if one else 's'} to compare", ""))
    found += [(value, name, "error") for name, value in _judged(errors)[:2]]
    status = answer.status
    return Told(*VERDICTS[status], status.value.replace("`", ""), NEXT[status], found, facts(answer, errors))


def _of_candidate(answer: PointMap, one: Candidate, errors: Floats | None) -> Told:
    stress, orientation = f"{one.stress:.3g}", f"{one.orientation:+.2f}"
    found: list[Card] = [(stress, "stress (small is good)", "stress")]
    found.append((orientation, "orientation (1 keeps, -1 mirrors)", "orientation"))
    found += [(value, name, "error") for name, value in _judged(errors)[:2]]
    rows = [*_sizes(answer), ("stress", stress), ("orientation", orientation), *_judged(errors)]
    return Told(*CANDIDATE, OF_CANDIDATE, NEXT_OF_CANDIDATE, found, rows)


def _sizes(answer: PointMap) -> Rows:
    return [
        ("vertices, faces of the source", f"{answer.source.n_vertices:,}, {answer.source.n_faces:,}"),
        ("vertices, faces of the target", f"{answer.target.n_vertices:,}, {answer.target.n_faces:,}"),
    ]


def _judged(errors: Floats | None) -> Rows:
    """Errors (n,) by the protocol of the field; no rows without truth."""
    known = errors[np.isfinite(errors)] if errors is not None else np.empty(0)
    if len(known) == 0:
        return []
    found = summary(known)
    return [
        ("mean error x100", f"{found.mean:.2f}"),
        ("of points within 0.10 of the truth", f"{found.within_010:.1f} %"),
        ("of points within 0.05", f"{found.within_005:.1f} %"),
        ("of points within 0.25", f"{found.within_025:.1f} %"),
        ("points with known truth", f"{found.count:,}"),
    ]

"""What is worth knowing of a match, beside the map: notes with codes, in `Correspondence.meta["notes"]`.

| code | says |
|---|---|
| W205 | the surfaces differ in topology: no continuous map takes all of one to all of the other (not said of parts) |
| W207 | the status is AMBIGUOUS: another map, for instance the mirrored one, does nearly as well |
| W208 | coordinates so far from the origin that edges have lost their precision |
| W225 | the mirror image of the target is far likelier: a right bone on a left one |
| W226 | with its faces turned, or as a mirror image with faces turned, the target is far likelier: its inside is out |
| W301 | landmarks that were given off the surface were moved to it, and how far |
| W302 | soft landmarks that are not followed, as the shapes contradict them: the map misses them by far |
| W303 | a mesh has faults and was matched as a clean copy: what was welded, sewn, dropped and taken apart |
| W304 | small parts of a mesh hang together with nothing: their vertices go along with the nearest and are not valid |
| W305 | a body has no partner or was not looked at, or a mesh is in pieces; the status is INCOMPLETE or worse |
| W306 | regions where the map is probably wrong, by its confidence: their shares, and a vertex in the midst of each |
| W307 | landmarks that do not fit the map around them, or that a likelier map misses, and by how much; then POOR |
| W308 | a part was asked for by name, and none was found, or nothing is cut off the surface that was said to be one |
| W309 | the mirror image of the target explains its curvature better: another hand, or a body in a mirrored pose |
| W310 | bodies are paired by where they are, and by shape one of them is rather another; then AMBIGUOUS |
"""

from __future__ import annotations

from geodesics import Mesh
from geodesics.errors import Note
from geodesics.threads import side_by_side
from geodesics.topology.invariants import invariants
from gmds.maps.doubt import doubtful_regions
from gmds.maps.point_map import MatchStatus, PointMap
from gmds.matching.part_answers import LEAST_BOUNDARY, Parts, longest_hole
from gmds.parts.handedness import Image

NAMED = 5  # doubtful regions that are named, at the most: set by hand


def match_notes(source: Mesh, target: Mesh, status: MatchStatus, *, of_a_part: bool = False) -> list[Note]:
    """The notes on a match of two surfaces, apart from those on its landmarks.

    `of_a_part`: whether one was taken for a part of the other, which has another topology as a rule.
    """
    notes = []
    ours, theirs = side_by_side(invariants, (source, target))
    if not of_a_part and str(ours) != str(theirs):
        notes.append(Note("W205", "info", f"different topology: the source has {ours}; the target has {theirs}"))
    if status is MatchStatus.AMBIGUOUS:
        notes.append(Note("W207", "warning", status.value))
    return notes


def part_notes(source: Mesh, target: Mesh, asked: Parts, found: str | None) -> list[Note]:
    """What is said where a part was `asked` for by name and none was `found`, or nothing was cut off the surface.

    Both meshes are of unit area, as they were matched.
    """
    if asked in ("auto", "neither"):
        return []
    if found is None:
        return [Note("W308", "warning", f"parts={asked!r} found no part that can be matched: the map is of all to all")]
    named = {"source": source, "target": target}
    whole = [name for name, mesh in named.items() if asked in (name, "both") and longest_hole(mesh) <= LEAST_BOUNDARY]
    if not whole:
        return []
    message = (
        f"parts={asked!r} was asked for; nothing is cut off the {' or the '.join(whole)}: no boundary is longer there "
        f"than {LEAST_BOUNDARY} square roots of the area; where both are whole, parts='neither' maps all to all"
    )
    return [Note("W308", "info", message)]


def doubt_notes(answer: PointMap) -> list[Note]:
    """The note on regions where the map is probably wrong, the largest of them named."""
    regions = doubtful_regions(answer.source, answer.confidence, answer.valid)
    if not regions:
        return []
    named = [
        f"{one.share:.0%} of the area around vertex {one.center} (confidence {one.confidence:.2f})"
        for one in regions[:NAMED]
    ]
    rest = "" if len(regions) <= NAMED else f", and {len(regions) - NAMED} smaller ones"
    message = f"regions of the source where the map is probably wrong: {', '.join(named)}{rest}"
    return [Note("W306", "warning", message, tuple(one.center for one in regions), len(regions))]


def image_notes(image: Image, *, taken: bool) -> list[Note]:
    """What is said of a match where another `image` of the target is far likelier, and was `taken` or was not."""
    what = "as a mirror image of itself" if image.reflected else "as it is"
    if image.turned:
        code, found = "W226", f"the target is far likelier {what} with its faces turned: its inside is out"
        advice = "turn them (gmds repair --turn), or " if not image.reflected else ""
    else:
        code, found = "W225", f"the target is far likelier {what}, a right one to the left one of the source"
        advice = ""
    if taken:
        return [Note(code, "info", f"{found}; the map goes to that")]
    told = f"the map is probably wrong; {advice}take orientation='auto' (--orientation auto)"
    return [Note(code, "warning", f"{found}; {told}, whose map is the first of the candidates")]


def rival_note() -> Note:
    """What is said of a match where the mirror image of the target explains its curvature better."""
    message = (
        "the mirror image of the target explains its curvature better: if one is a left and the other a right one, as "
        "hands are, take orientation='reverse' (--orientation reverse), whose map is the first of the candidates; if "
        "one is bent to the left and the other to the right, as bodies are, this map is right"
    )
    return Note("W309", "warning", message)

"""Notes with codes: on a mesh, on a match, and that all of them are documented."""

from __future__ import annotations

import re
from pathlib import Path

import generated_shapes as shapes
import pytest
from matched_shapes import bumpy

import geodesics.check
import geodesics.io
import gmds.matching.notes
from geodesics import Mesh
from geodesics.check import check
from geodesics.topology.invariants import Invariants, invariants
from gmds.appearance import keeping
from gmds.maps.point_map import MatchStatus
from gmds.matching.notes import match_notes, part_notes
from gmds.matching.part_answers import Parts

ROOT = Path(geodesics.check.__file__).resolve().parents[1]


def codes(mesh: Mesh) -> set[str]:
    return {note.code for note in check(mesh)}


def test_every_note_is_documented() -> None:
    used = {code for path in ROOT.glob("g*/**/*.py") for code in re.findall(r'"(W\d{3})"', path.read_text("utf-8"))}
    tables = f"{geodesics.check.__doc__}{geodesics.io.__doc__}{gmds.matching.notes.__doc__}{keeping.__doc__}"
    assert used == set(re.findall(r"^\| (W\d{3}) \|", tables, re.MULTILINE))


@pytest.mark.parametrize(
    ("mesh", "expected"),
    [
        (shapes.icosphere(2), Invariants(1, 0, 2, 0)),
        (shapes.torus(20, 10), Invariants(1, 0, 0, 1)),
        (shapes.rectangle(6, 6), Invariants(1, 1, 1, 0)),
        (shapes.joined(shapes.icosphere(1), shapes.torus(20, 10)), Invariants(2, 0, 2, 1)),
    ],
    ids=["sphere", "torus", "rectangle", "sphere and torus"],
)
def test_invariants_of_surfaces_that_have_known_ones(mesh: Mesh, expected: Invariants) -> None:
    assert invariants(mesh) == expected
    assert invariants(shapes.moved(mesh, 1e-6)) == expected


def test_surfaces_of_different_topology_are_named() -> None:
    ball, ring = shapes.icosphere(1), shapes.torus(20, 10)
    assert match_notes(ball, bumpy(), MatchStatus.GOOD) == []
    (note,) = match_notes(ball, ring, MatchStatus.POOR)
    assert str(note) == (
        "W205: different topology: the source has 1 component, 0 boundary loops, genus 0; "
        "the target has 1 component, 0 boundary loops, genus 1"
    )
    assert match_notes(ball, ring, MatchStatus.GOOD, of_a_part=True) == []


@pytest.mark.parametrize(
    ("asked", "found", "said"),
    [
        ("auto", None, ""),
        ("neither", None, ""),
        ("source", "source", ""),
        ("target", "target", "nothing is cut off the target:"),
        ("both", "both", "nothing is cut off the target:"),
        ("both", None, "the map is of all to all"),
    ],
)
def test_a_part_that_was_asked_for_in_vain_is_told(asked: Parts, found: str | None, said: str) -> None:
    """The source is a square, whose boundary is long, the target a ball."""
    cut, whole = shapes.rectangle(6, 6), shapes.icosphere(2)
    told = [str(note) for note in part_notes(cut, whole, asked, found)]
    assert len(told) == bool(said) and all(note.startswith("W308: parts=") and said in note for note in told)


def test_two_wholes_are_both_named_where_both_were_said_to_be_parts() -> None:
    ball = shapes.icosphere(2)
    (note,) = part_notes(ball, ball, "both", "both")
    assert note.code == "W308" and "the source or the target" in note.message


def test_a_match_carries_its_notes() -> None:
    ring = shapes.torus(20, 10)
    answer = gmds.match(ring, ring)  # round: turned by any angle it is the same
    assert answer.status is MatchStatus.AMBIGUOUS
    assert [line[:4] for line in answer.meta["notes"]] == ["W207"]
    assert next(line[:4] for line in gmds.match(bumpy(), ring).meta["notes"]) == "W205"


def test_flat_surfaces_are_told_where_the_metric_says_nothing() -> None:
    for flat in (shapes.rectangle(12, 12), shapes.moved(shapes.rectangle(12, 12), 1e9), shapes.cylinder(40, 20)):
        assert "W206" in codes(flat)
    for curved in (shapes.icosphere(2), shapes.torus(24, 12), bumpy()):
        assert "W206" not in codes(curved)
